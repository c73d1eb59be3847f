//! How far a quantity may be off, how that number was made, and why.

use crate::run::Done;
use serde::{Deserialize, Serialize};

/// How a tolerance was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Made {
    /// By the formula in its reason.
    Computed,
    /// From three levels of resolution: observed order and factor of safety, stored with provenance.
    Estimated,
    /// In units of a confidence interval that the runs themselves give.
    Interval,
    /// None: the bound or the bits hold or do not.
    Exact,
    /// Required: a number that was asked for before the solver existed.
    Required,
    /// By judgement: no formula and no estimate stand behind it.
    Judged,
}

impl Made {
    /// In a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Computed => "computed",
            Self::Estimated => "estimated",
            Self::Interval => "interval",
            Self::Exact => "exact",
            Self::Required => "required",
            Self::Judged => "judged",
        }
    }
}

/// A tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// Largest |error| that passes; of one that is estimated, that of solvers of others; of rounding, in each step.
    allowed: f64,
    /// The most that an estimate may be: above it stands what passes of solvers of others, as a judgement.
    pub(crate) up_to: f64,
    /// Whether it grows with the steps of the first run.
    each_step: bool,
    /// How that number was made.
    pub made: Made,
    /// Why it is what it is.
    pub because: String,
}

impl Tolerance {
    /// How it was made where no estimate is at hand: the most that an estimate may be is a judgement.
    #[must_use]
    pub const fn made_without_estimate(&self) -> Made {
        match self.made {
            Made::Estimated => Made::Judged,
            made => made,
        }
    }

    /// Largest |error| that passes of these runs; of none, in one step.
    #[must_use]
    pub fn of(&self, done: &[Done]) -> f64 {
        self.after(done.first().and_then(|done| done.series().step.last()).copied().unwrap_or(1))
    }

    /// One that is estimated as one whose estimate may be larger than what passes of solvers of others: it is uncertain by more
    /// than it is off.
    #[must_use]
    pub fn up_to(self, most: f64) -> Self {
        Self { up_to: most, ..self }
    }

    fn after(&self, steps: u64) -> f64 {
        if self.each_step { self.allowed * steps as f64 } else { self.allowed }
    }

    fn new(made: Made, allowed: f64, because: impl Into<String>) -> Self {
        Self { allowed, up_to: allowed, each_step: false, made, because: because.into() }
    }
}

/// By the formula that the reason states.
#[must_use]
pub fn computed(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Computed, allowed, because)
}

/// By rounding: a step rounds positions and velocities, each to half a unit in the last place, in the run and in what it is
/// compared with, so that N steps put them apart by at most 2 N ε in units of what is rounded; `lever` is that in units of the
/// row. N is the number of steps of the first run.
#[must_use]
pub fn rounding(lever: f64, because: impl Into<String>) -> Tolerance {
    let because = format!("{}; {:.3} ε in each step", because.into(), 2.0 * lever);
    Tolerance { each_step: true, ..computed(2.0 * lever * f64::EPSILON, because) }
}

/// By three levels of resolution, whose estimate is stored; no wider than `most`.
#[must_use]
pub fn estimated(most: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Estimated, most, because)
}

/// One confidence interval, which the runs themselves give and errors are divided by.
#[must_use]
pub fn one_interval(because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Interval, 1.0, because)
}

/// No tolerance: the bound holds or does not, bits are the same or not.
#[must_use]
pub fn exactly(because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Exact, 0.0, because)
}

/// What was asked for before the solver existed.
#[must_use]
pub fn required(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Required, allowed, because)
}

/// Why an order may be off.
pub(crate) const ASYMPTOTIC: &str =
    "a tenth of the method's order, as ASME V&V 20-2009 asks of levels in the asymptotic range";

/// Of an order of convergence: a tenth of the method's, as ASME V&V 20-2009 (section 2) asks of levels in the asymptotic range.
#[must_use]
pub fn asymptotic(order: f64) -> Tolerance {
    required(0.1 * order, ASYMPTOTIC)
}

/// By judgement, with the physics that it leaves room for.
#[must_use]
pub fn judged(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Judged, allowed, because)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_grows_with_the_steps() {
        assert_eq!(rounding(1.0, "").after(500), 1000.0 * f64::EPSILON);
        assert_eq!(computed(1e-3, "").after(500), 1e-3);
    }
}
