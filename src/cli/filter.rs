//! `--filter`: selects results by their properties and outcomes.

use super::exit::{Fault, refuse};
use glob::{MatchOptions, Pattern};
use grainbench::harness::claim::Claim;
use grainbench::harness::evidence::Evidence;
use grainbench::harness::verdict::Outcome;
use grainbench::reports::headline::OUTCOMES;
use std::mem::discriminant;

/// Options for matching patterns: letter case is ignored, and `*` matches any text.
const LOOSE: MatchOptions =
    MatchOptions { case_sensitive: false, require_literal_separator: false, require_literal_leading_dot: false };

/// Keys accepted by `--filter KEY=WHAT`.
const KEYS: [&str; 4] = ["quantity", "source", "evidence", "outcome"];

/// Filter `KEY=WHAT`.
#[derive(Clone, Debug)]
enum Filter {
    Quantity(Pattern),
    Source(Pattern),
    Evidence(Evidence),
    Outcome(Outcome),
}

/// All filters of a command line. For each key that occurs, one of its filters must match.
#[derive(Clone, Debug, Default)]
pub(crate) struct Filters(Vec<Filter>);

impl Filters {
    /// Reads filters from texts of the form `KEY=WHAT`.
    pub(crate) fn read(texts: &[String]) -> Result<Self, Fault> {
        texts.iter().map(|text| read(text)).collect::<Result<_, _>>().map(Self)
    }

    /// Returns true if the filters by quantity, source and evidence select the claim. These properties are known before a run.
    pub(crate) fn means(&self, claim: &Claim) -> bool {
        let matches = |filter: &Filter| match filter {
            Filter::Quantity(pattern) => pattern.matches_with(&claim.quantity, LOOSE),
            Filter::Source(pattern) => pattern.matches_with(&claim.source.words(), LOOSE),
            Filter::Evidence(evidence) => claim.evidence() == *evidence,
            Filter::Outcome(_) => true,
        };
        let has_match =
            |key: &Filter| self.0.iter().any(|other| discriminant(other) == discriminant(key) && matches(other));
        self.0.iter().all(has_match)
    }

    /// Returns the outcomes that the filters name; empty if no filter names an outcome.
    pub(crate) fn outcomes(&self) -> Vec<Outcome> {
        let outcome = |filter: &Filter| match filter {
            Filter::Outcome(outcome) => Some(*outcome),
            _ => None,
        };
        self.0.iter().filter_map(outcome).collect()
    }
}

fn read(text: &str) -> Result<Filter, Fault> {
    let Some((key, what)) = text.split_once('=') else {
        let expected = KEYS.map(|key| format!("{key}=…")).join(", ");
        refuse!("--filter: expected one of {expected}, found `{text}`");
    };
    match key {
        "quantity" => pattern(what).map(Filter::Quantity),
        "source" => pattern(what).map(Filter::Source),
        "evidence" => {
            let found = Evidence::ALL.into_iter().find(|evidence| evidence.word() == what);
            let known = Evidence::ALL.map(Evidence::word);
            found.map(Filter::Evidence).ok_or_else(|| Fault::unknown("a kind of evidence for --filter", what, known))
        }
        "outcome" => {
            let found = OUTCOMES.into_iter().find(|outcome| outcome.word() == what);
            let known = OUTCOMES.map(Outcome::word);
            found.map(Filter::Outcome).ok_or_else(|| Fault::unknown("an outcome for --filter", what, known))
        }
        _ => Err(Fault::unknown("a key for --filter", key, KEYS)),
    }
}

/// Reads a shell pattern. Text without `*`, `?` and `[` is a substring.
fn pattern(what: &str) -> Result<Pattern, Fault> {
    let text = if super::pattern::is_one(what) { what.to_owned() } else { format!("*{what}*") };
    super::pattern::read("--filter", &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_are_those_asked_for() {
        let filters = Filters::read(&["outcome=fail".to_owned(), "outcome=known".to_owned()]).unwrap();
        assert_eq!(filters.outcomes(), [Outcome::Fail, Outcome::Known]);
        assert!(Filters::default().outcomes().is_empty());
    }

    #[test]
    fn words_are_found_anywhere_and_patterns_are_whole() {
        let finds = |what: &str, text: &str| pattern(what).unwrap().matches_with(text, LOOSE);
        assert!(finds("Spin", "final spin, rolling") && !finds("spin*", "final spin") && finds("*spin*", "final spin"));
        assert!(finds("*", "") && !finds("?", "ab"));
    }

    #[test]
    fn what_is_no_filter_is_refused() {
        for text in ["spin", "quantitiy=spin", "outcome=failed", "evidence=", "quantity=[", "=", ""] {
            assert!(Filters::read(&[text.to_owned()]).is_err(), "{text}");
        }
    }
}
