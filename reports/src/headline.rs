//! Counts of results by outcome.

use grainbench_harness::control::FailureMode;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::verdict::{ControlResult, Outcome, Severity, Verdict};

use crate::distinct;
use crate::section::Section;

/// All outcomes in the order of the headline.
pub const OUTCOMES: [Outcome; 9] = {
    use Outcome::{Broken, Fail, Known, NoReference, NotAvailable, Outdated, Pass, Stale, Unsupported};
    [Pass, Fail, Broken, Stale, Known, Outdated, NoReference, Unsupported, NotAvailable]
};

/// Counts of results by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Headline {
    /// Numbers of results, by outcome.
    outcomes: [usize; OUTCOMES.len()],
    /// Number of negative controls that were run.
    pub controls: usize,
    /// Number of negative controls that failed as required.
    pub controls_red: usize,
    /// Number of negative controls that failed by error, as required. They are included in `controls_red`.
    pub controls_broken: usize,
    /// Number of passed results that are compared only with earlier values. They do not show that a solver is correct.
    pub regression: usize,
}

impl Headline {
    pub(crate) fn from_results<'a>(
        verdicts: impl IntoIterator<Item = &'a Verdict>,
        controls: impl IntoIterator<Item = &'a ControlResult>,
    ) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            counts.outcomes[verdict.outcome as usize] += 1;
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

    pub(crate) fn of_section(section: &Section) -> Self {
        Self::from_results(&section.verdicts, &section.controls)
    }

    /// Returns the number of results with an outcome.
    #[must_use]
    pub const fn count(self, outcome: Outcome) -> usize {
        self.outcomes[outcome as usize]
    }

    /// Returns the number of passed results.
    #[must_use]
    pub const fn pass(self) -> usize {
        self.count(Outcome::Pass)
    }

    /// Returns the number of all results.
    #[must_use]
    pub fn rows(self) -> usize {
        self.outcomes.iter().sum()
    }

    fn of_severity(self, severity: Severity) -> usize {
        OUTCOMES.into_iter().filter(|outcome| outcome.severity() == severity).map(|outcome| self.count(outcome)).sum()
    }

    /// Returns the passed results out of the conclusive ones, such as `3/5`. If there are none, returns words, because
    /// `0/2` would read as a failure. Amber results have a count of their own.
    pub(crate) fn passed(self) -> String {
        match self.conclusive() {
            0 if OUTCOMES.into_iter().any(|outcome| outcome.is_judged() && self.count(outcome) > 0) => {
                "not conclusive".to_owned()
            }
            0 => "not judged".to_owned(),
            conclusive => format!("{}/{conclusive}", self.pass()),
        }
    }

    /// Returns the number of results that are not amber.
    #[must_use]
    pub fn conclusive(self) -> usize {
        self.rows() - self.amber()
    }

    /// Returns the number of amber results: those that are inconclusive or have a documented error.
    #[must_use]
    pub fn amber(self) -> usize {
        self.of_severity(Severity::Amber)
    }

    /// Returns the number of red results: those that fail, crashed, or have a reference of another scene.
    #[must_use]
    pub fn red(self) -> usize {
        self.of_severity(Severity::Red)
    }

    /// Returns the counts in one sentence. Outcomes without results are left out, except for `pass` and `fail`.
    #[must_use]
    pub fn sentence(self) -> String {
        let is_shown = |outcome: &Outcome| self.count(*outcome) > 0 || matches!(outcome, Outcome::Pass | Outcome::Fail);
        let part = |outcome: Outcome| {
            let regression = match self.regression {
                count if outcome == Outcome::Pass && count > 0 => format!(" ({count} of them regression)"),
                _ => String::new(),
            };
            format!("{} {}{regression}", self.count(outcome), outcome.word())
        };
        let mut text = OUTCOMES.into_iter().filter(is_shown).map(part).collect::<Vec<_>>().join(", ");
        if self.controls > 0 {
            text += &format!("; negative controls: {} of {} turned red", self.controls_red, self.controls);
        }
        if self.controls_broken > 0 {
            text += &format!(", {} of them by breaking", self.controls_broken);
        }
        text
    }
}

/// Returns |error|/allowed. It is infinite if a non-zero error has no tolerance, or if there is no finite error.
pub(crate) fn used_tolerance(verdict: &Verdict) -> f64 {
    if verdict.error == Some(0.0) { 0.0 } else { verdict.closeness().unwrap_or(f64::INFINITY) }
}

/// Returns the judged result with the largest |error|/allowed. Crashed runs and results with a reference of another scene have
/// no error, and are left out.
#[must_use]
pub fn worst<'a>(rows: impl IntoIterator<Item = &'a Verdict>) -> Option<&'a Verdict> {
    let has_error = |outcome: Outcome| outcome.is_judged() && !matches!(outcome, Outcome::Broken | Outcome::Stale);
    let rows = rows.into_iter().filter(|row| has_error(row.outcome));
    rows.max_by(|a, b| used_tolerance(a).total_cmp(&used_tolerance(b)))
}

/// Returns the solvers of a case, each once: first in the order of the results, then solvers that have only runs.
pub(crate) fn solvers(section: &Section) -> Vec<&str> {
    let rows = section.verdicts.iter().map(|verdict| verdict.solver.as_str());
    distinct(rows.chain(section.runs.iter().map(|run| run.solver.as_str())))
}
