//! Patterns with `*`, `?` and `[…]`, as in a shell.

use super::exit::Fault;
use super::names::variants;
use glob::{MatchOptions, Pattern};
use grainbench::cases::registry::CASES;

/// Returns true if a word contains a character that makes it a pattern.
pub(crate) fn is_one(word: &str) -> bool {
    word.contains(['*', '?', '['])
}

/// Reads a pattern. `place` is the option or argument that contains it, for error messages.
pub(crate) fn read(place: &str, text: &str) -> Result<Pattern, Fault> {
    Pattern::new(text)
        .map_err(|error| Fault::input(format!("{place}: expected a pattern, found `{text}`: {}", error.msg)))
}

/// Replaces each pattern by the matching names of the registry. For example, `incline-*` selects cases, and `*/60deg*`
/// selects variants.
pub(crate) fn expanded(names: &[String]) -> Result<Vec<String>, Fault> {
    /// Options for matching patterns: `*` does not match the `/` between a case and its variant.
    const IN_PARTS: MatchOptions =
        MatchOptions { case_sensitive: true, require_literal_separator: true, require_literal_leading_dot: false };
    let mut all = Vec::new();
    for name in names {
        if !is_one(name) || std::path::Path::new(name).is_dir() {
            all.push(name.clone());
            continue;
        }
        let pattern = read("CASE", name)?;
        let before = all.len();
        for case in CASES {
            if !name.contains('/') {
                all.extend(pattern.matches_with(case.name, IN_PARTS).then(|| case.name.to_owned()));
                continue;
            }
            let variants = variants(case, &(case.claims)())?;
            let full = variants.iter().map(|variant| format!("{}/{variant}", case.name));
            all.extend(full.filter(|full| pattern.matches_with(full, IN_PARTS)));
        }
        if all.len() == before {
            return Err(Fault::unknown("cases that a pattern stands for", name, CASES.iter().map(|case| case.name)));
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_stand_for_cases_or_for_variants() {
        let expand = |name: &str| expanded(&[name.to_owned()]).map_err(|fault| fault.to_string());
        assert_eq!(expand("incline-*").unwrap(), ["incline-disc", "incline-sphere"]);
        assert_eq!(expand("*-sphere/45deg*").unwrap(), ["incline-sphere/45deg-mu.495"]);
        assert_eq!(expand("squahs").unwrap(), ["squahs"], "a name is not looked up here");
        assert!(expand("incline-*x").unwrap_err().contains("incline-disc"));
        assert!(expand("[").unwrap_err().contains("expected a pattern"));
    }
}
