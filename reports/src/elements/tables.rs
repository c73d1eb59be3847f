//! Elements as comma-separated values.

use grainbench_fields::average::Mean;
use grainbench_fields::column::{COLUMNS, Column};
use grainbench_fields::course::{Course, of_means};
use grainbench_fields::trails::Trails;
use std::io::{self, Write};

/// A number that reads back to the same bits; nothing where there is none, which is not zero.
fn told(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// The name of a column with its unit.
fn head(column: &Column) -> String {
    format!("{} ({})", column.name, column.unit)
}

/// Place of a cell along each axis, and its middle (m).
fn place(course: &Course, cell: usize) -> impl Iterator<Item = String> {
    let (at, middle) = (course.grid.at(cell), course.grid.middle(cell));
    let middle: Vec<String> = middle.iter().map(|&along| told(Some(along))).collect();
    at.map(|along| along.to_string()).into_iter().chain(middle)
}

const PLACE: [&str; 6] = ["i", "j", "k", "x (m)", "y (m)", "z (m)"];

/// Writes a row an element and frame, with why it is left out of means.
pub(super) fn write_elements(course: &Course, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let heads = ["step", "time (s)"].into_iter().chain(PLACE).chain(["mask"]).map(str::to_owned);
    table.write_record(heads.chain(COLUMNS.iter().map(head)))?;
    for frame in &course.frames {
        for cell in 0..frame.elements.len() {
            let first = [frame.step.to_string(), told(Some(frame.time))].into_iter();
            let values = COLUMNS.iter().map(|column| told(course.value(column, frame, cell)));
            let mask = std::iter::once(frame.masked[cell].words());
            table.write_record(first.chain(place(course, cell)).chain(mask).chain(values))?;
        }
    }
    table.flush()
}

/// Writes a row a tracer and frame: where it is, its strain, and what the elements around it hold.
pub(super) fn write_trails(course: &Course, trails: &Trails, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let heads = ["tracer", "step", "time (s)", "x (m)", "y (m)", "z (m)", "hencky_strain (1)"];
    table.write_record(heads.into_iter().map(str::to_owned).chain(COLUMNS.iter().map(head)))?;
    for stop in &trails.stops {
        let frame = &course.frames[stop.frame];
        let first = [stop.tracer.to_string(), frame.step.to_string(), told(Some(frame.time))].into_iter();
        let place: Vec<String> = stop.position.iter().map(|&along| told(Some(along))).collect();
        let values = COLUMNS.iter().map(|column| told(course.value_at(column, frame, stop.position)));
        table.write_record(first.chain(place).chain([told(stop.strain)]).chain(values))?;
    }
    table.flush()
}

/// Writes a row a cell: means over time with half of their intervals, and what is not linear of the mean tensors too.
pub(super) fn write_means(course: &Course, blocks: usize, out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let heads = PLACE.into_iter().map(str::to_owned);
    let both = |column: &Column| [head(column), format!("{}_half_width ({})", column.name, column.unit)];
    let after = |column: &Column| format!("{}_of_means ({})", column.name, column.unit);
    table.write_record(heads.chain(COLUMNS.iter().flat_map(both)).chain(of_means().map(after)))?;
    for cell in 0..course.grid.cells() {
        let means = COLUMNS.iter().flat_map(|column| {
            let found: Option<Mean> = course.mean_in(column, cell, blocks);
            [told(found.map(|mean| mean.value)), told(found.and_then(|mean| mean.half_width))]
        });
        let whole = course.element_of_means(cell);
        let after = of_means().map(|column| told(whole.and_then(|element| (column.of)(&element, &course.grains))));
        table.write_record(place(course, cell).chain(means).chain(after))?;
    }
    table.flush()
}
