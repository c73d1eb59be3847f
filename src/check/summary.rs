//! Summary of a check in one sentence.

use super::covered::SPARSE;
use super::judgement::{OUTSIDE, is_outside};
use super::power::{HIDDEN, is_of_power};
use grainbench_harness::evidence::Evidence;
use grainbench_harness::verdict::{Outcome, Severity, Verdict};
use grainbench_reports::{Section, number};

/// Largest number of quantities that the sentence names.
const MOST_NAMES: usize = 3;

/// Returns the outcome of a check in words: for each reference, the agreement or the differing quantities with the first
/// time outside the tolerance.
#[must_use]
pub fn sentence(section: &Section) -> String {
    let Some((coverage, rows)) = section.verdicts.split_first() else { return "Nothing was judged.".to_owned() };
    // A result that is red only because of the interval between samples shows no difference.
    let is_sparse = |row: &&Verdict| {
        row.outcome == Outcome::Fail && row.detail.as_deref().is_some_and(|detail| detail.starts_with(SPARSE))
    };
    let (sparse, rows): (Vec<&Verdict>, Vec<&Verdict>) =
        rows.iter().filter(|row| !is_of_power(row)).partition(is_sparse);
    let of = |is_of: &dyn Fn(&Verdict) -> bool| rows.iter().copied().filter(|row| is_of(row)).collect::<Vec<_>>();
    let mut parts = Vec::new();
    if coverage.outcome != Outcome::Pass {
        parts.extend(coverage.detail.as_deref().map(|detail| capital(detail.split("; ").next().unwrap_or(detail))));
    }
    if let Some(detail) = sparse.first().and_then(|row| row.detail.as_deref()) {
        let interval = detail.split("; --partial").next().unwrap_or(detail);
        parts.push(format!("The samples are too far apart: {interval}"));
    }
    let ours = of(&|row| row.source.contains(" convention, at the time step"));
    let convention = ours.first().map_or("", |row| convention_words(row.source.split(", ").next().unwrap_or_default()));
    parts.extend(agreement(&ours, convention));
    parts.extend(agreement(&of(&|row| row.evidence == Evidence::Analytic), "the exact solutions"));
    parts.extend(agreement(&of(&|row| row.source.contains("stored run")), "the stored run"));
    let means = of(&|row| row.source.contains("predictability horizon") && row.outcome != Outcome::NoReference);
    if !means.is_empty() {
        let words = |row: &&&Verdict| {
            let by = row.error.map_or(String::new(), |error| format!(" by {}", number::fraction(error.abs())));
            name(row).to_owned() + &by
        };
        let red: Vec<String> = means.iter().filter(|row| row.outcome.is_red()).map(|row| words(&row)).collect();
        parts.push(match red[..] {
            [] => "The means after the predictability horizon agree within their statistical uncertainty".to_owned(),
            _ => format!("The means after the predictability horizon differ: {}", red.join(", ")),
        });
    }
    let is_open = rows.iter().all(|row| row.outcome.severity() == Severity::Amber);
    if is_open {
        parts.push("No quantity could be judged".to_owned());
    }
    parts.extend(rows.iter().find_map(|row| {
        row.detail.clone().filter(|words| words.ends_with("is the stiffness yours?")).map(|words| capital(&words))
    }));
    parts.extend(hidden(section).filter(|_| !is_open));
    parts
        .iter()
        .map(|part| if part.ends_with('?') { part.clone() } else { format!("{part}.") })
        .collect::<Vec<_>>()
        .join(" ")
}

/// Returns the changes of the scene that the output cannot reveal, in words; `None` if there are none.
fn hidden(section: &Section) -> Option<String> {
    let words = |row: &Verdict| {
        let (name, change) = row.detail.as_deref()?.strip_suffix(HIDDEN)?.split_once(": ")?;
        Some(format!("{name} ({change})"))
    };
    let found: Vec<String> = section.verdicts.iter().filter(|row| is_of_power(row)).filter_map(words).collect();
    (!found.is_empty()).then(|| format!("This output cannot reveal a change of {}", found.join(", ")))
}

/// Returns the contact convention of a solver in words.
fn convention_words(solver: &str) -> &'static str {
    match solver {
        "dem:1979" => "the convention of Cundall & Strack (1979)",
        "dem:lammps" => "LAMMPS' convention",
        "dem:liggghts" => "LIGGGHTS' convention",
        _ => "our default convention",
    }
}

/// Returns the name of the column or the first part of the quantity of a result.
fn name(row: &Verdict) -> &str {
    row.quantity.split(", ").next().unwrap_or_default()
}

/// Returns the agreement of the output with one reference in words; `None` if no quantity was judged.
fn agreement(rows: &[&Verdict], reference: &str) -> Option<String> {
    let differs = |row: &&&Verdict| row.outcome.is_red() || is_outside(row);
    let outside: Vec<&Verdict> = rows.iter().filter(differs).copied().collect();
    let passed: Vec<&Verdict> = rows.iter().filter(|row| row.outcome == Outcome::Pass).copied().collect();
    let largest = |rows: &[&Verdict]| rows.iter().filter_map(|row| row.error.map(f64::abs)).fold(0.0, f64::max);
    if outside.is_empty() {
        let error = largest(&passed);
        let words = if error == 0.0 { "in all digits".to_owned() } else { format!("to {}", number::fraction(error)) };
        return (!passed.is_empty()).then(|| format!("The output agrees with {reference} {words}"));
    }
    let time = |row: &&Verdict| {
        let detail = row.detail.as_deref()?.strip_prefix(OUTSIDE)?;
        detail.split(' ').next()?.parse::<f64>().ok()
    };
    let first = outside.iter().filter_map(time).min_by(f64::total_cmp);
    let since =
        first.map(|time| format!(", first outside at t = {} s", number::significant(time, 6))).unwrap_or_default();
    let names: Vec<&str> = outside.iter().take(MOST_NAMES).map(|row| name(row)).collect();
    let more = outside.len() - names.len();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    // An error that is smaller than the difference between our conventions may come from another convention.
    let is_open = outside.iter().all(|row| !row.outcome.is_red());
    let open = if is_open { "; our conventions differ by more" } else { "" };
    let (error, names) = (number::fraction(largest(&outside)), names.join(", "));
    Some(format!("The output differs from {reference} by up to {error}: {names}{more}{since}{open}"))
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The agreement is followed by the changes that the output cannot reveal.
    #[test]
    fn hidden_changes_follow_the_agreement() {
        let open = |quantity: &str| Verdict::open("heap", quantity, "1");
        let judged = |source: &str, outcome, detail: Option<&str>| Verdict {
            source: source.to_owned(),
            outcome,
            detail: detail.map(str::to_owned),
            error: Some(0.0),
            ..open("all.kinetic_energy, worst of 2 samples")
        };
        let ours = "dem, our nearest convention, at the time step of the file";
        let power = super::super::power::SOURCE;
        let section = |detail: &str| Section {
            verdicts: vec![
                Verdict { outcome: Outcome::Pass, ..open("time of the last sample") },
                judged(ours, Outcome::Pass, None),
                judged(power, Outcome::NoReference, Some(detail)),
            ],
            ..Section::default()
        };
        let agreement = "The output agrees with our default convention in all digits.";
        let hidden = section(&format!("friction: a quarter more or less{HIDDEN}"));
        let words = "This output cannot reveal a change of friction (a quarter more or less).";
        assert_eq!(sentence(&hidden), format!("{agreement} {words}"));
        assert_eq!(sentence(&section("friction: the work limit is reached")), agreement);
        let mut sparse = section("friction: the work limit is reached");
        let interval = "no sample for 0.5 s from t = 0 s; at most 0.05 s is allowed";
        sparse.verdicts[1] = judged(ours, Outcome::Fail, Some(&format!("{interval}; --partial judges the samples")));
        let words = format!("The samples are too far apart: {interval}. No quantity could be judged.");
        assert_eq!(sentence(&sparse), words);
    }
}
