//! Tolerances: their value, origin and reason.

use crate::run::FinishedRun;
use serde::{Deserialize, Serialize};

/// Origin of the size of a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToleranceOrigin {
    /// A formula, given in the tolerance's reason.
    Computed,
    /// Results at three resolution levels: observed order and factor of safety, stored with provenance.
    Estimated,
    /// A confidence interval from the runs themselves, which is the unit of the error.
    Interval,
    /// Zero: a bound or the equality of bits holds exactly or fails.
    Exact,
    /// A requirement stated before the solver existed.
    Required,
    /// Engineering judgement, without formula or estimate.
    #[default]
    Judged,
}

impl ToleranceOrigin {
    /// Returns the name of the origin in result files.
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

/// Largest |error| that passes, with its origin and reason.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Tolerance {
    /// Largest |error| that passes. For an estimate, this is the limit for external solvers; for rounding, the limit per step.
    allowed: f64,
    /// Largest accepted estimate. If the estimate is larger, the limit for external solvers applies as engineering judgement.
    pub(crate) up_to: f64,
    /// True if the limit grows with the number of steps of the first run.
    each_step: bool,
    /// Origin of the tolerance.
    pub made: ToleranceOrigin,
    /// Reason for the tolerance.
    pub because: String,
}

impl Tolerance {
    /// Returns the origin of the tolerance if no estimate is stored. An estimated tolerance then counts as engineering judgement.
    #[must_use]
    pub const fn made_without_estimate(&self) -> ToleranceOrigin {
        match self.made {
            ToleranceOrigin::Estimated => ToleranceOrigin::Judged,
            made => made,
        }
    }

    /// Returns the largest |error| that passes for these runs. Without runs, it is the limit for one step.
    #[must_use]
    pub fn allowed(&self, done: &[FinishedRun]) -> f64 {
        self.after(done.first().and_then(|done| done.series().step.last()).copied().unwrap_or(1))
    }

    /// Sets the largest accepted estimate. It may exceed the limit for external solvers, because the numerical
    /// uncertainty of a value may be larger than its error.
    pub fn up_to(self, most: f64) -> Self {
        Self { up_to: most, ..self }
    }

    fn after(&self, steps: u64) -> f64 {
        if self.each_step { self.allowed * steps as f64 } else { self.allowed }
    }

    fn new(made: ToleranceOrigin, allowed: f64, because: impl Into<String>) -> Self {
        Self { allowed, up_to: allowed, each_step: false, made, because: because.into() }
    }
}

/// Returns a tolerance from the formula in the reason.
pub fn computed(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Computed, allowed, because)
}

/// Returns a tolerance for rounding errors.
///
/// Each step rounds positions and velocities by half a unit in the last place, in the run and in its reference. After N
/// steps the two differ by at most 2 N ε, in units of the rounded quantity. N is the number of steps of the first run.
/// `lever` converts these units to units of the result.
pub fn rounding(lever: f64, because: impl Into<String>) -> Tolerance {
    let because = format!("{}; {:.3} ε in each step", because.into(), 2.0 * lever);
    Tolerance { each_step: true, ..computed(2.0 * lever * f64::EPSILON, because) }
}

/// Returns a tolerance that is a stored estimate from three resolution levels. It is at most `most`.
pub fn estimated(most: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Estimated, most, because)
}

/// Returns a tolerance of one confidence interval. The runs determine the interval, which is the unit of the error.
pub fn one_interval(because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Interval, 1.0, because)
}

/// Returns a tolerance of zero, for a bound or for the equality of bits.
pub fn exactly(because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Exact, 0.0, because)
}

/// Returns a tolerance that was required before the solver existed.
pub fn required(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Required, allowed, because)
}

/// Reason for the tolerance of an order of convergence.
pub(crate) const ASYMPTOTIC: &str =
    "a tenth of the order of the method, which ASME V&V 20-2009 requires for levels in the asymptotic range";

/// Returns the tolerance of an order of convergence: 0.1 of the method's order, as ASME V&V 20-2009 (section 2)
/// requires of levels in the asymptotic range.
pub fn asymptotic(order: f64) -> Tolerance {
    required(0.1 * order, ASYMPTOTIC)
}

/// Returns a tolerance from engineering judgement. The reason names the physics that the tolerance allows for.
pub fn judged(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(ToleranceOrigin::Judged, allowed, because)
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
