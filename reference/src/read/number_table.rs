//! Table of numbers with column names, and its parser.

use std::io::BufRead;

use crate::read::digits::Digits;
use crate::read::lines::{Lines, RawLine};
use crate::read::read_error::{ReadError, quoted};

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

/// Separator of the numbers in a row, and treatment of NaN and infinity.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RowForm {
    /// Separator of numbers; `None` for blanks.
    pub(crate) separator: Option<u8>,
    /// True to keep NaN and infinity, which are errors otherwise.
    pub(crate) keeps_non_finite: bool,
}

impl RowForm {
    fn is_blank(self, byte: u8) -> bool {
        matches!(byte, b' ' | b'\t' | b'\r') && Some(byte) != self.separator
    }

    fn skip_blanks(self, bytes: &[u8], mut at: usize) -> usize {
        while bytes.get(at).is_some_and(|byte| self.is_blank(*byte)) {
            at += 1;
        }
        at
    }

    /// Appends the numbers of a line to a table, one for each column.
    pub(crate) fn read(self, line: RawLine<'_>, table: &mut Table) -> Result<(), ReadError> {
        let Table { columns, values } = table;
        let bytes = line.bytes;
        let mut at = 0;
        for (place, column) in columns.iter_mut().enumerate() {
            if let Some(separator) = self.separator.filter(|_| place > 0) {
                if bytes.get(at) != Some(&separator) {
                    return Err(self.fault(line, at, column));
                }
                at += 1;
            }
            at = self.skip_blanks(bytes, at);
            if column.is_text {
                let length = self.word(&bytes[at..]);
                if length == 0 || line.text().is_err() {
                    return Err(self.fault(line, at, column));
                }
                values.push(f64::NAN);
                at += length;
            } else {
                let Ok((value, length)) = fast_float2::parse_partial::<f64, _>(&bytes[at..]) else {
                    return Err(self.fault(line, at, column));
                };
                let text = &bytes[at..at + length];
                let delimited =
                    bytes.get(at + length).is_none_or(|byte| self.is_blank(*byte) || Some(*byte) == self.separator);
                if !delimited || !(value.is_finite() || self.keeps_non_finite) {
                    return Err(self.fault(line, at, column));
                }
                column.digits.see(text);
                values.push(value);
                at += length;
            }
            if self.separator.is_some() {
                at = self.skip_blanks(bytes, at);
            }
        }
        let rest = self.skip_blanks(bytes, at);
        if rest < bytes.len() {
            let last = columns.last().map(|column| column.name.as_str()).unwrap_or_default();
            let what = format!("the end of the line after the column {}", quoted(last));
            let rest = if bytes.get(rest) == self.separator.as_ref() { rest + 1 } else { rest };
            return Err(self.error_at(line, rest, &what, "one more field, "));
        }
        Ok(())
    }

    /// Returns the length of the field at the beginning of `bytes` (B).
    fn word(self, bytes: &[u8]) -> usize {
        let ends = |byte: &u8| self.is_blank(*byte) || Some(*byte) == self.separator;
        bytes.iter().position(ends).unwrap_or(bytes.len())
    }

    #[cold]
    fn fault(self, line: RawLine<'_>, at: usize, column: &NumberColumn) -> ReadError {
        let kind = match (column.is_text, self.keeps_non_finite) {
            (true, _) => "a word",
            (false, false) => "a finite number",
            (false, true) => "a number",
        };
        self.error_at(line, at, &format!("{kind} in the column {}", quoted(&column.name)), "")
    }

    /// Returns the error of the field at byte `at` of a line. `kind` precedes the field in the message.
    fn error_at(self, line: RawLine<'_>, at: usize, expected: &str, kind: &str) -> ReadError {
        // A byte that is not text is reported first.
        let text = match line.text() {
            Ok(line) => line.text,
            Err(error) => return error,
        };
        let at = self.skip_blanks(line.bytes, at);
        let field = text.get(at..at + self.word(&line.bytes[at..])).unwrap_or_default();
        let ends = at == line.bytes.len();
        let found =
            if ends && kind.is_empty() { "the end of the line".to_owned() } else { format!("{kind}{}", quoted(field)) };
        let before = if ends { text.trim_end() } else { text.get(..at).unwrap_or_default() };
        ReadError::at(line.file, line.number, expected, found).with_column(before.chars().count() + 1)
    }
}

/// Returns the separator in a line of column names, and the names.
pub(crate) fn header(line: &str) -> (u8, Vec<&str>) {
    let separator = [b',', b';', b'\t'].into_iter().find(|byte| line.contains(char::from(*byte))).unwrap_or(b',');
    let fields = line.trim_end().split(char::from(separator));
    (separator, fields.map(|field| field.trim().trim_matches('"')).collect())
}

/// Reads a table with a line of column names, followed by one line of numbers per row. `name` is the name of the table
/// in error messages.
///
/// The separator is a comma, a semicolon or a tab: the first of these that the line of names contains. Empty lines and
/// lines that begin with `#` are skipped.
///
/// # Errors
/// If the input cannot be read, has no names, a repeated name or no row, or if a row has a missing or additional field,
/// or a number that is not finite.
pub fn parse_table(reader: impl BufRead, name: &str) -> Result<Table, ReadError> {
    let mut lines = Lines::new(reader, name)?;
    let mut form = RowForm::default();
    let mut table = Table::default();
    while let Some(line) = lines.next_line()? {
        let first = line.bytes.iter().find(|byte| !byte.is_ascii_whitespace());
        if matches!(first, None | Some(b'#')) {
            line.text()?;
            continue;
        }
        if !table.columns.is_empty() {
            if table.values.len() > MOST_NUMBERS {
                let line = line.text()?;
                return Err(line.error(format!("at most {MOST_NUMBERS} numbers in a table"), "more"));
            }
            form.read(line, &mut table)?;
            continue;
        }
        let line = line.text()?;
        let (separator, names) = header(line.text);
        form.separator = Some(separator);
        for field in names {
            if field.is_empty() || field.parse::<f64>().is_ok() {
                return Err(line.error("a line with the names of the columns", quoted(line.text)));
            }
            if table.columns.iter().any(|column| column.name == field) {
                return Err(
                    line.error("columns with different names", format!("two columns with the name {}", quoted(field)))
                );
            }
            table.columns.push(NumberColumn::new(field));
        }
    }
    if table.columns.is_empty() {
        return Err(lines.error("a line with the names of the columns", "an empty file"));
    }
    if table.rows() == 0 {
        return Err(lines.error("at least one row below the names", "none"));
    }
    Ok(table)
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
