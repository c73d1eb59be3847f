//! One snapshot of a dump.

use crate::read::digits::Digits;
use crate::read::numbers::NumberColumn;

/// What the rows of a dump are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DumpKind {
    /// Grains, of `dump custom` or `dump atom`.
    #[default]
    Atoms,
    /// Whatever a `compute` lists, contacts mostly, of `dump local`.
    Entries,
}

/// One snapshot of a dump, in the units of its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DumpSnapshot {
    /// The step.
    pub step: u64,
    /// The time, where the file says it.
    pub time: Option<f64>,
    /// The unit system by name, where the file has said it here or before.
    pub units: Option<String>,
    /// What the rows are.
    pub kind: DumpKind,
    /// The lower and the upper corner of the box.
    pub bounds: ([f64; 3], [f64; 3]),
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

    /// A coordinate along an axis (0, 1, 2): which column has it, and how it is got from there.
    #[must_use]
    pub fn coordinate(&self, axis: usize) -> Option<Coordinate> {
        let name = *["x", "y", "z"].get(axis)?;
        for (suffix, scaled) in [("", false), ("u", false), ("s", true), ("su", true)] {
            if let Some(column) = self.column(&format!("{name}{suffix}")) {
                return Some(self.coordinate_in(column, axis, scaled));
            }
        }
        None
    }

    /// A coordinate along an axis from a column of any name; `xs`, `xsu` and so on are scaled.
    #[must_use]
    pub fn coordinate_named(&self, name: &str, axis: usize) -> Option<Coordinate> {
        let scaled = ["xs", "ys", "zs", "xsu", "ysu", "zsu"].contains(&name);
        Some(self.coordinate_in(self.column(name)?, axis, scaled))
    }

    fn coordinate_in(&self, column: usize, axis: usize, scaled: bool) -> Coordinate {
        let (low, high) = (self.bounds.0[axis], self.bounds.1[axis]);
        let (origin, scale) = if scaled { (low, high - low) } else { (0.0, 1.0) };
        Coordinate { column, origin, scale }
    }

    /// What all columns of numbers show together of the format.
    #[must_use]
    pub fn digits(&self) -> Digits {
        let counted = self.columns.iter().filter(|column| !column.is_text);
        counted.fold(Digits::default(), |all, column| all.with(&column.digits))
    }
}

/// How a coordinate is got from a column: scaled ones count from the lower side of the box in parts of its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate {
    /// The column.
    pub column: usize,
    origin: f64,
    scale: f64,
}

impl Coordinate {
    /// The coordinate of a row of [`DumpSnapshot::row`].
    #[must_use]
    pub fn of(&self, row: &[f64]) -> f64 {
        self.origin + self.scale * row.get(self.column).copied().unwrap_or(f64::NAN)
    }

    /// What the coordinate changes by where the column changes by one.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }
}
