//! Common error of all readers.

use grainbench_scene::error::SceneError;
use grainbench_scene::text::tamed;
use std::io;

/// Maximum length of an excerpt in an error (characters).
const EXCERPT: usize = 60;

/// Error of input that cannot be read, with file, position, and the expected and the actual content.
///
/// The error is displayed on one line as `FILE:LINE: expected …, found …`. An error with a column begins with
/// `FILE:LINE:COLUMN:`, and the error of a file that cannot be opened with `FILE:`.
///
/// Lines and columns are counted from 1. In a compressed file they refer to the decompressed text.
#[derive(Debug, thiserror::Error)]
#[error("{}: expected {expected}, found {found}", place(file, *line, *column))]
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

    /// Returns an error about a file as a whole, or about an option.
    pub(crate) fn whole(file: &str, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { line: None, ..Self::at(file, 0, expected, found) }
    }

    /// Marks the error as a truncation of the input, for example because a job was killed.
    pub(crate) fn cut(self) -> Self {
        Self { is_cut: true, ..self }
    }

    pub(crate) fn with_column(mut self, column: usize) -> Self {
        self.column = Some(column);
        self
    }

    /// Returns the error of the operating system or of the decompression at line `line`.
    pub(crate) fn reading(file: &str, line: u64, source: io::Error) -> Self {
        let found = one_line(&source.to_string());
        let is_cut = source.kind() == io::ErrorKind::UnexpectedEof;
        Self { source: Some(source), is_cut, ..Self::at(file, line, "readable data", found) }
    }

    /// Returns the error of a file that cannot be opened.
    pub(crate) fn opening(file: &str, source: io::Error) -> Self {
        Self { line: None, expected: "a readable file".into(), ..Self::reading(file, 0, source) }
    }

    /// Returns the name of the input, with escapes for characters that would break the line.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns true if the input is truncated. The content before the position of the error is then complete.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// Returns the line number, counted from 1, or `None` if the file cannot be opened.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        self.line
    }
}

impl From<ReadError> for SceneError {
    fn from(error: ReadError) -> Self {
        Self {
            place: place(&error.file, error.line, error.column),
            key: String::new(),
            expected: error.expected.into_string(),
            found: error.found.into_string(),
            help: None,
        }
    }
}

/// Returns the position of an error, as far as it is known.
fn place(file: &str, line: Option<u64>, column: Option<usize>) -> String {
    let numbers = line.into_iter().chain(column.map(|column| column as u64));
    numbers.fold(file.to_owned(), |place, number| format!("{place}:{number}"))
}

/// Returns a quoted excerpt of `text` on one line, for errors.
pub(crate) fn quoted(text: &str) -> String {
    let mut excerpt: String = text.chars().take(EXCERPT).collect();
    if excerpt.len() < text.len() {
        excerpt.push('…');
    }
    format!("`{}`", one_line(&excerpt))
}

/// Returns `text` on one line. Control characters, line separators and direction marks are escaped.
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
}
