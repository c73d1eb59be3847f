//! Bytes of a file with a place in them.

use crate::read::digits::Digits;
use crate::read::read_error::{ReadError, quoted};

/// A file in memory and how far it was read.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'b> {
    file: &'b str,
    all: &'b [u8],
    at: usize,
}

impl<'b> Bytes<'b> {
    pub(super) const fn new(file: &'b str, all: &'b [u8]) -> Self {
        Self { file, all, at: 0 }
    }

    /// The whole file.
    pub(super) const fn all(&self) -> &'b [u8] {
        self.all
    }

    /// What errors call it.
    pub(super) const fn file(&self) -> &'b str {
        self.file
    }

    /// A fault at a byte.
    pub(super) fn error_at(&self, at: usize, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        let before = &self.all[..at.min(self.all.len())];
        let line = memchr::memchr_iter(b'\n', before).count() as u64 + 1;
        ReadError::at(self.file, line, expected, found)
    }

    /// A fault at the place of reading: what stands there.
    pub(super) fn error(&self, expected: impl Into<String>) -> ReadError {
        let rest = &self.all[self.at.min(self.all.len())..];
        let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let word: Vec<u8> = rest[start..].iter().copied().take_while(|byte| !byte.is_ascii_whitespace()).collect();
        let found =
            if word.is_empty() { "the end of the file".to_owned() } else { quoted(&String::from_utf8_lossy(&word)) };
        let error = self.error_at(self.at + start, expected, found);
        if word.is_empty() { error.cut() } else { error }
    }

    /// The next line, without its end; none at the end of the file.
    pub(super) fn line(&mut self) -> Option<&'b [u8]> {
        let rest = self.all.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Some(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    /// The next line that is not empty, without going there.
    pub(super) fn next_words(&self) -> Option<Vec<&'b str>> {
        let mut ahead = *self;
        loop {
            let words: Vec<&str> = std::str::from_utf8(ahead.line()?).ok()?.split_whitespace().collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }

    /// So many bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'b [u8], ReadError> {
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

    /// So many printed numbers, and what they tell of their digits.
    pub(super) fn printed(&mut self, count: usize, digits: &mut Digits) -> Result<Vec<f64>, ReadError> {
        // A count that is declared is a claim; memory follows what is there.
        let mut numbers = Vec::new();
        for _ in 0..count {
            let rest = &self.all[self.at..];
            let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let word = &rest[start..];
            let word = &word[..word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len())];
            match fast_float2::parse::<f64, _>(word) {
                Ok(number) => numbers.push(number),
                Err(_) => return Err(self.error(format!("a number, one of {count}"))),
            }
            digits.see(word);
            self.at += start + word.len();
        }
        Ok(numbers)
    }
}
