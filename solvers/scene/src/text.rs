//! Functions for text from users: reading of files, and safe display of titles, keys and file names.

use std::fs;
use std::io;
use std::path::Path;

/// Largest size of a file written by a user (B).
const MOST: u64 = 1 << 20;

/// Reads a text file written by a user.
///
/// # Errors
/// When the file cannot be read, is not a regular file, is larger than 1 MiB, or is not UTF-8. The error is the
/// expected and the found value.
pub fn written(path: &Path) -> Result<String, (&'static str, String)> {
    let readable = |reason: io::Error| ("a readable file", reason.to_string());
    let found = fs::metadata(path).map_err(readable)?;
    if !found.is_file() || found.len() > MOST {
        let found = if found.is_file() { format!("{} bytes", found.len()) } else { "a folder or a device".to_owned() };
        return Err(("a plain file of at most 1 MiB", found));
    }
    let text = fs::read(path).map_err(readable)?;
    String::from_utf8(text).map_err(|_| ("UTF-8", "other bytes".to_owned()))
}

/// Largest length of an excerpt in a message (characters).
const EXCERPT: usize = 80;
/// Largest length of a path or of a quoted sentence in a message (characters).
const LONG_EXCERPT: usize = 240;

/// Returns a message with long excerpts shortened in the middle. Excerpts are words, quoted text, and lists in square
/// brackets.
#[must_use]
pub fn shortened(message: &str) -> String {
    let (mut short, mut rest) = (String::with_capacity(message.len()), message);
    while !rest.is_empty() {
        let (excerpt, after) = rest.split_at(excerpt_length(rest));
        let is_sentence = !excerpt.starts_with('[') && excerpt.contains([' ', '/']);
        let most = if is_sentence { LONG_EXCERPT } else { EXCERPT };
        let length = excerpt.chars().count();
        if length <= most {
            short.push_str(excerpt);
        } else {
            short.extend(excerpt.chars().take(most * 3 / 4).chain(['…']));
            short.extend(excerpt.chars().skip(length - most / 4));
        }
        rest = after;
    }
    short
}

/// Returns the length (B) of the list, the quotation, the word or the white space at the start of a text.
fn excerpt_length(text: &str) -> usize {
    let first = text.chars().next().unwrap_or(' ');
    let mut depth = 0_u32;
    let closes = |character: char| match first {
        '[' => {
            depth += u32::from(character == '[');
            depth -= u32::from(character == ']');
            depth == 0
        }
        _ => character == first,
    };
    let inner = if first == '[' { text } else { &text[first.len_utf8()..] };
    let closed = if matches!(first, '`' | '"' | '[') { inner.find(closes) } else { None };
    match closed {
        Some(at) => text.len() - inner.len() + at + 1,
        None if first.is_whitespace() => first.len_utf8(),
        None => {
            let ends = |character: char| character.is_whitespace() || matches!(character, '`' | '"' | '[');
            let is_open = matches!(first, '`' | '"' | '[');
            let word = &text[first.len_utf8()..];
            let end = if is_open { word.find(char::is_whitespace) } else { word.find(ends) };
            end.map_or(text.len(), |at| first.len_utf8() + at)
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_excerpts_are_shortened_and_sentences_are_not() {
        let many = |text: &str| text.repeat(1000);
        for long in [
            format!("s.toml:3: {}: expected a number, found true", many("x")),
            format!("s.toml:3: title: expected a number, found `{}`", many("1+")),
            format!("s.toml:3: title: expected a number, found \"{}\"", many("( ")),
            format!("s.toml:3: gravity: expected [x, y], found [{}0.0]", many("0.0, ")),
            format!("s.toml:3: gravity: expected [x, y], found [{}[0.0]]", many("[0.0, 1.0], ")),
            format!("s.toml:3: gravity: expected [x, y], found {}", many("[")),
            format!("s.toml:3: file: expected a file, found {}", many("1/")),
        ] {
            let short = shortened(&long);
            assert!(short.starts_with("s.toml:3: ") && short.contains(": expected") && short.contains('…'), "{short}");
            assert!(short.chars().count() < 320, "{short}");
        }
        let path = format!(
            "/{}/s.toml:3: expected [x, y] and `a number that is positive`, found `-1`",
            many("ab/").split_at(180).0
        );
        assert_eq!(shortened(&path), path);
    }
}
