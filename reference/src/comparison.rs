//! Two outputs against each other, column by column, at the steps that both have.

use std::path::Path;

use crate::outputs::is_dump;
use crate::read::digits::Digits;
use crate::read::dump::DumpReader;
use crate::read::read_error::ReadError;
use crate::read::snapshot::DumpSnapshot;
use crate::read::table::{Table, read_table};

/// How one column of the second output differs from that of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The column.
    pub name: String,
    /// What the first has where they differ most.
    pub first: f64,
    /// What the second has there.
    pub second: f64,
    /// The largest change of a coordinate in the first output, the largest magnitude of anything else.
    pub scale: f64,
    /// How far the printed digits of both may have moved the difference.
    pub open: f64,
    /// Step (or row of a table) and largest difference there.
    pub course: Vec<(f64, f64)>,
}

/// Two outputs, compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Column by column.
    pub differences: Vec<Difference>,
    /// At how many steps, or rows, both were compared.
    pub compared: u64,
    /// How many only one of them has.
    pub alone: u64,
}

/// A column in the making.
struct Column {
    difference: Difference,
    is_coordinate: bool,
    start: Vec<f64>,
    magnitude: f64,
    change: f64,
}

impl Column {
    fn new(name: &str) -> Self {
        let difference = Difference {
            name: name.to_owned(),
            first: f64::NAN,
            second: f64::NAN,
            scale: 0.0,
            open: 0.0,
            course: Vec::new(),
        };
        let is_coordinate = ["x", "y", "z"].contains(&name);
        Self { difference, is_coordinate, start: Vec::new(), magnitude: 0.0, change: 0.0 }
    }

    fn worst(&self) -> f64 {
        (self.difference.second - self.difference.first).abs()
    }

    fn take(&mut self, at: f64, first: &[f64], second: &[f64]) {
        if self.start.is_empty() {
            self.start = first.to_vec();
        }
        let mut largest = 0.0_f64;
        for ((a, b), start) in first.iter().zip(second).zip(&self.start) {
            let off = (b - a).abs();
            self.magnitude = self.magnitude.max(a.abs());
            self.change = self.change.max((a - start).abs());
            largest = if off.is_nan() { f64::INFINITY } else { largest.max(off) };
            if self.difference.first.is_nan() || off.is_nan() || off > self.worst() {
                (self.difference.first, self.difference.second) = (*a, *b);
            }
        }
        self.difference.course.push((at, largest));
    }

    fn finish(mut self, open: f64) -> Difference {
        let extent = if self.is_coordinate && self.change > 0.0 { self.change } else { self.magnitude };
        self.difference.scale = if extent > 0.0 { extent } else { 1.0 };
        self.difference.open = open;
        self.difference
    }
}

/// Compares two dumps or two tables.
///
/// # Errors
/// One of them cannot be read, they are of different kinds, have no column or no step in common, or another number of
/// rows at a step.
pub fn compare(first: &Path, second: &Path) -> Result<Comparison, ReadError> {
    match (is_dump(first)?, is_dump(second)?) {
        (true, true) => compare_dumps(first, second),
        (false, false) => compare_tables(first, second),
        (one, _) => {
            let (kind, found) = if one { ("dump", "a table") } else { ("table", "a dump") };
            Err(ReadError::at(&second.to_string_lossy(), 1, format!("a {kind}, as the other file is"), found))
        }
    }
}

/// One snapshot of each file at a time.
fn compare_dumps(first: &Path, second: &Path) -> Result<Comparison, ReadError> {
    let name = second.to_string_lossy();
    let (mut readers, mut snapshots) =
        ([DumpReader::open(first)?, DumpReader::open(second)?], [DumpSnapshot::default(), DumpSnapshot::default()]);
    let (mut columns, mut compared, mut alone) = (Vec::new(), 0, 0);
    let mut next = |which: usize, snapshots: &mut [DumpSnapshot; 2]| readers[which].read(&mut snapshots[which]);
    let mut there = [next(0, &mut snapshots)?, next(1, &mut snapshots)?];
    while there[0] && there[1] {
        let steps = [snapshots[0].step, snapshots[1].step];
        if steps[0] == steps[1] {
            compare_snapshots(&name, &snapshots, &mut columns)?;
            compared += 1;
            there = [next(0, &mut snapshots)?, next(1, &mut snapshots)?];
        } else {
            let behind = usize::from(steps[1] < steps[0]);
            alone += 1;
            there[behind] = next(behind, &mut snapshots)?;
        }
    }
    while let Some(which) = there.iter().position(|more| *more) {
        alone += 1;
        there[which] = next(which, &mut snapshots)?;
    }
    if compared == 0 {
        return Err(ReadError::at(&name, 1, "a step that the other file has", "none"));
    }
    let [a, b] = &snapshots;
    let of_files = [a.digits(), b.digits()];
    let open = |column: &Column| {
        let value = column.magnitude;
        [a, b]
            .iter()
            .zip(&of_files)
            .map(|(snapshot, of_file)| open_of(snapshot, &column.difference.name, value, of_file))
            .sum()
    };
    let differences =
        columns.into_iter().map(|column| (open(&column), column)).map(|(open, column)| column.finish(open));
    Ok(Comparison { differences: differences.collect(), compared, alone })
}

/// What the digits of a column of a snapshot leave open at a value.
fn open_of(snapshot: &DumpSnapshot, name: &str, value: f64, of_file: &Digits) -> f64 {
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
    if let Some(coordinate) = axis.and_then(|axis| snapshot.coordinate(axis)) {
        let printed = if coordinate.scale() == 1.0 { value } else { 1.0 };
        return coordinate.scale() * snapshot.columns[coordinate.column].digits.uncertainty(printed, of_file);
    }
    snapshot.column(name).map_or(0.0, |at| snapshot.columns[at].digits.uncertainty(value, of_file))
}

fn compare_snapshots(name: &str, snapshots: &[DumpSnapshot; 2], columns: &mut Vec<Column>) -> Result<(), ReadError> {
    let [a, b] = snapshots;
    if a.rows() != b.rows() {
        let expected = format!("{} rows at step {}, as in the other file", a.rows(), a.step);
        return Err(ReadError::at(name, b.first_line, expected, b.rows().to_string()));
    }
    let orders = [order(a), order(b)];
    if let (Some(x), Some(y)) = (a.column("id"), b.column("id")) {
        let differs = orders[0].iter().zip(&orders[1]).find(|(i, j)| a.row(**i)[x] != b.row(**j)[y]);
        if let Some((i, j)) = differs {
            let expected = format!("the id {}, as in the other file", a.row(*i)[x]);
            return Err(ReadError::at(name, b.first_line + *j as u64, expected, b.row(*j)[y].to_string()));
        }
    }
    if columns.is_empty() {
        columns.extend(common(a, b).iter().map(|name| Column::new(name)));
        if columns.is_empty() {
            let have: Vec<&str> = a.columns.iter().map(|column| column.name.as_str()).collect();
            let expected = format!("a column of {}", crate::read::read_error::quoted(&have.join(" ")));
            return Err(ReadError::at(name, b.first_line.saturating_sub(1), expected, "none"));
        }
    }
    for column in columns.iter_mut() {
        let values = |snapshot: &DumpSnapshot, order: &[usize]| -> Vec<f64> {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == column.difference.name);
            if let Some(coordinate) = axis.and_then(|axis| snapshot.coordinate(axis)) {
                return order.iter().map(|&row| coordinate.of(snapshot.row(row))).collect();
            }
            let at = snapshot.column(&column.difference.name);
            order.iter().map(|&row| at.map_or(f64::NAN, |at| snapshot.row(row)[at])).collect()
        };
        let (first, second) = (values(a, &orders[0]), values(b, &orders[1]));
        column.take(a.step as f64, &first, &second);
    }
    Ok(())
}

/// Rows in order of id, as they are where there is none.
fn order(snapshot: &DumpSnapshot) -> Vec<usize> {
    let mut order: Vec<usize> = (0..snapshot.rows()).collect();
    if let Some(id) = snapshot.column("id") {
        order.sort_by(|&a, &b| snapshot.row(a)[id].total_cmp(&snapshot.row(b)[id]));
    }
    order
}

/// Coordinates that both tell, then columns of one name; ids and words aside.
fn common(a: &DumpSnapshot, b: &DumpSnapshot) -> Vec<String> {
    let axes = ["x", "y", "z"].into_iter().enumerate();
    let told = |axis: usize| a.coordinate(axis).is_some() && b.coordinate(axis).is_some();
    let mut names: Vec<String> = axes.filter(|(axis, _)| told(*axis)).map(|(_, name)| name.to_owned()).collect();
    let coordinates: Vec<usize> = (0..3).filter_map(|axis| a.coordinate(axis)).map(|at| at.column).collect();
    for (at, column) in a.columns.iter().enumerate() {
        let known = column.name == "id" || column.is_text || coordinates.contains(&at);
        if !known && b.column(&column.name).is_some() {
            names.push(column.name.clone());
        }
    }
    names
}

/// Row by row; a column `step` or `time` of both must agree.
fn compare_tables(first: &Path, second: &Path) -> Result<Comparison, ReadError> {
    let (a, b) = (read_table(first)?, read_table(second)?);
    let name = second.to_string_lossy();
    if a.rows() != b.rows() {
        let expected = format!("{} rows, as in the other file", a.rows());
        return Err(ReadError::at(&name, 1, expected, b.rows().to_string()));
    }
    let of_files = [a.digits(), b.digits()];
    let mut differences = Vec::new();
    for (at, column) in a.columns.iter().enumerate() {
        let Some(other) = b.column(&column.name) else { continue };
        let mut difference = Column::new(&column.name);
        let values = |table: &Table, at: usize| table.values(at).collect::<Vec<f64>>();
        let (first, second) = (values(&a, at), values(&b, other));
        difference.start = vec![first.first().copied().unwrap_or(0.0)];
        for (row, (x, y)) in first.iter().zip(&second).enumerate() {
            difference.take(row as f64, &[*x], &[*y]);
        }
        let value = difference.magnitude;
        let open =
            column.digits.uncertainty(value, &of_files[0]) + b.columns[other].digits.uncertainty(value, &of_files[1]);
        differences.push(difference.finish(open));
    }
    if differences.is_empty() {
        return Err(ReadError::at(&name, 1, "a column that the other file has", "none"));
    }
    Ok(Comparison { differences, compared: a.rows() as u64, alone: 0 })
}
