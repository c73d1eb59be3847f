//! Tables of granular elements.

use super::sheet::{Cell, Sheet};
use grainbench_fields::average::Mean;
use grainbench_fields::column::{COLUMNS, Column};
use grainbench_fields::course::{Course, of_means};
use grainbench_fields::trails::Trails;

/// Returns the heading of a column: name and unit.
fn head(column: &Column) -> String {
    format!("{} ({})", column.name, column.unit)
}

fn heads<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    names.into_iter().map(str::to_owned).collect()
}

/// Returns the indices of a cell along the axes, followed by the coordinates of its centre (m).
fn place(course: &Course, cell: usize) -> Vec<Cell> {
    let at = course.grid.at(cell).map(|along| Cell::Whole(along as u64));
    let middle = <[f64; 3]>::from(course.grid.middle(cell)).map(|along| Cell::Number(Some(along)));
    at.into_iter().chain(middle).collect()
}

const PLACE: [&str; 6] = ["i", "j", "k", "x (m)", "y (m)", "z (m)"];

/// Returns a table with one row per element and frame. The column `mask` states the reason if the element is left out of
/// averages.
pub(super) fn elements(course: &Course) -> Sheet<'_> {
    let first = heads(["step", "time (s)"].into_iter().chain(PLACE).chain(["mask"]));
    let rows = course.frames.iter().flat_map(move |frame| {
        (0..frame.elements.len()).map(move |cell| {
            let mut row = vec![Cell::Whole(frame.step), Cell::Number(Some(frame.time))];
            row.extend(place(course, cell));
            row.push(Cell::Word(frame.masked[cell].words()));
            row.extend(COLUMNS.iter().map(|column| Cell::Number(course.value(column, frame, cell))));
            row
        })
    });
    Sheet { name: "elements", heads: first.into_iter().chain(COLUMNS.iter().map(head)).collect(), rows: Box::new(rows) }
}

/// Returns a table with one row per tracer and frame: position, strain, and the values of the elements at its position.
pub(super) fn trails<'a>(course: &'a Course, trails: &'a Trails) -> Sheet<'a> {
    let first = heads(["tracer", "step", "time (s)", "x (m)", "y (m)", "z (m)", "hencky_strain (1)"]);
    let rows = trails.stops.iter().map(move |stop| {
        let frame = &course.frames[stop.frame];
        let mut row = vec![Cell::Whole(stop.tracer as u64), Cell::Whole(frame.step)];
        let numbers = [Some(frame.time)].into_iter().chain(stop.position.iter().map(|&along| Some(along)));
        row.extend(numbers.chain([stop.strain]).map(Cell::Number));
        row.extend(COLUMNS.iter().map(|column| Cell::Number(course.value_at(column, frame, stop.position))));
        row
    });
    Sheet { name: "tracers", heads: first.into_iter().chain(COLUMNS.iter().map(head)).collect(), rows: Box::new(rows) }
}

/// Returns a table with one row per cell: time averages, and half-widths of their confidence intervals. Nonlinear
/// quantities are also computed from the averages of the tensors.
pub(super) fn means(course: &Course, blocks: usize) -> Sheet<'_> {
    let both = |column: &Column| [head(column), format!("{}_half_width ({})", column.name, column.unit)];
    let after = |column: &Column| format!("{}_of_means ({})", column.name, column.unit);
    let rows = (0..course.grid.cells()).map(move |cell| {
        let mut row = place(course, cell);
        row.extend(COLUMNS.iter().flat_map(|column| {
            let found: Option<Mean> = course.mean_in(column, cell, blocks);
            [found.map(|mean| mean.value), found.and_then(|mean| mean.half_width)].map(Cell::Number)
        }));
        let whole = course.element_of_means(cell);
        row.extend(
            of_means().map(|column| Cell::Number(whole.and_then(|element| (column.of)(&element, &course.grains)))),
        );
        row
    });
    let heads = heads(PLACE).into_iter().chain(COLUMNS.iter().flat_map(both)).chain(of_means().map(after)).collect();
    Sheet { name: "means", heads, rows: Box::new(rows) }
}
