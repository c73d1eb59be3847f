//! Features that results need and that the manifest of an external solver does not declare, in one message.

use super::exit;
use grainbench::reference::outside::named_features;
use grainbench::reports::{Report, number};
use std::collections::BTreeMap;

/// Prints the number of unsupported results and the features that they need, most frequent first. Nothing is printed if
/// no result needs such a feature.
pub(crate) fn tell(report: &Report) {
    let rows = report.verdicts();
    if let Some(message) = message(rows.filter_map(|row| row.detail.as_deref())) {
        exit::say("note", &message);
    }
}

/// Returns the message for the reasons of results.
fn message<'a>(reasons: impl Iterator<Item = &'a str>) -> Option<String> {
    let (mut results, mut counts) = (0, BTreeMap::<(&str, &str), usize>::new());
    for features in reasons.map(named_features).filter(|found| !found.is_empty()) {
        results += 1;
        features.into_iter().for_each(|feature| *counts.entry(feature).or_default() += 1);
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words: Vec<String> = counts.iter().map(|((_, name), count)| format!("{name} ({count})")).collect();
    let mut keys: Vec<String> = counts.iter().map(|((key, _), _)| format!("`can.{key}`")).collect();
    keys.sort();
    keys.dedup();
    let message = format!(
        "{} unsupported: {}; a solver that has these features declares them in SOLVER.toml, {}",
        number::counted(results, "result"),
        words.join(", "),
        keys.join(" and ")
    );
    (results > 0).then_some(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_is_counted_once_for_each_result() {
        let reasons = [
            "it does not declare effects `friction`",
            "one cannot run this scene: it does not declare walls `mesh`; effects `friction`, `cohesion`",
            "it moves one grain",
        ];
        assert_eq!(
            message(reasons.into_iter()).unwrap(),
            "2 results unsupported: friction (2), cohesion (1), mesh (1); a solver that has these features declares them in \
             SOLVER.toml, `can.effects` and `can.walls`"
        );
        assert_eq!(message(reasons[2..].iter().copied()), None);
    }
}
