//! Text from users: reading of files, and safe display of titles, keys and file names.

use std::fs;
use std::io;
use std::path::Path;

/// Largest size of a file written by a user (B).
const MOST: u64 = 1 << 20;

/// Reads a text file written by a user.
///
/// # Errors
/// When the file cannot be read; the error holds the expected and the found value.
pub fn written(path: &Path) -> Result<String, (&'static str, String)> {
    let readable = |reason: io::Error| ("a file that can be read", reason.to_string());
    let found = fs::metadata(path).map_err(readable)?;
    if !found.is_file() || found.len() > MOST {
        return Err(("a plain file of at most a megabyte", "something else".to_owned()));
    }
    let text = fs::read(path).map_err(readable)?;
    String::from_utf8(text).map_err(|_| ("UTF-8", "other bytes".to_owned()))
}

/// Returns the line of a text in which TOML found an error.
#[must_use]
pub fn line_of(text: &str, error: &toml::de::Error) -> Option<usize> {
    error.span().map(|span| text[..span.start.min(text.len())].lines().count().max(1))
}

/// Returns the text with escaped characters instead of control, invisible and direction-changing characters. Characters
/// for which `keeps` is true are not escaped.
#[must_use]
pub fn tamed(text: &str, keeps: impl Fn(char) -> bool) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        let disguises = matches!(
            character,
            '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}'
        );
        if (character.is_control() || disguises) && !keeps(character) {
            safe.extend(character.escape_unicode());
        } else {
            safe.push(character);
        }
    }
    safe
}
