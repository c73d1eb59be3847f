//! Table of numbers with column names.

use crate::read::digits::Digits;
use crate::read::numbers::NumberColumn;

/// Maximum number of numbers in a table. Processing needs ten times as much memory as the numbers themselves.
pub(super) const MOST_NUMBERS: usize = 1 << 24;

/// Table of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Columns in the order of the file.
    pub columns: Vec<NumberColumn>,
    pub(super) values: Vec<f64>,
}

impl Table {
    pub(crate) fn new(columns: Vec<NumberColumn>, values: Vec<f64>) -> Self {
        Self { columns, values }
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.len().checked_div(self.columns.len()).unwrap_or(0)
    }

    /// Returns the index of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Returns the numbers of a column, from top to bottom.
    pub fn values(&self, column: usize) -> impl Iterator<Item = f64> {
        self.values.iter().skip(column).step_by(self.columns.len().max(1)).copied()
    }

    /// Returns the numbers of `rows` rows from the row with index `row` on, row by row.
    pub(crate) fn rows_from(&self, row: usize, rows: usize) -> &[f64] {
        let width = self.columns.len();
        self.values.get(row * width..(row + rows) * width).unwrap_or_default()
    }

    /// Returns the combined digits of all columns.
    #[must_use]
    pub fn digits(&self) -> Digits {
        Digits::all(self.columns.iter().map(|column| &column.digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_from_a_row_on() {
        let columns =
            ["a", "b"].map(|name| NumberColumn { name: name.to_owned(), digits: Digits::default(), is_text: false });
        let table = Table { columns: columns.into(), values: vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0] };
        assert_eq!(table.rows_from(1, 2), [2.0, 3.0, 4.0, 5.0]);
        assert_eq!(table.rows_from(2, 2), [0.0; 0]);
    }
}
