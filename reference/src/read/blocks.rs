//! Lines of an input as bytes. The input is read in large blocks, and lines are not copied.

use std::io::{ErrorKind, Read};

use crate::read::read_error::{ReadError, quoted};

/// Maximum length of a line (B), enough for a dump with a few thousand columns. A file without line ends is refused
/// before it fills the memory.
pub(crate) const LONGEST_LINE: usize = 1 << 16;

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

impl<'l> Line<'l> {
    /// Returns the line as bytes.
    pub(crate) fn raw(self) -> RawLine<'l> {
        RawLine { file: self.file, number: self.number, bytes: self.text.as_bytes(), ended: true }
    }

    /// Returns an error that refers to the whole line.
    pub(crate) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(self.file, self.number, expected, found)
    }
}

/// Reader that splits an input into lines.
pub(crate) struct Blocks<'r> {
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

impl<'r> Blocks<'r> {
    pub(crate) fn new(reader: Box<dyn Read + 'r>, name: &str) -> Self {
        Self {
            reader,
            name: name.to_owned(),
            buffer: vec![0; BLOCK],
            start: 0,
            end: 0,
            at_end: false,
            number: 0,
            ended: true,
        }
    }

    /// Returns the name of the input for error messages.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of the last returned line, or 0 before the first.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Returns the error, marked as a truncation if the last returned line has no line end.
    pub(crate) fn cut_if_unended(&self, error: ReadError) -> ReadError {
        if self.ended { error } else { error.cut() }
    }

    /// Returns the next line, or `None` at the end of the input.
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
    if !before.is_empty() {
        found = format!("{found} after {}", quoted(&last_characters(&before)));
    }
    ReadError::at(file, number, "plain text", found).with_column(before.chars().count() + 1)
}

/// Returns the last characters of `text`, enough to identify the position.
fn last_characters(text: &str) -> String {
    let skipped = text.chars().count().saturating_sub(20);
    text.chars().skip(skipped).collect()
}
