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

impl SceneError {
    /// Creates an error about a file as a whole, or about a place in it that has no key.
    #[must_use]
    pub fn of_file(place: String, expected: &str, found: String) -> Self {
        Self { place, key: String::new(), expected: expected.to_owned(), found, help: None }
    }

    /// Returns the error with a suggested correction.
    pub(crate) fn help(self, help: &str) -> Self {
        Self { help: Some(help.to_owned()), ..self }
    }
}

/// Returns the error message, in which control characters from the scene file are not yet escaped.
fn message(error: &SceneError) -> String {
    let SceneError { place, key, expected, found, help } = error;
    let separator = if key.is_empty() { "" } else { ": " };
    format!("{place}: {key}{separator}expected {expected}, found {found}{}", help_suffix(help.as_deref()))
}

pub(crate) fn help_suffix(help: Option<&str>) -> String {
    help.map(|help| format!(" ({help})")).unwrap_or_default()
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
