//! How far a quantity may be off, how that number was made, and why.

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
    /// Largest |error| that passes; of one that is estimated, the most that it may be.
    pub allowed: f64,
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

    fn new(made: Made, allowed: f64, because: impl Into<String>) -> Self {
        Self { allowed, made, because: because.into() }
    }
}

/// By the formula that the reason states.
#[must_use]
pub fn computed(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Computed, allowed, because)
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

/// By judgement, with the physics that it leaves room for.
#[must_use]
pub fn judged(allowed: f64, because: impl Into<String>) -> Tolerance {
    Tolerance::new(Made::Judged, allowed, because)
}
