//! Counts of results by outcome.

use grainbench_harness::control::FailureMode;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::verdict::{Control, Outcome, Severity, Verdict};

use crate::report::{Report, Section};

/// All outcomes in the order of the headline.
pub const OUTCOMES: [Outcome; 9] = [
    Outcome::Pass,
    Outcome::Fail,
    Outcome::Broken,
    Outcome::Stale,
    Outcome::Known,
    Outcome::Outdated,
    Outcome::NoReference,
    Outcome::Unsupported,
    Outcome::NotAvailable,
];

/// Counts of results by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Headline {
    /// Results within the allowed error.
    pub pass: usize,
    /// Results outside the allowed error.
    pub fail: usize,
    /// Documented errors of published methods.
    pub known: usize,
    /// Results whose reference belongs to another scene.
    pub stale: usize,
    /// Results that pass with a stored result of older solver sources.
    pub outdated: usize,
    /// Results without a reference.
    pub no_reference: usize,
    /// Results whose scene the solver cannot represent.
    pub unsupported: usize,
    /// Results of programs that are not installed.
    pub not_available: usize,
    /// Results whose run ended with an error.
    pub broken: usize,
    /// Negative controls.
    pub controls: usize,
    /// Negative controls that failed as required.
    pub controls_red: usize,
    /// Negative controls that failed by error as required; they are included in `controls_red`.
    pub controls_broken: usize,
    /// Passed results that compare only with earlier values. They do not show that a solver is right.
    pub regression: usize,
}

impl Headline {
    /// Counts results and controls.
    #[must_use]
    pub fn from_results<'a>(
        verdicts: impl IntoIterator<Item = &'a Verdict>,
        controls: impl IntoIterator<Item = &'a Control>,
    ) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            *counts.slot(verdict.outcome) += 1;
            counts.regression +=
                usize::from(verdict.evidence == Evidence::Regression && verdict.outcome == Outcome::Pass);
        }
        for control in controls {
            counts.controls += 1;
            counts.controls_red += usize::from(control.turned_red);
            counts.controls_broken += usize::from(control.turned_red && control.how == FailureMode::Breaking);
        }
        counts
    }

    /// Counts the results and controls of a report.
    #[must_use]
    pub fn of_report(report: &Report) -> Self {
        Self::from_results(
            report.sections.iter().flat_map(|section| &section.verdicts),
            report.sections.iter().flat_map(|section| &section.controls),
        )
    }

    /// Counts the results and controls of a case.
    #[must_use]
    pub fn of_section(section: &Section) -> Self {
        Self::from_results(&section.verdicts, &section.controls)
    }

    /// Returns the number of results with an outcome.
    #[must_use]
    pub fn count(mut self, outcome: Outcome) -> usize {
        *self.slot(outcome)
    }

    /// Returns the number of all results.
    #[must_use]
    pub fn rows(self) -> usize {
        OUTCOMES.into_iter().map(|outcome| self.count(outcome)).sum()
    }

    /// Returns the number of results with a colour.
    #[must_use]
    pub fn of_severity(self, severity: Severity) -> usize {
        OUTCOMES.into_iter().filter(|outcome| outcome.severity() == severity).map(|outcome| self.count(outcome)).sum()
    }

    /// Returns the number of results without a judged value or with a documented error.
    #[must_use]
    pub fn amber(self) -> usize {
        self.of_severity(Severity::Amber)
    }

    /// Returns the number of results that fail, crashed, or have a reference of another scene.
    #[must_use]
    pub fn red(self) -> usize {
        self.of_severity(Severity::Red)
    }

    /// Returns the counts in one sentence. Outcomes without results are left out, except for `pass` and `fail`.
    #[must_use]
    pub fn sentence(self) -> String {
        let mut parts = Vec::new();
        for outcome in OUTCOMES {
            let count = self.count(outcome);
            if count > 0 || matches!(outcome, Outcome::Pass | Outcome::Fail) {
                let regression = if outcome == Outcome::Pass && self.regression > 0 {
                    format!(" ({} of them regression)", self.regression)
                } else {
                    String::new()
                };
                parts.push(format!("{count} {}{regression}", outcome.word()));
            }
        }
        let controls = if self.controls > 0 {
            let broken = if self.controls_broken > 0 {
                format!(", {} of them by breaking", self.controls_broken)
            } else {
                String::new()
            };
            format!("; negative controls: {} of {} turned red{broken}", self.controls_red, self.controls)
        } else {
            String::new()
        };
        format!("{}{controls}", parts.join(", "))
    }

    fn slot(&mut self, outcome: Outcome) -> &mut usize {
        match outcome {
            Outcome::Pass => &mut self.pass,
            Outcome::Fail => &mut self.fail,
            Outcome::Known => &mut self.known,
            Outcome::Stale => &mut self.stale,
            Outcome::Outdated => &mut self.outdated,
            Outcome::NoReference => &mut self.no_reference,
            Outcome::Unsupported => &mut self.unsupported,
            Outcome::NotAvailable => &mut self.not_available,
            Outcome::Broken => &mut self.broken,
        }
    }
}

/// Returns |error| divided by the allowed error. It is infinite if a non-zero error has no tolerance, or if there is no
/// finite error.
#[must_use]
pub fn used_tolerance(verdict: &Verdict) -> f64 {
    match verdict.error.map(f64::abs) {
        Some(0.0) => 0.0,
        Some(error) if error.is_finite() && verdict.allowed > 0.0 => error / verdict.allowed,
        _ => f64::INFINITY,
    }
}

/// Returns the result that uses the largest part of its tolerance, including known errors.
#[must_use]
pub fn worst(section: &Section) -> Option<&Verdict> {
    section
        .verdicts
        .iter()
        .filter(|verdict| matches!(verdict.outcome, Outcome::Pass | Outcome::Fail | Outcome::Known | Outcome::Outdated))
        .max_by(|a, b| used_tolerance(a).total_cmp(&used_tolerance(b)))
}

/// Returns the solvers of a case without duplicates, in the order of their results.
#[must_use]
pub fn solvers(section: &Section) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    let rows = section.verdicts.iter().map(|verdict| verdict.solver.as_str());
    for name in rows.chain(section.runs.iter().map(|run| run.solver.as_str())) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}
