//! Snapshot of a dump.

use std::ops::Deref;

use crate::read::number_table::{Table, quoted_names};
use crate::read::read_error::ReadError;

/// Largest id (2⁵³). Up to this number, an f64 represents every whole number.
const LARGEST_ID: f64 = 9_007_199_254_740_992.0;

/// Content of the rows in a dump.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DumpKind {
    /// Grains from `dump custom` or `dump atom`.
    #[default]
    Atoms,
    /// Entries of a `compute`, usually contacts, from `dump local`.
    Entries,
}

/// Numbering of snapshots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Numbering {
    /// Steps of the run.
    #[default]
    Steps,
    /// Numbers in the names of files, which are steps or a count of files.
    Files,
    /// Frame numbers.
    Frames,
}

/// Snapshot of a dump: a table of grains or entries at one moment, in the units of its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DumpSnapshot {
    /// Step, or another number by which snapshots are ordered.
    pub step: u64,
    /// Meaning of `step`.
    pub numbering: Numbering,
    /// Time; `None` if the file does not contain it.
    pub time: Option<f64>,
    /// Name of the unit system; `None` if the file has not contained it so far.
    pub units: Option<String>,
    /// Content of the rows.
    pub kind: DumpKind,
    /// Lower and upper corner of the box. For a tilted box, they belong to the enclosing box with right angles.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Tilts `xy`, `xz` and `yz` of the box.
    pub tilt: [f64; 3],
    /// True for each periodic axis.
    pub periodic: [bool; 3],
    /// Columns and rows.
    pub(crate) table: Table,
    /// Line number of the first row, counted from 1.
    pub first_line: u64,
}

impl Deref for DumpSnapshot {
    type Target = Table;

    fn deref(&self) -> &Table {
        &self.table
    }
}

impl DumpSnapshot {
    /// Returns the conversion from the columns `x`, `xu`, `xs` or `xsu` to the coordinate along an axis (0, 1, 2: x, y,
    /// z), or `None` if there is no such column.
    #[must_use]
    pub fn coordinate(&self, axis: usize) -> Option<Coordinate> {
        ["", "u", "s", "su"].into_iter().find_map(|suffix| self.coordinate_named(&column_name(axis, suffix), axis))
    }

    /// Returns the conversion from the column `name` to the coordinate along an axis, or `None` if a column is missing.
    /// Columns such as `xs` and `xsu` are scaled.
    #[must_use]
    pub fn coordinate_named(&self, name: &str, axis: usize) -> Option<Coordinate> {
        let column = self.column(name)?;
        match ["s", "su"].into_iter().find(|suffix| name == column_name(axis, suffix)) {
            Some(suffix) => self.scaled(column, axis, suffix),
            None => Some(Coordinate { column, origin: 0.0, scale: 1.0, tilted: [None; 2] }),
        }
    }

    /// Returns the lower and upper corner of the tilted box: the corners of the enclosing box minus the tilts.
    fn corners(&self) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = self.bounds;
        let [xy, xz, yz] = self.tilt;
        let along_x = [0.0, xy, xz, xy + xz];
        low[0] -= along_x.into_iter().fold(0.0, f64::min);
        high[0] -= along_x.into_iter().fold(0.0, f64::max);
        (low[1], high[1]) = (low[1] - yz.min(0.0), high[1] - yz.max(0.0));
        (low, high)
    }

    /// Returns the conversion of a scaled coordinate: x = xlo + xs lx + ys xy + zs xz, y = ylo + ys ly + zs yz, z = zlo
    /// + zs lz.
    fn scaled(&self, column: usize, axis: usize, suffix: &str) -> Option<Coordinate> {
        let [xy, xz, yz] = self.tilt;
        let tilts = [[0.0, xy, xz], [0.0, 0.0, yz], [0.0; 3]][axis];
        let mut tilted = [None; 2];
        for (other, tilt) in tilts.into_iter().enumerate().filter(|(_, tilt)| *tilt != 0.0) {
            tilted[other - 1] = Some((self.column(&column_name(other, suffix))?, tilt));
        }
        let (low, high) = self.corners();
        Some(Coordinate { column, origin: low[axis], scale: high[axis] - low[axis], tilted })
    }

    /// Returns the row indices sorted by a column, for example by ids. Without a column, the rows stay in the order of
    /// the file.
    pub(crate) fn rows_by(&self, column: Option<usize>) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rows()).collect();
        if let Some(column) = column {
            order.sort_by(|&a, &b| self.row(a)[column].total_cmp(&self.row(b)[column]));
        }
        order
    }

    /// Returns an error about the row with an index. `file` is the name of the file.
    pub(crate) fn error(
        &self,
        file: &str,
        row: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        ReadError::at(file, self.first_line + row as u64, expected, found)
    }

    /// Returns the error of missing columns at the line of the names. `file` is the name of the file.
    pub(crate) fn missing(&self, file: &str, expected: impl Into<String>) -> ReadError {
        ReadError::at(file, self.first_line.saturating_sub(1), expected, quoted_names(&self.columns))
    }

    /// Checks that a column of ids has no negative, fractional or repeated number.
    pub(crate) fn check_ids(&self, file: &str, column: usize) -> Result<(), ReadError> {
        let is_id = |value: f64| (0.0..=LARGEST_ID).contains(&value) && value.fract() == 0.0;
        if let Some((row, value)) = self.values(column).enumerate().find(|(_, value)| !is_id(*value)) {
            let expected = format!("a whole number of 0 or more in the column `{}`", self.columns[column].name);
            return Err(self.error(file, row, expected, value.to_string()));
        }
        if self.values(column).is_sorted_by(|before, next| before < next) {
            return Ok(());
        }
        let mut ids: Vec<(u64, usize)> = self.values(column).map(|id| id as u64).zip(0..).collect();
        ids.sort_unstable();
        match ids.windows(2).find(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1]) {
            Some((id, row)) => Err(self.error(file, row, "each id only once per snapshot", format!("{id} again"))),
            None => Ok(()),
        }
    }

    /// Checks that the numbers equal those of an earlier snapshot with the same step within the uncertainty of printed
    /// digits. Rows are matched by id. Columns that only one of the snapshots has are skipped.
    pub(crate) fn check_repeated(&self, file: &str, before: &Self) -> Result<(), ReadError> {
        let fault = |row: usize, expected: String, found: String| {
            Err(self.error(file, row, format!("{expected} as in the earlier frame of step {}", self.step), found))
        };
        if self.rows() != before.rows() {
            return fault(0, format!("{} rows", before.rows()), self.rows().to_string());
        }
        let orders = [before, self].map(|snapshot| snapshot.rows_by(snapshot.column("id")));
        let of_files = [before, self].map(|snapshot| snapshot.digits());
        for (at, column) in self.columns.iter().enumerate().filter(|(_, column)| !column.is_text) {
            let Some(place) = before.column(&column.name) else { continue };
            let digits = [before.columns[place].digits, column.digits];
            for (&first, &second) in orders[0].iter().zip(&orders[1]) {
                let values = [before.row(first)[place], self.row(second)[at]];
                let open: f64 = (0..2).map(|which| digits[which].half_unit(values[which], &of_files[which])).sum();
                let is_one = (values[0] - values[1]).abs() <= open || values.iter().all(|value| value.is_nan());
                if !is_one {
                    let [expected, found] = values.map(|value| format!("`{}` {value:?}", column.name));
                    return fault(second, expected, found);
                }
            }
        }
        Ok(())
    }
}

/// Returns the name of the column of a coordinate: the letter of the axis and a suffix.
fn column_name(axis: usize, suffix: &str) -> String {
    format!("{}{suffix}", ["x", "y", "z"].get(axis).copied().unwrap_or_default())
}

/// Conversion from columns to a coordinate. A scaled column is the distance from the lower side of the box, divided by
/// the box length. In a tilted box, the scaled columns of the other axes also contribute, multiplied by the tilts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate {
    /// Index of the column of this coordinate.
    pub column: usize,
    origin: f64,
    scale: f64,
    /// Other columns, and the tilts by which they are multiplied.
    tilted: [Option<(usize, f64)>; 2],
}

impl Coordinate {
    /// Returns the coordinate from a row of numbers of the snapshot.
    #[must_use]
    pub fn value(&self, row: &[f64]) -> f64 {
        let value = |column: usize| row.get(column).copied().unwrap_or(f64::NAN);
        let tilted: f64 = self.tilted.iter().flatten().map(|(column, tilt)| tilt * value(*column)).sum();
        let straight = self.origin + self.scale * value(self.column);
        if tilted == 0.0 { straight } else { straight + tilted }
    }

    /// Returns the indices of the columns that contribute to the coordinate, with the derivative of the coordinate for
    /// each.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> {
        [(self.column, self.scale)].into_iter().chain(self.tilted.into_iter().flatten())
    }
}
