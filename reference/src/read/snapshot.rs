//! One snapshot of a dump.

use crate::read::digits::Digits;
use crate::read::numbers::NumberColumn;
use crate::read::read_error::ReadError;

/// What the rows of a dump are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DumpKind {
    /// Grains, of `dump custom` or `dump atom`.
    #[default]
    Atoms,
    /// Whatever a `compute` lists, contacts mostly, of `dump local`.
    Entries,
}

/// How snapshots are numbered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Numbering {
    /// By steps of the run.
    #[default]
    Steps,
    /// By numbers in the names of files: steps, or a count of files.
    Files,
    /// By a count of frames.
    Frames,
}

/// One snapshot of a dump, in the units of its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DumpSnapshot {
    /// The step, or another number by which snapshots are in order.
    pub step: u64,
    /// How snapshots are numbered.
    pub numbering: Numbering,
    /// The time, where the file says it.
    pub time: Option<f64>,
    /// The unit system by name, where the file has said it here or before.
    pub units: Option<String>,
    /// What the rows are.
    pub kind: DumpKind,
    /// The lower and the upper corner of the box; of a tilted one, of the box with right angles around it.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Tilts `xy`, `xz` and `yz` of the box.
    pub tilt: [f64; 3],
    /// Which axes are periodic.
    pub periodic: [bool; 3],
    /// The columns, in the order of the file.
    pub columns: Vec<NumberColumn>,
    /// The line of the first row, counted from 1.
    pub first_line: u64,
    /// Row after row.
    pub(crate) values: Vec<f64>,
}

impl DumpSnapshot {
    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.len().checked_div(self.columns.len()).unwrap_or(0)
    }

    /// The place of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The numbers of a row, one for each column.
    #[must_use]
    pub fn row(&self, row: usize) -> &[f64] {
        let width = self.columns.len();
        self.values.get(row * width..(row + 1) * width).unwrap_or_default()
    }

    /// The numbers of a column, from top to bottom.
    pub fn values(&self, column: usize) -> impl Iterator<Item = f64> {
        self.values.iter().skip(column).step_by(self.columns.len().max(1)).copied()
    }

    /// A coordinate along an axis (0, 1, 2): which columns have it, and how it is got from there.
    #[must_use]
    pub fn coordinate(&self, axis: usize) -> Option<Coordinate> {
        ["", "u", "s", "su"].into_iter().find_map(|suffix| self.coordinate_named(&column_name(axis, suffix), axis))
    }

    /// A coordinate along an axis from a column of any name; `xs`, `xsu` and so on are scaled.
    #[must_use]
    pub fn coordinate_named(&self, name: &str, axis: usize) -> Option<Coordinate> {
        let column = self.column(name)?;
        match ["s", "su"].into_iter().find(|suffix| name == column_name(axis, suffix)) {
            Some(suffix) => self.scaled(column, axis, suffix),
            None => Some(Coordinate { column, origin: 0.0, scale: 1.0, tilted: [None; 2] }),
        }
    }

    /// Corners of the box itself: those of the box around it less what the tilts add.
    fn corners(&self) -> ([f64; 3], [f64; 3]) {
        let (mut low, mut high) = self.bounds;
        let [xy, xz, yz] = self.tilt;
        let along_x = [0.0, xy, xz, xy + xz];
        low[0] -= along_x.into_iter().fold(0.0, f64::min);
        high[0] -= along_x.into_iter().fold(0.0, f64::max);
        (low[1], high[1]) = (low[1] - yz.min(0.0), high[1] - yz.max(0.0));
        (low, high)
    }

    /// A scaled coordinate: x = xlo + xs lx + ys xy + zs xz, y = ylo + ys ly + zs yz, z = zlo + zs lz.
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

    /// Finds the first number that differs from the same number of another snapshot, beyond the printed digits of both: its row,
    /// and in words the expected and the found value. Rows are matched by id; columns that only one of them has are passed over.
    pub(crate) fn difference_from(&self, other: &Self) -> Option<(usize, String, String)> {
        if self.rows() != other.rows() {
            return Some((0, format!("{} rows", other.rows()), self.rows().to_string()));
        }
        let orders = [other, self].map(|of| {
            let mut order: Vec<usize> = (0..of.rows()).collect();
            if let Some(id) = of.column("id") {
                order.sort_by(|&a, &b| of.row(a)[id].total_cmp(&of.row(b)[id]));
            }
            order
        });
        let of_files = [other, self].map(Self::digits);
        for (at, column) in self.columns.iter().enumerate().filter(|(_, column)| !column.is_text) {
            let Some(before) = other.column(&column.name) else { continue };
            let digits = [other.columns[before].digits, column.digits];
            for (&first, &second) in orders[0].iter().zip(&orders[1]) {
                let values = [other.row(first)[before], self.row(second)[at]];
                let open: f64 = (0..2).map(|which| digits[which].half_unit(values[which], &of_files[which])).sum();
                let is_one = (values[0] - values[1]).abs() <= open || values.iter().all(|value| value.is_nan());
                if !is_one {
                    let [expected, found] = values.map(|value| format!("`{}` {value:?}", column.name));
                    return Some((second, expected, found));
                }
            }
        }
        None
    }

    /// Refuses a snapshot of the step or time of another one if its numbers differ.
    pub(crate) fn check_repeated(&self, file: &str, before: &Self) -> Result<(), ReadError> {
        let Some((row, expected, found)) = self.difference_from(before) else { return Ok(()) };
        let expected = format!("{expected} as before at step {}, which is there twice", self.step);
        Err(ReadError::at(file, self.first_line + row as u64, expected, found))
    }

    /// What all columns of numbers show together of the format.
    #[must_use]
    pub fn digits(&self) -> Digits {
        let counted = self.columns.iter().filter(|column| !column.is_text);
        counted.fold(Digits::default(), |all, column| all.with(&column.digits))
    }
}

/// Name of the column of a coordinate: the letter of the axis and a suffix.
fn column_name(axis: usize, suffix: &str) -> String {
    format!("{}{suffix}", ["x", "y", "z"].get(axis).copied().unwrap_or_default())
}

/// How a coordinate is got from columns: scaled ones count from the lower side of the box in parts of its length, and in a
/// tilted box in parts of the tilts too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate {
    /// The column.
    pub column: usize,
    origin: f64,
    scale: f64,
    /// Other columns and the tilts that they are multiplied by.
    tilted: [Option<(usize, f64)>; 2],
}

impl Coordinate {
    /// The coordinate of a row of [`DumpSnapshot::row`].
    #[must_use]
    pub fn of(&self, row: &[f64]) -> f64 {
        let value = |column: usize| row.get(column).copied().unwrap_or(f64::NAN);
        let tilted: f64 = self.tilted.iter().flatten().map(|(column, tilt)| tilt * value(*column)).sum();
        let straight = self.origin + self.scale * value(self.column);
        if tilted == 0.0 { straight } else { straight + tilted }
    }

    /// What the coordinate changes by where the column changes by one.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The columns that the coordinate is got from, and what it changes by where each changes by one.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> {
        [(self.column, self.scale)].into_iter().chain(self.tilted.into_iter().flatten())
    }
}
