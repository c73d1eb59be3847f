//! Errors of the TOML reader in plain words.

use crate::error::{did_you_mean, help_suffix};
use crate::text::shortened;
use std::ops::Range;

/// Error in a TOML text, with its position and the expected and the found content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TomlError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Expected content.
    pub expected: String,
    /// Found content.
    pub found: String,
}

impl TomlError {
    /// Describes an error that the TOML reader found in a text.
    #[must_use]
    pub fn new(text: &str, error: &toml::de::Error) -> Self {
        let span = error.span().unwrap_or_default();
        let before = text.get(..span.start).unwrap_or(text);
        let column = before.chars().rev().take_while(|&letter| letter != '\n').count() + 1;
        let is_empty = text.get(span.clone()).is_none_or(|there| there.trim().is_empty());
        let (expected, found) = match expected_syntax(error.message(), is_empty) {
            Some(expected) => (expected.to_owned(), found_at(text, span)),
            None => expected_and_found(error.message()),
        };
        Self { line: before.matches('\n').count() + 1, column, expected, found }
    }
}

/// Returns the expected content for a syntax error of the TOML reader; `None` for other errors. `is_empty` is true if
/// there is no text at the position of the error.
fn expected_syntax(message: &str, is_empty: bool) -> Option<&'static str> {
    let error = message.split_once(", expected ").map_or(message, |(error, _)| error);
    Some(match error {
        "string values must be quoted" if is_empty => "a value after `=`",
        "string values must be quoted" | "invalid boolean" => "a number, `true`, `false`, or text in quotes",
        "invalid basic string" | "invalid multi-line basic string" => "`\"` at the end of the text",
        "invalid literal string" | "invalid multi-line literal string" => "`'` at the end of the text",
        "missing escaped value" => "a character that can follow `\\` in quotes",
        "key with no value" => "`=` and a value after the key",
        "unquoted keys cannot be empty" => "a key",
        "invalid unquoted key" => "a key of letters, digits, `_` and `-`",
        "duplicate key" => "each key only once",
        "unclosed table" | "unclosed array table" => "`]` after the name of the table",
        "unclosed array" | "missing comma between array elements" => "`,` or `]` in the list",
        "unclosed inline table" | "missing comma between key-value pairs" => "`,` or `}` in the table",
        "missing key for inline table element" => "a key or `}` in the table",
        "extra comma in array" | "extra comma in inline table" => "a value before `,`",
        "unexpected key or value" | "unexpected content" => "the end of the line",
        "invalid integer number"
        | "invalid float"
        | "invalid mantissa"
        | "invalid fraction"
        | "invalid exponent"
        | "unexpected leading zero"
        | "`_` may only go between digits" => "a number such as 20, 0.5 or 1e-3",
        _ if error.ends_with("as i128") => "a whole number of at most 18 digits",
        _ if error.starts_with("cannot extend value") => "one value, or one table, for each key",
        _ => return None,
    })
}

/// Returns the text at a position for an error message.
fn found_at(text: &str, span: Range<usize>) -> String {
    let there = text.get(span.clone()).unwrap_or_default().trim();
    let next = text.get(span.start..).unwrap_or_default().trim_start_matches([' ', '\t', '\r']);
    match (there.lines().next(), next.chars().next()) {
        (Some(line), _) => format!("`{}`", shortened(line)),
        (None, Some('\n')) => "the end of the line".to_owned(),
        (None, Some(letter)) => format!("`{letter}`"),
        (None, None) => "the end of the file".to_owned(),
    }
}

/// Converts an error message of the TOML reader to the expected and the found content.
#[must_use]
pub fn expected_and_found(message: &str) -> (String, String) {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let word = quoted.first().copied().unwrap_or_default();
    let unknown = |kind: &str| {
        let known = quoted.get(1..).unwrap_or_default();
        let help = did_you_mean(word, known.iter().copied());
        (format!("{kind} {}", known.join(", ")), format!("`{word}`{}", help_suffix(help.as_deref())))
    };
    if message.starts_with("unknown field") {
        unknown("one of the keys")
    } else if message.starts_with("unknown variant") {
        unknown("one of")
    } else if message.starts_with("missing field") {
        (format!("the key `{word}`"), "none".to_owned())
    } else if let Some((found, expected)) = message.trim().split_once("expected ") {
        let found = found.trim_start_matches("invalid type: ").trim_start_matches("invalid value: ");
        let expected = match expected {
            "f64" => "a number",
            "u8" | "u32" | "u64" | "usize" => "a whole number",
            other => other,
        };
        (expected.to_owned(), found.trim_end().trim_end_matches(',').to_owned())
    } else {
        ("valid TOML".to_owned(), message.replace('\n', ", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of the TOML reader are read at their position and in plain words.
    #[test]
    fn syntax_errors_are_in_plain_words() {
        for (text, expected) in [
            ("a = \n", "1:5: a value after `=`, the end of the line"),
            ("a =", "1:4: a value after `=`, the end of the file"),
            ("b = 1\na = \"x\n", "2:7: `\"` at the end of the text, the end of the line"),
            ("a = 'x\n", "1:7: `'` at the end of the text, the end of the line"),
            ("é = 1", "1:1: a key of letters, digits, `_` and `-`, `é`"),
            ("a = 1\na = 2\n", "2:1: each key only once, `a`"),
            ("[a\nb = 1", "1:3: `]` after the name of the table, the end of the line"),
            ("[a] b = 2", "1:5: the end of the line, `b`"),
            ("a = 1_", "1:6: a number such as 20, 0.5 or 1e-3, `_`"),
            ("a = 01", "1:5: a number such as 20, 0.5 or 1e-3, `0`"),
        ] {
            let error = text.parse::<toml::Table>().unwrap_err();
            let TomlError { line, column, expected: what, found } = TomlError::new(text, &error);
            assert_eq!(format!("{line}:{column}: {what}, {found}"), expected, "{}", error.message());
        }
    }
}
