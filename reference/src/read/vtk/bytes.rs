//! Content of a file in memory with a reading position.

use crate::read::digits::Digits;
use crate::read::read_error::{ReadError, quoted};

/// File in memory with a reading position.
#[derive(Clone, Copy, Default)]
pub(crate) struct Bytes<'b> {
    file: &'b str,
    all: &'b [u8],
    at: usize,
}

impl<'b> Bytes<'b> {
    pub(crate) const fn new(file: &'b str, all: &'b [u8]) -> Self {
        Self { file, all, at: 0 }
    }

    /// Returns the whole file.
    pub(crate) const fn all(&self) -> &'b [u8] {
        self.all
    }

    /// Returns the name of the file for error messages.
    pub(crate) const fn file(&self) -> &'b str {
        self.file
    }

    /// Returns an error at the line that contains the byte `at`.
    pub(crate) fn error_at(&self, at: usize, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        let before = &self.all[..at.min(self.all.len())];
        let line = memchr::memchr_iter(b'\n', before).count() as u64 + 1;
        ReadError::at(self.file, line, expected, found)
    }

    /// Returns an error at the reading position, with the next word as the actual content.
    pub(crate) fn error(&self, expected: impl Into<String>) -> ReadError {
        let rest = &self.all[self.at.min(self.all.len())..];
        let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let word: Vec<u8> = rest[start..].iter().copied().take_while(|byte| !byte.is_ascii_whitespace()).collect();
        let found =
            if word.is_empty() { "the end of the file".to_owned() } else { quoted(&String::from_utf8_lossy(&word)) };
        let error = self.error_at(self.at + start, expected, found);
        if word.is_empty() { error.cut() } else { error }
    }

    /// Reads the next line without its line end. Returns `None` at the end of the file.
    pub(crate) fn line(&mut self) -> Option<&'b [u8]> {
        let rest = self.all.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Some(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    /// Returns the words of the next line that is not blank. The reading position does not change.
    pub(crate) fn next_words(&self) -> Option<Vec<&'b str>> {
        let mut ahead = *self;
        loop {
            let words: Vec<&str> = std::str::from_utf8(ahead.line()?).ok()?.split_whitespace().collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }

    /// Reads `count` bytes.
    pub(crate) fn take(&mut self, count: usize) -> Result<&'b [u8], ReadError> {
        match self.at.checked_add(count).and_then(|end| self.all.get(self.at..end)) {
            Some(bytes) => {
                self.at += count;
                Ok(bytes)
            }
            None => {
                let found = format!("the end of the file after {}", self.all.len().saturating_sub(self.at));
                Err(self.error_at(self.all.len(), format!("{count} bytes"), found).cut())
            }
        }
    }

    /// Reads `count` printed numbers and updates `digits` from their texts.
    pub(crate) fn printed(&mut self, count: usize, digits: &mut Digits) -> Result<Vec<f64>, ReadError> {
        // Memory grows with the numbers that are present, not with the declared number.
        let mut numbers = Vec::new();
        for _ in 0..count {
            let rest = &self.all[self.at..];
            let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let word = &rest[start..];
            let word = &word[..word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len())];
            match fast_float2::parse::<f64, _>(word) {
                Ok(number) => numbers.push(number),
                Err(_) => return Err(self.error(format!("{count} numbers"))),
            }
            digits.see(word);
            self.at += start + word.len();
        }
        Ok(numbers)
    }
}
