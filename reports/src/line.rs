//! Results as one line each, for messages.

use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::verdict::{ControlResult, Outcome, Severity, Verdict};

use crate::number;

/// Returns the lines of results with their reasons, and the number of results of each colour.
#[must_use]
pub fn results(rows: &[&Verdict]) -> String {
    with_reasons(rows, verdict_in_section) + &counts(rows)
}

/// Returns the number of results of each colour.
#[must_use]
pub fn counts(rows: &[&Verdict]) -> String {
    let count = |severity| rows.iter().filter(|row| row.outcome.severity() == severity).count();
    let [pass, amber, fail] = [Severity::Green, Severity::Amber, Severity::Red].map(count);
    format!("{pass} pass, {fail} fail, {amber} amber\n")
}

/// Returns the lines of results with their reasons. Consecutive results with the same reason share one line with it.
#[must_use]
pub fn with_reasons(rows: &[&Verdict], line: fn(&Verdict) -> String) -> String {
    let mut text = String::new();
    for group in rows.chunk_by(|a, b| (&a.because, &a.detail) == (&b.because, &b.detail)) {
        let shares_detail = group.len() > 1;
        for row in group {
            let words = if shares_detail { line(&Verdict { detail: None, ..(*row).clone() }) } else { line(row) };
            text.push_str(&format!("{:<12} {words}\n", row.outcome.word()));
        }
        let of_all = if shares_detail { format!("{} results: ", group.len()) } else { String::new() };
        let detail = group[0].detail.as_deref().filter(|_| shares_detail);
        let reasons: Vec<&str> = detail.into_iter().chain([group[0].because.as_str()]).collect();
        text.push_str(&format!("{:<12} {of_all}{}\n", "", reasons.join("; ")));
    }
    text
}

/// Returns the line `case · solver resolution · quantity value, exact expected (source), error, allowed tolerance`.
#[must_use]
pub fn verdict(verdict: &Verdict) -> String {
    format!("{} · {}", scene_name(&verdict.case, &verdict.variant), within_case(verdict))
}

/// Returns the line of a result without the case: `variant · solver …`.
#[must_use]
pub fn verdict_in_section(verdict: &Verdict) -> String {
    in_section(&verdict.variant, within_case(verdict))
}

/// Returns the line of a negative control: `case · solver · quantity: …`, with wrong physics, error, tolerance, required way
/// of failing and outcome.
#[must_use]
pub fn control(control: &ControlResult) -> String {
    format!("{} · {}", scene_name(&control.case, &control.variant), tried(control))
}

/// Returns the line of a negative control without the case.
pub(crate) fn control_in_section(control: &ControlResult) -> String {
    in_section(&control.variant, tried(control))
}

fn tried(control: &ControlResult) -> String {
    let error = control
        .error
        .map_or_else(|| "no error value".to_owned(), |error| format!("error {}", number::fraction(error.abs())));
    let ControlResult { solver, quantity, wrong_physics, .. } = control;
    let (how, allowed) = (control.how.word(), number::fraction(control.allowed));
    let end = match control.error {
        _ if control.turned_red => format!("failed by {how}, as required"),
        Some(error) if error.abs() <= control.allowed => format!("passed, but must fail by {how}"),
        _ => format!("failed, but not by {how} as required"),
    };
    let detail = control.detail.as_ref().map_or_else(String::new, |detail| format!("; {detail}"));
    format!("{solver} · {quantity}: with {wrong_physics}, {error}, allowed {allowed}: {end}{detail}")
}

/// Returns the word that describes an expected value, by kind of evidence.
pub(crate) const fn expected_word(evidence: Evidence) -> &'static str {
    match evidence {
        Evidence::Analytic => "exact",
        Evidence::Experiment => "measured",
        Evidence::OtherCode => "other code",
        Evidence::Paper => "printed",
        Evidence::Prototype => "prototype",
        Evidence::Convergence => "converged",
        Evidence::Invariant => "required",
        Evidence::Regression => "before",
    }
}

/// Returns the expectation with its unit, such as `1.43 m/s`, `≥ 5` or `order 2`; a dash if there is none.
pub(crate) fn expected(expected: Option<ExpectedValue>, unit: &str) -> String {
    expected.map_or_else(|| "—".to_owned(), |expected| expected.words(|value| number::with_unit(value, unit)))
}

/// Returns `of SCALE` if the scale differs from the magnitude of the expected value or of the nearest bound.
pub(crate) fn scale_note(verdict: &Verdict) -> Option<String> {
    let scale = verdict.scale?;
    let own = verdict.expected.map_or(0.0, |expected| expected.nearest(verdict.value.unwrap_or(0.0)).abs());
    ((scale - own).abs() > 1e-6 * own).then(|| format!("of {}", number::with_unit(scale, &verdict.unit)))
}

fn in_section(variant: &str, line: String) -> String {
    if variant.is_empty() { line } else { format!("{variant} · {line}") }
}

/// Returns the name of a scene: case and variant.
pub(crate) fn scene_name(case: &str, variant: &str) -> String {
    if variant.is_empty() { case.to_owned() } else { format!("{case}/{variant}") }
}

fn within_case(verdict: &Verdict) -> String {
    format!("{} {} · {}", verdict.solver, verdict.resolution, quantity(verdict))
}

/// Returns the line of a result without case, variant, solver and resolution: `quantity value, exact expected …`.
#[must_use]
pub fn quantity(verdict: &Verdict) -> String {
    let Verdict { quantity, unit, source, .. } = verdict;
    let detail = verdict.detail.as_ref().map_or_else(String::new, |detail| format!("; {detail}"));
    if verdict.outcome == Outcome::Broken {
        return format!("{quantity}: broken{detail}");
    }
    let value = verdict.value.map_or_else(|| "no value".to_owned(), |value| number::with_unit(value, unit));
    let expected = verdict.expected.map_or_else(String::new, |expected| {
        format!(", {} {}", expected_word(verdict.evidence), expected.words(number::value))
    });
    let error = verdict.error.map_or_else(
        || "no finite error".to_owned(),
        |error| {
            let scale = scale_note(verdict).map_or_else(String::new, |scale| format!(" {scale}"));
            format!("error {}{scale}", number::fraction(error.abs()))
        },
    );
    let allowed = number::fraction(verdict.allowed);
    format!("{quantity} {value}{expected} ({source}), {error}, allowed {allowed}{detail}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn a_failure_reads_like_a_sentence() {
        let mut row = sample::verdict("backspin", "dem", "v(t=0.5 s)", 1.391, 1.428_571, 0.02);
        row.source = "eq. 26".to_owned();
        assert_eq!(
            verdict(&row).replace('\u{202f}', " "),
            "backspin · dem dt=.1 · v(t=0.5 s) 1.391 m/s, exact 1.42857 (eq. 26), error 2.6 %, allowed 2 %"
        );
        row.outcome = Outcome::Broken;
        row.detail = Some("not finite at t=0.2 s".to_owned());
        assert_eq!(verdict(&row), "backspin · dem dt=.1 · v(t=0.5 s): broken; not finite at t=0.2 s");
    }
}
