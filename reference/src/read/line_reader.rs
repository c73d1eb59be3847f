//! Lines of text with their numbers. The length of a line is limited.

use std::io::BufRead;

pub(crate) use crate::read::blocks::Line;
use crate::read::blocks::{Blocks, RawLine};
use crate::read::decoding::{InputContent, decoded};
use crate::read::read_error::ReadError;

/// Reader of the lines of an input, which may be plain, gzip or zstd. Input that is not text is an error.
pub(crate) struct LineReader<'r> {
    blocks: Blocks<'r>,
}

/// Opens an input as lines of bytes.
pub(crate) fn blocks<'r>(reader: impl BufRead + 'r, name: &str) -> Result<Blocks<'r>, ReadError> {
    match decoded(reader).map_err(|error| ReadError::reading(name, 1, error))? {
        InputContent::Text(reader) => Ok(Blocks::new(reader, name)),
        InputContent::Unreadable(found) => Err(ReadError::at(name, 1, "plain text, gzip or zstd", found)),
    }
}

impl<'r> LineReader<'r> {
    pub(crate) fn new(reader: impl BufRead + 'r, name: &str) -> Result<Self, ReadError> {
        Ok(Self { blocks: blocks(reader, name)? })
    }

    /// Returns the number of the last line that was read, or 0 before the first.
    pub(crate) fn number(&self) -> u64 {
        self.blocks.number()
    }

    /// Returns the next line, or `None` at the end of the input.
    pub(crate) fn next_line(&mut self) -> Result<Option<Line<'_>>, ReadError> {
        self.blocks.next_line()?.map(RawLine::text).transpose()
    }

    /// Returns the error of content that is missing at the end of the input.
    pub(crate) fn error_at_end(&self, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::at(self.blocks.name(), self.blocks.number().max(1), expected, found)
    }
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
        assert_eq!(fault(b"fine\nab\xffcd\n"), "f:2:3: expected plain text, found the byte 0xff after `ab`");
        assert_eq!(fault(b"\x00ELF"), "f:1:1: expected plain text, found the byte 0x00");
        assert_eq!(fault("tab\tand é\r\n".as_bytes()), "none");
    }

    #[test]
    fn bounds_the_line() {
        assert_eq!(fault(&[b'x'; crate::read::blocks::LONGEST_LINE]), "none");
        assert_eq!(
            fault(&[b'x'; crate::read::blocks::LONGEST_LINE + 1]),
            "f:1: expected a line of at most 65536 bytes, found a longer line"
        );
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
