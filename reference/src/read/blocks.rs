//! Lines of an input as bytes, found in large blocks and handed out without being copied.

use std::io::{ErrorKind, Read};

use crate::read::line_reader::Line;
use crate::read::read_error::{ReadError, quoted};

/// The longest line that is read, in bytes: a row of a dump with a few thousand columns. A file without line ends must
/// not fill the memory before it is refused.
pub(crate) const LONGEST_LINE: usize = 1 << 16;

/// Bytes that are asked for at once.
const BLOCK: usize = 1 << 18;

/// One line without its end.
#[derive(Clone, Copy)]
pub(crate) struct RawLine<'b> {
    pub(crate) file: &'b str,
    /// Counted from 1.
    pub(crate) number: u64,
    pub(crate) bytes: &'b [u8],
    /// Whether a line end stood behind it; only the last line of an input may lack it.
    pub(crate) ended: bool,
}

impl<'b> RawLine<'b> {
    /// The line as text, or the fault that it is none.
    pub(crate) fn text(self) -> Result<Line<'b>, ReadError> {
        match (std::str::from_utf8(self.bytes), not_text_at(self.bytes, true)) {
            (Ok(text), None) => Ok(Line { file: self.file, number: self.number, text }),
            (_, place) => Err(not_text(self.file, self.number, self.bytes, place.unwrap_or_default())),
        }
    }
}

/// Cuts an input into lines.
pub(crate) struct Blocks<'r> {
    reader: Box<dyn Read + 'r>,
    name: String,
    buffer: Vec<u8>,
    /// What has been read and not yet handed out lies from here …
    start: usize,
    /// … to here.
    end: usize,
    at_end: bool,
    number: u64,
    /// Whether the line that was handed out last had a line end.
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

    /// How errors call the input.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The number of the line that was handed out last; 0 before the first.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// The error, marked as a cut where the line that was handed out last has no line end.
    pub(crate) fn cut_if_unended(&self, error: ReadError) -> ReadError {
        if self.ended { error } else { error.cut() }
    }

    /// The next line; none at the end of the input.
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

    /// Reads more behind what waits, which is moved to the front.
    fn fill(&mut self) -> Result<(), ReadError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        // A line of the longest length and one byte more always fits.
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

    /// The fault of a line without end: bytes that are no text tell more than its length.
    fn too_long(&self) -> ReadError {
        let number = self.number + 1;
        let waiting = &self.buffer[self.start..self.end];
        let beginning = &waiting[..waiting.len().min(LONGEST_LINE)];
        not_text_at(beginning, false).map_or_else(
            || ReadError::at(&self.name, number, format!("a line of at most {LONGEST_LINE} bytes"), "a longer one"),
            |place| not_text(&self.name, number, beginning, place),
        )
    }
}

/// The first place that belongs to no text: bytes that are not UTF-8, and controls other than blanks. Where the bytes
/// are not `whole`, a character may be cut off at their end.
fn not_text_at(bytes: &[u8], whole: bool) -> Option<usize> {
    let binary = |byte: &u8| *byte == 0x7f || (*byte < 0x20 && !byte.is_ascii_whitespace());
    let invalid = match std::str::from_utf8(bytes) {
        Err(error) if whole || error.error_len().is_some() => Some(error.valid_up_to()),
        _ => None,
    };
    bytes[..invalid.unwrap_or(bytes.len())].iter().position(binary).or(invalid)
}

/// The fault that the byte at `place` of `line` belongs to no text.
fn not_text(file: &str, number: u64, line: &[u8], place: usize) -> ReadError {
    let before = String::from_utf8_lossy(line.get(..place).unwrap_or_default());
    let byte = line.get(place).copied().unwrap_or_default();
    let mut found = format!("the byte 0x{byte:02x}");
    if !before.is_empty() {
        found = format!("{found} after {}", quoted(&last_characters(&before)));
    }
    ReadError::at(file, number, "text in UTF-8", found).with_column(before.chars().count() + 1)
}

/// The end of `text`: enough to recognise the place by.
fn last_characters(text: &str) -> String {
    let skipped = text.chars().count().saturating_sub(20);
    text.chars().skip(skipped).collect()
}
