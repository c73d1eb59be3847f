//! Table of numbers with column names.

use crate::read::digits::Digits;
use crate::read::read_error::quoted;

/// Maximum number of numbers in a table. Processing needs ten times as much memory as the numbers themselves.
pub(super) const MOST_NUMBERS: usize = 1 << 24;

/// Column of a table of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NumberColumn {
    /// Name in the file.
    pub name: String,
    /// Printed digits of the numbers read so far.
    pub digits: Digits,
    /// True for a column of words, such as `element`, whose numbers are NaN.
    pub is_text: bool,
}

impl NumberColumn {
    /// Returns a column without digits so far. The columns `element` and `typelabel` contain words.
    pub(crate) fn new(name: &str) -> Self {
        let is_text = matches!(name, "element" | "typelabel");
        Self { name: name.to_owned(), digits: Digits::default(), is_text }
    }
}

/// Returns the names of columns as quoted text for error messages.
pub(crate) fn quoted_names(columns: &[NumberColumn]) -> String {
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    quoted(&names.join(" "))
}

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

    /// Returns the numbers of a row, one for each column.
    #[must_use]
    pub fn row(&self, row: usize) -> &[f64] {
        self.rows_from(row, 1)
    }

    /// Returns a table of `rows` rows from the row with index `row` on.
    pub(crate) fn part(&self, row: usize, rows: usize) -> Self {
        Self { columns: self.columns.clone(), values: self.rows_from(row, rows).to_vec() }
    }

    fn rows_from(&self, row: usize, rows: usize) -> &[f64] {
        let width = self.columns.len();
        self.values.get(row * width..(row + rows) * width).unwrap_or_default()
    }

    /// Returns the combined digits of all columns of numbers.
    #[must_use]
    pub fn digits(&self) -> Digits {
        Digits::all(self.columns.iter().filter(|column| !column.is_text).map(|column| &column.digits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_from_a_row_on() {
        let columns = ["a", "b"].map(NumberColumn::new);
        let table = Table::new(columns.into(), vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(table.rows_from(1, 2), [2.0, 3.0, 4.0, 5.0]);
        assert_eq!(table.rows_from(2, 2), [0.0; 0]);
    }
}
