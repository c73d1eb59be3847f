//! Lines of an input with their numbers, and the fields of a line. The input is read in large blocks, and lines are not
//! copied.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::ops::RangeBounds;
use std::path::Path;
use std::str::FromStr;

use crate::read::decoding::decoded;
use crate::read::read_error::{ReadError, quoted};

/// Maximum length of a line (B), enough for a dump with a few thousand columns. A file without line ends is refused
/// before it fills the memory.
const LONGEST_LINE: usize = 1 << 16;

/// Size of a read request (B).
const BLOCK: usize = 1 << 18;

/// Line without its line end.
#[derive(Clone, Copy)]
pub(crate) struct RawLine<'b> {
    pub(crate) file: &'b str,
    /// Line number, counted from 1.
    pub(crate) number: u64,
    pub(crate) bytes: &'b [u8],
    /// True if the line has a line end. Only the last line of an input may lack it.
    pub(crate) ended: bool,
}

impl<'b> RawLine<'b> {
    /// Returns the line as text, or an error if it is not text.
    pub(crate) fn text(self) -> Result<Line<'b>, ReadError> {
        match (std::str::from_utf8(self.bytes), not_text_at(self.bytes, true)) {
            (Ok(text), None) => Ok(Line { file: self.file, number: self.number, text }),
            (_, place) => Err(not_text(self.file, self.number, self.bytes, place.unwrap_or_default())),
        }
    }
}

/// Line without its line end, and its position.
#[derive(Clone, Copy)]
pub(crate) struct Line<'l> {
    pub(crate) file: &'l str,
    pub(crate) number: u64,
    pub(crate) text: &'l str,
}

impl Line<'_> {
    /// Returns an error that refers to the whole line.
    pub(crate) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(self.file, self.number, expected, found)
    }
}

/// Reader of the lines of an input, which may be plain, gzip or zstd.
pub(crate) struct Lines<'r> {
    reader: Box<dyn Read + 'r>,
    name: String,
    buffer: Vec<u8>,
    /// Start of the data that have been read but not returned as lines.
    start: usize,
    /// End of the data that have been read but not returned as lines.
    end: usize,
    at_end: bool,
    number: u64,
    /// True if the last returned line has a line end.
    ended: bool,
}

pub(crate) fn opened(path: &Path) -> Result<BufReader<File>, ReadError> {
    let file = File::open(path).map_err(|error| ReadError::opening(&path.to_string_lossy(), error))?;
    Ok(BufReader::new(file))
}

impl<'r> Lines<'r> {
    /// Opens the lines of the file at a path.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        Self::new(opened(path)?, &path.to_string_lossy())
    }

    pub(crate) fn new(reader: impl BufRead + 'r, name: &str) -> Result<Self, ReadError> {
        let reader = decoded(reader).map_err(|error| ReadError::reading(name, 1, error))?;
        let reader = reader.map_err(|found| ReadError::at(name, 1, "plain text, gzip or zstd", found))?;
        let (name, buffer) = (name.to_owned(), vec![0; BLOCK]);
        Ok(Self { reader, name, buffer, start: 0, end: 0, at_end: false, number: 0, ended: true })
    }

    /// Returns the name of the input for error messages.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of the last returned line, or 0 before the first.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Returns an error at the last returned line, or at line 1 before the first.
    pub(crate) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(&self.name, self.number.max(1), expected, found)
    }

    /// Returns the error, marked as a truncation if the last returned line has no line end.
    pub(crate) fn cut_if_unended(&self, error: ReadError) -> ReadError {
        if self.ended { error } else { error.cut() }
    }

    /// Returns the next line as text, or `None` at the end of the input. A line that is not text is an error.
    pub(crate) fn next_text(&mut self) -> Result<Option<Line<'_>>, ReadError> {
        self.next_line()?.map(RawLine::text).transpose()
    }

    /// Returns the next line as bytes, or `None` at the end of the input.
    pub(crate) fn next_line(&mut self) -> Result<Option<RawLine<'_>>, ReadError> {
        let mut searched = 0;
        let length = loop {
            let waiting = &self.buffer[self.start..self.end];
            if let Some(found) = memchr::memchr(b'\n', &waiting[searched..]) {
                break Some(searched + found);
            }
            searched = waiting.len();
            if searched > LONGEST_LINE {
                return Err(self.too_long());
            }
            if self.at_end {
                break None;
            }
            self.fill()?;
        };
        let (length, ended) = (length.unwrap_or(self.end - self.start), length.is_some());
        if length > LONGEST_LINE {
            return Err(self.too_long());
        }
        if length == 0 && !ended {
            return Ok(None);
        }
        let bytes = &self.buffer[self.start..self.start + length];
        self.start += length + usize::from(ended);
        self.number += 1;
        self.ended = ended;
        Ok(Some(RawLine { file: &self.name, number: self.number, bytes, ended }))
    }

    /// Moves the remaining data to the front of the buffer and reads more data after them.
    fn fill(&mut self) -> Result<(), ReadError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        // The buffer always has space for a line of maximum length and one more byte.
        loop {
            match self.reader.read(&mut self.buffer[self.end..]) {
                Ok(count) => {
                    self.end += count;
                    self.at_end = count == 0;
                    return Ok(());
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(ReadError::reading(&self.name, self.number + 1, error)),
            }
        }
    }

    /// Returns the error of a line that is too long. If its beginning is not text, the error reports this instead.
    fn too_long(&self) -> ReadError {
        let number = self.number + 1;
        let waiting = &self.buffer[self.start..self.end];
        let beginning = &waiting[..waiting.len().min(LONGEST_LINE)];
        not_text_at(beginning, false).map_or_else(
            || ReadError::at(&self.name, number, format!("a line of at most {LONGEST_LINE} bytes"), "a longer line"),
            |place| not_text(&self.name, number, beginning, place),
        )
    }
}

/// Returns the first position that is not text: a byte that is not UTF-8, or a control character other than white
/// space. If `whole` is false, the last character may be truncated.
fn not_text_at(bytes: &[u8], whole: bool) -> Option<usize> {
    let binary = |byte: &u8| *byte == 0x7f || (*byte < 0x20 && !byte.is_ascii_whitespace());
    let invalid = match std::str::from_utf8(bytes) {
        Err(error) if whole || error.error_len().is_some() => Some(error.valid_up_to()),
        _ => None,
    };
    bytes[..invalid.unwrap_or(bytes.len())].iter().position(binary).or(invalid)
}

/// Returns the error for the byte at `place` of `line`, which is not text.
fn not_text(file: &str, number: u64, line: &[u8], place: usize) -> ReadError {
    let before = String::from_utf8_lossy(line.get(..place).unwrap_or_default());
    let byte = line.get(place).copied().unwrap_or_default();
    let mut found = format!("the byte 0x{byte:02x}");
    let length = before.chars().count();
    if length > 0 {
        // The last characters are enough to identify the position.
        let last: String = before.chars().skip(length.saturating_sub(20)).collect();
        found = format!("{found} after {}", quoted(&last));
    }
    ReadError::at(file, number, "plain text", found).with_column(length + 1)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(bytes: &[u8]) -> String {
        let mut lines = Lines::new(bytes, "f").unwrap();
        loop {
            match lines.next_text() {
                Ok(Some(_)) => {}
                Ok(None) => return "none".to_owned(),
                Err(error) => return error.to_string(),
            }
        }
    }

    #[test]
    fn names_the_byte_that_is_no_text() {
        assert_eq!(fault(b"fine\nab\xffcd\n"), "f:2:3: expected plain text, found the byte 0xff after `ab`");
        assert_eq!(fault(b"\x00ELF"), "f:1:1: expected plain text, found the byte 0x00");
        assert_eq!(fault("tab\tand é\r\n".as_bytes()), "none");
    }

    #[test]
    fn bounds_the_line() {
        assert_eq!(fault(&[b'x'; LONGEST_LINE]), "none");
        assert_eq!(
            fault(&[b'x'; LONGEST_LINE + 1]),
            "f:1: expected a line of at most 65536 bytes, found a longer line"
        );
    }

    #[test]
    fn reads_a_last_line_without_end() {
        let mut lines = Lines::new(&b"a\n\nb"[..], "f").unwrap();
        let mut all = Vec::new();
        while let Some(line) = lines.next_text().unwrap() {
            all.push((line.number, line.text.to_owned()));
        }
        assert_eq!(all, [(1, "a".to_owned()), (2, String::new()), (3, "b".to_owned())]);
    }
}
