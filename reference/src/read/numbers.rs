//! Parser of rows of numbers that are separated by blanks or by another separator.

use crate::read::lines::RawLine;
use crate::read::number_table::{NumberColumn, Table};
use crate::read::read_error::{ReadError, quoted};

/// Treatment of NaN and infinity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NonFiniteNumbers {
    /// NaN and infinity are errors in the file.
    #[default]
    Refused,
    /// NaN and infinity are kept, so that the caller can report the step at which they occur.
    Kept,
}

/// Separator of the numbers in a row, and treatment of NaN and infinity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowForm {
    /// Separator of numbers; `None` for blanks.
    pub(crate) separator: Option<u8>,
    pub(crate) not_finite: NonFiniteNumbers,
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
                if !delimited || (!value.is_finite() && self.not_finite == NonFiniteNumbers::Refused) {
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
        let kind = match (column.is_text, self.not_finite) {
            (true, _) => "a word",
            (false, NonFiniteNumbers::Refused) => "a finite number",
            (false, NonFiniteNumbers::Kept) => "a number",
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
