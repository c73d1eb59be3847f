//! What is wrong with a scene, said so that its author can mend it.

use crate::text::tamed;
use thiserror::Error;

/// A scene that cannot be used: which file, where, what was expected and what stood there.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}", tamed(&told(self), |_| false))]
pub struct SceneError {
    /// File and line, or the `--set` that brought the value in.
    pub place: String,
    /// Dotted path of the key, empty for the file as a whole.
    pub key: String,
    /// What was expected.
    pub expected: String,
    /// What stood there.
    pub found: String,
    /// How to mend it, where that is known.
    pub help: Option<String>,
}

/// In one sentence, with whatever stood in the file as it stood there.
fn told(error: &SceneError) -> String {
    let SceneError { place, key, expected, found, help } = error;
    format!("{place}: {}expected {expected}, found {found}{}", key_prefix(key), help_suffix(help.as_deref()))
}

fn key_prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

fn help_suffix(help: Option<&str>) -> String {
    help.map(|help| format!(" ({help})")).unwrap_or_default()
}

/// `did you mean …?` for a mistyped word, when one of the known words is close to it.
#[must_use]
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    // A letter too few, too many, another or two in the wrong order: nearer than any likeness.
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

    /// What stood in the file stands in the message, but steers nothing.
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
