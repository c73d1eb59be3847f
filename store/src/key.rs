//! Keys of stored results: hashes of everything that determines a result.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs;
use std::path::Path;
use std::str::FromStr;

/// Number of hexadecimal digits of an [`Id`].
const DIGITS: usize = 32;

/// Returns the hash (64 hexadecimal digits) of a result from the hash of the program that computes it and from the words
/// that describe its inputs.
#[must_use]
pub fn of_words(program: &str, words: &[&str]) -> String {
    hash(program, words).to_hex().to_string()
}

/// Returns the hash of a file's content, or `unreadable`, which equals no hash, if the file cannot be read.
#[must_use]
pub fn of_file(path: &Path) -> String {
    fs::read(path).map_or_else(|_| "unreadable".to_owned(), |bytes| blake3::hash(&bytes).to_hex().to_string())
}

/// Returns the hash of the running program. Every change of a solver, a case or a claim changes it.
#[must_use]
pub fn of_this_program() -> String {
    std::env::current_exe().map_or_else(|_| "unknown".to_owned(), |path| of_file(&path))
}

fn hash(program: &str, words: &[&str]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    for part in std::iter::once(&program).chain(words) {
        // Each part follows its length, so that two different lists never have the same byte sequence.
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize()
}

/// Id of a task: the first half of its hash.
///
/// Equal tasks of the same program have equal ids in every plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(u128);

impl Id {
    /// Computes the id from the hash of the program that will run the task and from the words that describe the task.
    #[must_use]
    pub fn of_words(program: &str, words: &[&str]) -> Self {
        let mut half = [0; 16];
        half.copy_from_slice(&hash(program, words).as_bytes()[..16]);
        Self(u128::from_be_bytes(half))
    }
}

impl FromStr for Id {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_id = text.len() == DIGITS && text.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'));
        let number = if is_id { u128::from_str_radix(text, 16).ok() } else { None };
        number.map(Self).ok_or_else(|| format!("{DIGITS} hexadecimal digits"))
    }
}

impl fmt::Display for Id {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:032x}", self.0)
    }
}

impl Serialize for Id {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Id {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_read_as_it_is_written() {
        let id = Id::of_words("program", &["a", "b"]);
        assert_eq!(id.to_string().parse(), Ok(id));
        assert_ne!(id, Id::of_words("program", &["ab", ""]));
        assert_eq!(id.to_string(), of_words("program", &["a", "b"])[..DIGITS]);
        for wrong in ["", "12", "G".repeat(32).as_str(), "é".repeat(16).as_str(), "+".repeat(32).as_str()] {
            assert!(wrong.parse::<Id>().is_err(), "{wrong}");
        }
    }
}
