//! Fields of a line, read one after the other.

use std::ops::RangeBounds;
use std::str::FromStr;

use crate::read::lines::Line;
use crate::read::read_error::{ReadError, quoted};

/// Reader of the fields of a line. Each error names the column (in characters) of the field.
pub(crate) struct Fields<'l> {
    line: Line<'l>,
    content: &'l str,
    /// Byte offset of the part that has not been read.
    offset: usize,
}

impl<'l> Fields<'l> {
    /// Returns a reader of fields separated by blanks. `content` is the part of `line` before a comment.
    pub(crate) fn new(line: Line<'l>, content: &'l str) -> Self {
        Self { line, content, offset: 0 }
    }

    /// Reads a whole number within a range.
    pub(crate) fn whole<T: FromStr + PartialOrd>(
        &mut self,
        what: &str,
        range: impl RangeBounds<T>,
    ) -> Result<T, ReadError> {
        self.parsed(what, |value| range.contains(value))
    }

    /// Reads a finite number.
    pub(crate) fn finite(&mut self, what: &str) -> Result<f64, ReadError> {
        self.parsed(what, |value: &f64| value.is_finite())
    }

    /// Reads a finite number above zero.
    pub(crate) fn positive(&mut self, what: &str) -> Result<f64, ReadError> {
        self.parsed(what, |value: &f64| value.is_finite() && *value > 0.0)
    }

    /// Reads three finite numbers.
    pub(crate) fn vector(&mut self, what: [&str; 3]) -> Result<[f64; 3], ReadError> {
        Ok([self.finite(what[0])?, self.finite(what[1])?, self.finite(what[2])?])
    }

    /// Returns true if every field has been read.
    pub(crate) fn at_end(&self) -> bool {
        self.rest().trim_start().is_empty()
    }

    /// Checks that all fields have been read. `expected` is the expected content for the error.
    pub(crate) fn end(&mut self, expected: &str) -> Result<(), ReadError> {
        if self.at_end() {
            return Ok(());
        }
        let (text, column) = self.next(expected)?;
        let found = format!("one more field, {}", quoted(text));
        Err(self.line.error(expected, found).with_column(column))
    }

    fn rest(&self) -> &'l str {
        self.content.get(self.offset..).unwrap_or_default()
    }

    /// Returns the next field and its column (in characters).
    fn next(&mut self, what: &str) -> Result<(&'l str, usize), ReadError> {
        if self.at_end() {
            let column = self.content.trim_end().chars().count() + 1;
            let error = self.line.error(what, "the end of the line");
            return Err(error.with_column(column));
        }
        let rest = self.rest();
        let field = rest.trim_start();
        let start = self.offset + (rest.len() - field.len());
        let length = field.find(char::is_whitespace).unwrap_or(field.len());
        self.offset = start + length;
        let column = self.content.get(..start).unwrap_or_default();
        Ok((&field[..length], column.chars().count() + 1))
    }

    /// Reads the next field as a value. Returns an error unless `fits` returns true for it.
    fn parsed<T: FromStr>(&mut self, what: &str, fits: impl Fn(&T) -> bool) -> Result<T, ReadError> {
        let (text, column) = self.next(what)?;
        let value = text.parse().ok().filter(fits);
        value.ok_or_else(|| self.line.error(what, quoted(text)).with_column(column))
    }
}
