//! How a claim ended: one row of every table the project prints, and the one place where a row is made.

use crate::control::Red;
use crate::evidence::Evidence;
use crate::expect::{Expected, Measured};
use crate::tolerance::Made;
use grainbench_scene::solver::RunError;
use serde::{Deserialize, Serialize};

/// Colour of a result: the one decision about exit codes, pages and summaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// It was judged and passes.
    Green,
    /// It shows nothing, or a documented error.
    Amber,
    /// It fails, its run broke, or its reference is of another scene.
    Red,
}

/// How a row ended. Only `Pass` is green.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Within the allowed error.
    Pass,
    /// Outside the allowed error.
    Fail,
    /// A published method's own documented error.
    Known,
    /// The reference was made from another scene.
    Stale,
    /// It passes on a stored result of other solver sources.
    Outdated,
    /// There is nothing to compare with.
    NoReference,
    /// The solver cannot express this scene.
    Unsupported,
    /// A program that is not installed.
    NotAvailable,
    /// The run ended in a typed error.
    Broken,
}

impl Outcome {
    /// Its colour.
    #[must_use]
    pub const fn severity(self) -> Severity {
        match self {
            Self::Pass => Severity::Green,
            Self::Fail | Self::Broken | Self::Stale => Severity::Red,
            Self::Known | Self::Outdated | Self::NoReference | Self::Unsupported | Self::NotAvailable => {
                Severity::Amber
            }
        }
    }

    /// Whether it is red.
    #[must_use]
    pub const fn is_red(self) -> bool {
        matches!(self.severity(), Severity::Red)
    }

    /// The word used in result files and tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Known => "known",
            Self::Stale => "stale",
            Self::Outdated => "outdated",
            Self::NoReference => "no-reference",
            Self::Unsupported => "unsupported",
            Self::NotAvailable => "not-available",
            Self::Broken => "broken",
        }
    }
}

impl From<&RunError> for Outcome {
    fn from(error: &RunError) -> Self {
        match error {
            RunError::Unsupported { .. } => Self::Unsupported,
            RunError::NotAvailable { .. } => Self::NotAvailable,
            RunError::Stale { .. } => Self::Stale,
            RunError::Resolution { .. }
            | RunError::Program { .. }
            | RunError::Broken(_)
            | RunError::NotFinite { .. }
            | RunError::NotStored(_)
            | RunError::Interrupted { .. }
            | RunError::Checkpoint(_) => Self::Broken,
        }
    }
}

/// One judged quantity of one case: a row of `results.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Case name, such as `nine-discs`.
    pub case: String,
    /// Variant of the case's scene, such as `kappa-1`.
    pub variant: String,
    /// Solver and convention, such as `dem:lammps`.
    pub solver: String,
    /// Level or levels of resolution, such as `dt=.1`.
    pub resolution: String,
    /// What was measured, in words.
    pub quantity: String,
    /// Unit of `value`, `expected` and `scale`; `1` for a pure number.
    pub unit: String,
    /// The measured value; absent when the run broke.
    pub value: Option<f64>,
    /// What it should be.
    pub expected: Option<Expected>,
    /// What the difference is divided by.
    pub scale: Option<f64>,
    /// Signed `(value − expected)/scale`, of a bound how far beyond it; absent when not finite.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// How that number was made.
    pub tolerance: Made,
    /// Why the tolerance is what it is.
    pub because: String,
    /// Kind of source.
    pub evidence: Evidence,
    /// Where the expected value comes from.
    pub source: String,
    /// How the row ended.
    #[serde(rename = "verdict")]
    pub outcome: Outcome,
    /// Reason for an outcome other than pass or fail, or more about a failure (first time outside, …).
    pub detail: Option<String>,
}

impl Verdict {
    /// A row before anything is judged: red until something is found.
    #[must_use]
    pub fn open(case: impl Into<String>, quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            case: case.into(),
            variant: String::new(),
            solver: String::new(),
            resolution: String::new(),
            quantity: quantity.into(),
            unit: unit.into(),
            value: None,
            expected: None,
            scale: None,
            error: None,
            allowed: 0.0,
            tolerance: Made::Exact,
            because: String::new(),
            evidence: Evidence::Invariant,
            source: String::new(),
            outcome: Outcome::Fail,
            detail: None,
        }
    }

    /// The row of a run that left no record.
    #[must_use]
    pub fn ended(self, error: &RunError) -> Self {
        Self { outcome: Outcome::from(error), detail: Some(error.to_string()), ..self }
    }

    /// The row that cannot be judged, with the reason.
    #[must_use]
    pub fn left(self, outcome: Outcome, reason: impl Into<String>) -> Self {
        Self { outcome, detail: Some(reason.into()), ..self }
    }

    /// The row of what was found: green within what is allowed and nowhere else, and never for what is not finite.
    #[must_use]
    pub fn judged(self, found: &Measured) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        let error = found.error();
        let passes = error.is_finite() && error.abs() <= self.allowed;
        Self {
            value: finite(found.value),
            expected: Some(found.expected).filter(|expected| expected.is_finite()),
            scale: finite(found.scale),
            error: finite(error),
            outcome: if passes { Outcome::Pass } else { Outcome::Fail },
            detail: if passes { None } else { found.first_outside(self.allowed) },
            ..self
        }
    }

    /// The row, unless it passes with an allowed error above a part of its scale: amber, with the reason.
    #[must_use]
    pub fn unless_wider_than(self, most: f64) -> Self {
        if self.outcome == Outcome::Pass && self.allowed > most {
            let [allowed, most] = [self.allowed, most].map(|part| 100.0 * part);
            return self.left(
                Outcome::NoReference,
                format!("cannot tell: an error of {allowed:.3} % of the scale is allowed, above {most} %"),
            );
        }
        self
    }

    /// How it turned red, if it did.
    #[must_use]
    pub fn red(&self) -> Option<Red> {
        match self.outcome {
            Outcome::Fail if self.value.is_some() && self.error.is_some() => Some(Red::Value),
            Outcome::Fail | Outcome::Broken => Some(Red::Breaking),
            _ => None,
        }
    }

    /// How near it came to what is allowed: |error|/allowed, 1 at the edge; none where nothing is allowed or nothing
    /// was found.
    #[must_use]
    pub fn closeness(&self) -> Option<f64> {
        self.error.filter(|_| self.allowed > 0.0).map(|error| error.abs() / self.allowed)
    }
}

/// A negative control: a claim fed with wrong physics, which it must refuse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Case of the claim that was tried.
    pub case: String,
    /// Variant of the claim that was tried.
    pub variant: String,
    /// Solver that ran the wrong physics.
    pub solver: String,
    /// Quantity of the claim that was tried.
    pub quantity: String,
    /// What was made wrong, in words.
    pub wrong_physics: String,
    /// How it was to turn red.
    pub how: Red,
    /// Signed error that the claim saw; absent when not finite or the run broke.
    pub error: Option<f64>,
    /// Largest |error| that would have passed.
    pub allowed: f64,
    /// Whether the claim turned red, as it must and how it must.
    pub turned_red: bool,
    /// What the row said, where it did not turn red as it must.
    pub detail: Option<String>,
    /// Time that it took (s), runs that it shares with others included where it did them.
    pub seconds: f64,
}

impl Control {
    /// What came of a row under wrong physics that must turn it red in one way.
    #[must_use]
    pub fn of(row: Verdict, wrong_physics: &str, how: Red, seconds: f64) -> Self {
        let turned_red = row.red() == Some(how);
        Self {
            turned_red,
            case: row.case,
            variant: row.variant,
            solver: row.solver,
            quantity: row.quantity,
            wrong_physics: wrong_physics.to_owned(),
            how,
            error: row.error,
            allowed: row.allowed,
            detail: if turned_red { None } else { row.detail },
            seconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However much is allowed: a run that came to nothing may have been what told how much.
    #[test]
    fn what_is_not_finite_is_never_green() {
        for allowed in [0.0, 1.0, f64::INFINITY, f64::NAN] {
            for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let row = Verdict { allowed, ..Verdict::open("case", "quantity", "1") };
                assert_eq!(row.judged(&Measured::new(value, 0.0, 1.0)).outcome, Outcome::Fail, "{value} of {allowed}");
            }
        }
        let row = Verdict { allowed: f64::NAN, ..Verdict::open("case", "quantity", "1") };
        assert_eq!(row.judged(&Measured::new(0.0, 0.0, 1.0)).outcome, Outcome::Fail);
    }
}
