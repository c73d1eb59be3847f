//! Errors in a scene, with messages that help its author to correct them.

use crate::text::tamed;
use thiserror::Error;

/// Error in a scene: the file, the position, and the expected and found values.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", tamed(&message(self), |_| false))]
pub struct SceneError {
    /// File and line, or the `--set` option that gave the value.
    pub place: String,
    /// Dotted path of the key; empty for the file as a whole.
    pub key: String,
    /// Expected value.
    pub expected: String,
    /// Found value.
    pub found: String,
    /// Suggested correction, if one is known.
    pub help: Option<String>,
}

/// Returns the error message, in which control characters from the scene file are not yet escaped.
fn message(error: &SceneError) -> String {
    let SceneError { place, key, expected, found, help } = error;
    format!("{place}: {}expected {expected}, found {found}{}", key_prefix(key), help_suffix(help.as_deref()))
}

fn key_prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

fn help_suffix(help: Option<&str>) -> String {
    help.map(|help| format!(" ({help})")).unwrap_or_default()
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
        ("TOML".to_owned(), message.replace('\n', ", "))
    }
}

/// Returns `did you mean …?` for a mistyped word if a known word is close to it.
#[must_use]
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    // One missing, extra, changed or swapped letter counts as closer than any other difference.
    let likeness = |candidate: &str| match strsim::osa_distance(word, candidate) {
        1 if candidate.len() > 2 => 1.0,
        _ => strsim::jaro_winkler(word, candidate),
    };
    known
        .into_iter()
        .map(|candidate| (likeness(candidate), candidate))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| format!("did you mean `{candidate}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_nearer_than_a_likeness() {
        let known = ["dem", "lammps", "mpm", "mpm:gap", "chain", "hertz-chain"];
        for (slip, meant) in [("mmp", "mpm"), ("mpm:gpa", "mpm:gap"), ("chian", "chain"), ("lamps", "lammps")] {
            assert_eq!(did_you_mean(slip, known), Some(format!("did you mean `{meant}`?")));
        }
        assert_eq!(did_you_mean("quux", known), None);
    }

    /// The message is one line: control characters in text from the scene file are escaped.
    #[test]
    fn is_one_line_whatever_stood_there() {
        let error = SceneError {
            place: "s.toml:3".to_owned(),
            key: "title".to_owned(),
            expected: "TOML".to_owned(),
            found: "a\u{1b}[2J\nb".to_owned(),
            help: None,
        };
        assert_eq!(error.to_string(), "s.toml:3: title: expected TOML, found a\\u{1b}[2J\\u{a}b");
    }
}
