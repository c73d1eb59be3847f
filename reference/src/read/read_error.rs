//! Common error of all readers.

use grainbench_scene::text::tamed;
use std::fmt;
use std::io;

/// Maximum length of an excerpt in an error (characters).
const EXCERPT: usize = 60;

/// Input that could not be read, with the file, the position, and the expected and the actual content.
///
/// It is displayed on one line as `FILE:LINE: expected …, found …`. With a column it begins with `FILE:LINE:COLUMN:`.
/// If the file could not be opened it begins with `FILE:`.
///
/// Lines and columns are counted from 1. Those of a compressed file refer to its text.
#[derive(Debug, thiserror::Error)]
#[error("{}: expected {expected}, found {found}", Place(file, *line, *column))]
pub struct ReadError {
    file: Box<str>,
    line: Option<u64>,
    column: Option<usize>,
    expected: Box<str>,
    found: Box<str>,
    is_cut: bool,
    #[source]
    source: Option<io::Error>,
}

impl ReadError {
    pub(crate) fn at(file: &str, line: u64, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            file: one_line(file).into_boxed_str(),
            line: Some(line),
            column: None,
            expected: expected.into().into_boxed_str(),
            found: found.into().into_boxed_str(),
            is_cut: false,
            source: None,
        }
    }

    /// Marks an input as truncated, for example because a job was killed.
    pub(crate) fn cut(self) -> Self {
        Self { is_cut: true, ..self }
    }

    pub(crate) fn with_column(mut self, column: usize) -> Self {
        self.column = Some(column);
        self
    }

    /// Returns an error of the operating system or the decompression while line `line` was being read.
    pub(crate) fn reading(file: &str, line: u64, source: io::Error) -> Self {
        let found = one_line(&source.to_string());
        let is_cut = source.kind() == io::ErrorKind::UnexpectedEof;
        Self { source: Some(source), is_cut, ..Self::at(file, line, "readable data", found) }
    }

    /// Returns the error for a file that could not be opened.
    pub(crate) fn opening(file: &str, source: io::Error) -> Self {
        Self { line: None, expected: "a readable file".into(), ..Self::reading(file, 0, source) }
    }

    /// Returns the given name of the input. Characters that would break the line are escaped.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns true if the input is truncated. The content before this position is complete.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// Returns the line, counted from 1, or `None` if the file could not be opened.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// Returns the column in characters, counted from 1, if the error has one.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        self.column
    }

    /// Returns the expected content.
    #[must_use]
    pub fn expected(&self) -> &str {
        &self.expected
    }

    /// Returns the actual content.
    #[must_use]
    pub fn found(&self) -> &str {
        &self.found
    }
}

/// Known part of the position of an error.
struct Place<'e>(&'e str, Option<u64>, Option<usize>);

impl fmt::Display for Place<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.0)?;
        if let Some(line) = self.1 {
            write!(out, ":{line}")?;
        }
        if let Some(column) = self.2 {
            write!(out, ":{column}")?;
        }
        Ok(())
    }
}

/// Returns an excerpt of `text` for errors. It is quoted, truncated and on one line.
pub(crate) fn quoted(text: &str) -> String {
    let mut excerpt: String = text.chars().take(EXCERPT).collect();
    if excerpt.len() < text.len() {
        excerpt.push('…');
    }
    format!("`{}`", one_line(&excerpt))
}

/// Returns `text` with escapes for every character that could break or disguise the line: control characters,
/// separators and direction marks.
pub(crate) fn one_line(text: &str) -> String {
    tamed(text, |_| false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_displayed_on_one_line() {
        let error = ReadError::at("odd\nname", 3, "`N atoms`", quoted("a\r\u{2028}b")).with_column(7);
        assert_eq!(error.to_string(), "odd\\u{a}name:3:7: expected `N atoms`, found `a\\u{d}\\u{2028}b`");
    }

    #[test]
    fn cuts_a_long_excerpt() {
        let text = quoted(&"é".repeat(1000));
        assert_eq!(text.chars().count(), EXCERPT + 3);
        assert!(text.ends_with("…`"));
    }

    #[test]
    fn leaves_the_line_out_where_there_is_none() {
        let error = ReadError::opening("gone", io::Error::new(io::ErrorKind::NotFound, "no file"));
        assert_eq!(error.to_string(), "gone: expected a readable file, found no file");
        assert_eq!(error.line(), None);
    }
}
