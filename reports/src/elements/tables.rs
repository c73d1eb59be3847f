//! Tables of granular elements.

use crate::table::{Cell, Column as Head, Format, Table};
use grainbench_fields::column::{COLUMNS, Column};
use grainbench_fields::course::{Course, Frame, Mean, of_means};
use grainbench_fields::trails::Trails;

/// Returns the column of a quantity, with an ending of its name.
fn head(column: &Column, ending: &str) -> Head {
    Head::number(format!("{}{ending}", column.name)).unit(column.unit)
}

/// Returns the columns of the place of a cell: indices along the axes, and coordinates of the centre.
fn place_heads() -> impl Iterator<Item = Head> {
    let indices = ["i", "j", "k"].map(|name| Head::new(name, Format::Count));
    indices.into_iter().chain(["x", "y", "z"].map(|name| Head::number(name).unit("m")))
}

fn clock_heads() -> [Head; 2] {
    [Head::new("step", Format::Count), Head::number("time").unit("s")]
}

/// Returns the step and the time of a frame.
fn clock(frame: &Frame) -> [Cell; 2] {
    [frame.step.into(), Cell::finite(Some(frame.time))]
}

/// Returns the indices of a cell along the axes, followed by the coordinates of its centre (m).
fn place(course: &Course, cell: usize) -> impl Iterator<Item = Cell> {
    let middle = <[f64; 3]>::from(course.grid.middle(cell));
    course.grid.at(cell).map(Cell::from).into_iter().chain(middle.map(Cell::from))
}

/// Returns a table with one row per element and frame. The column `mask` states why averages omit the element.
pub(super) fn elements(course: &Course) -> Table<'_> {
    let columns = clock_heads().into_iter().chain(place_heads()).chain([Head::text("mask")]);
    let rows = course.frames.iter().flat_map(move |frame| {
        (0..frame.elements.len()).map(move |cell| {
            let names = clock(frame).into_iter().chain(place(course, cell)).chain([frame.masked[cell].words().into()]);
            names.chain(COLUMNS.iter().map(|column| Cell::finite(course.value(column, frame, cell)))).collect()
        })
    });
    Table::new("elements", columns.chain(COLUMNS.iter().map(|column| head(column, ""))), rows)
}

/// Returns a table with one row per tracer and frame: position, strain, and the values of the elements at its position.
pub(super) fn trails<'a>(course: &'a Course, trails: &'a Trails) -> Table<'a> {
    let positions = ["x", "y", "z"].map(|name| Head::number(name).unit("m"));
    let columns = [Head::new("tracer", Format::Count)].into_iter().chain(clock_heads()).chain(positions);
    let columns = columns.chain([Head::number("hencky_strain").unit("1")]);
    let rows = trails.stops.iter().map(move |stop| {
        let frame = &course.frames[stop.frame];
        let place = stop.position.iter().map(|along| Cell::from(*along)).chain([Cell::finite(stop.strain)]);
        let values = COLUMNS.iter().map(|column| Cell::finite(course.value_at(column, frame, stop.position)));
        [stop.tracer.into()].into_iter().chain(clock(frame)).chain(place).chain(values).collect()
    });
    Table::new("tracers", columns.chain(COLUMNS.iter().map(|column| head(column, ""))), rows)
}

/// Returns a table with one row per cell: time averages, and half-widths of their confidence intervals. Nonlinear
/// quantities are also computed from the averages of the tensors.
pub(super) fn means(course: &Course, blocks: usize) -> Table<'_> {
    let both = |column: &Column| ["", "_half_width"].map(|ending| head(column, ending));
    let rows = (0..course.grid.cells()).map(move |cell| {
        let means = COLUMNS.iter().flat_map(|column| {
            let found: Option<Mean> = course.mean_in(column, cell, blocks);
            [found.map(|mean| mean.value), found.and_then(|mean| mean.half_width)].map(Cell::finite)
        });
        let whole = course.element_of_means(cell);
        let of_means = of_means().map(|column| whole.and_then(|element| (column.of)(&element, &course.grains)));
        place(course, cell).chain(means).chain(of_means.map(Cell::finite)).collect()
    });
    let columns = place_heads().chain(COLUMNS.iter().flat_map(both));
    Table::new("means", columns.chain(of_means().map(|column| head(column, "_of_means"))), rows)
}
