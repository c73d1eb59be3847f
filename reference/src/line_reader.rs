//! Lines of text of bounded length, with their numbers.

use std::io::{BufRead, ErrorKind};

use crate::decoding::{Decoded, decoded};
use crate::read_error::{ReadError, quoted};

/// The longest line that is read, in bytes. LAMMPS itself stops far below it; a file without line ends must not fill
/// the memory before it is refused.
pub(crate) const LONGEST_LINE: usize = 4096;

/// Reads an input, plain or gzip, line by line, and refuses what is not text.
pub(crate) struct LineReader<'r> {
    reader: Box<dyn BufRead + 'r>,
    name: &'r str,
    number: u64,
    buffer: Vec<u8>,
}

/// One line without its end, and where it stands.
#[derive(Clone, Copy)]
pub(crate) struct Line<'l> {
    pub(crate) file: &'l str,
    pub(crate) number: u64,
    pub(crate) text: &'l str,
}

impl Line<'_> {
    /// The fault that this line has as a whole.
    pub(crate) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(self.file, self.number, expected, found)
    }
}

impl<'r> LineReader<'r> {
    pub(crate) fn new(reader: impl BufRead + 'r, name: &'r str) -> Result<Self, ReadError> {
        match decoded(reader).map_err(|error| ReadError::reading(name, 1, error))? {
            Decoded::Text(reader) => Ok(Self { reader, name, number: 0, buffer: Vec::new() }),
            Decoded::Unreadable(compression) => {
                Err(ReadError::at(name, 1, "plain text or gzip", format!("a file compressed by {compression}")))
            }
        }
    }

    /// The next line; none at the end of the input.
    pub(crate) fn next_line(&mut self) -> Result<Option<Line<'_>>, ReadError> {
        let number = self.number + 1;
        if !self.fill(number)? {
            return Ok(None);
        }
        self.number = number;
        let text = std::str::from_utf8(&self.buffer).map_err(|error| {
            let valid = error.valid_up_to();
            not_text(self.name, number, &self.buffer, valid)
        })?;
        let binary = |byte: u8| byte == 0x7f || (byte < 0x20 && !byte.is_ascii_whitespace());
        if let Some(place) = text.bytes().position(binary) {
            return Err(not_text(self.name, number, &self.buffer, place));
        }
        Ok(Some(Line { file: self.name, number, text }))
    }

    /// The fault that something is missing where the input ends.
    pub(crate) fn error_at_end(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(self.name, self.number.max(1), expected, found)
    }

    /// Puts one line without its end into the buffer; false at the end of the input.
    fn fill(&mut self, number: u64) -> Result<bool, ReadError> {
        self.buffer.clear();
        let mut any = false;
        loop {
            let available = match self.reader.fill_buf() {
                Ok(available) => available,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(ReadError::reading(self.name, number, error)),
            };
            if available.is_empty() {
                return Ok(any);
            }
            any = true;
            let end = available.iter().position(|byte| *byte == b'\n');
            let taken = end.unwrap_or(available.len());
            if self.buffer.len() + taken > LONGEST_LINE {
                return Err(ReadError::at(
                    self.name,
                    number,
                    format!("a line of at most {LONGEST_LINE} bytes"),
                    "a longer one",
                ));
            }
            self.buffer.extend_from_slice(&available[..taken]);
            self.reader.consume(taken + usize::from(end.is_some()));
            if end.is_some() {
                return Ok(true);
            }
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(bytes: &[u8]) -> String {
        let mut lines = LineReader::new(bytes, "f").unwrap();
        loop {
            match lines.next_line() {
                Ok(Some(_)) => {}
                Ok(None) => return "none".to_owned(),
                Err(error) => return error.to_string(),
            }
        }
    }

    #[test]
    fn names_the_byte_that_is_no_text() {
        assert_eq!(fault(b"fine\nab\xffcd\n"), "f:2:3: expected text in UTF-8, found the byte 0xff after `ab`");
        assert_eq!(fault(b"\x00ELF"), "f:1:1: expected text in UTF-8, found the byte 0x00");
        assert_eq!(fault("tab\tand é\r\n".as_bytes()), "none");
    }

    #[test]
    fn bounds_the_line() {
        assert_eq!(fault(&[b'x'; LONGEST_LINE]), "none");
        assert_eq!(fault(&[b'x'; LONGEST_LINE + 1]), "f:1: expected a line of at most 4096 bytes, found a longer one");
    }

    #[test]
    fn reads_a_last_line_without_end() {
        let mut lines = LineReader::new(&b"a\n\nb"[..], "f").unwrap();
        let mut all = Vec::new();
        while let Some(line) = lines.next_line().unwrap() {
            all.push((line.number, line.text.to_owned()));
        }
        assert_eq!(all, [(1, "a".to_owned()), (2, String::new()), (3, "b".to_owned())]);
    }
}
