//! What a gate concluded: one row of every table the project prints.

use grainbench_scene::solver::RunError;
use serde::{Deserialize, Serialize};

/// What kind of source the expected value has, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// An exact solution of the same equations.
    Analytic,
    /// A measurement on real grains.
    Experiment,
    /// Another program ran the same scene.
    OtherCode,
    /// A figure or statement printed in a paper.
    Paper,
    /// The solver's own results at several resolutions.
    Convergence,
    /// A law that holds whatever the answer is: conservation, symmetry, determinism.
    Invariant,
}

/// How a row ended. Only `Pass` is green.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
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
    /// The word used in result files and tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Known => "known",
            Self::Stale => "stale",
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
            RunError::Resolution { .. } | RunError::Program { .. } | RunError::Broken(_) | RunError::Checkpoint(_) => {
                Self::Broken
            }
        }
    }
}

impl Evidence {
    /// The word used in result files and tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Analytic => "analytic",
            Self::Experiment => "experiment",
            Self::OtherCode => "other-code",
            Self::Paper => "paper",
            Self::Convergence => "convergence",
            Self::Invariant => "invariant",
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
    /// Rung or rungs of the ladder, such as `dt=.1`.
    pub resolution: String,
    /// What was measured, in words.
    pub quantity: String,
    /// Unit of `value`, `expected` and `scale`; `1` for a pure number.
    pub unit: String,
    /// The measured value; absent when the run broke.
    pub value: Option<f64>,
    /// What it should be.
    pub expected: Option<f64>,
    /// What the difference is divided by.
    pub scale: Option<f64>,
    /// Signed `(value − expected)/scale`; absent when not finite.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
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

/// A negative control: a gate fed with wrong physics, which it must refuse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Case of the gate that was tried.
    pub case: String,
    /// Variant of the gate that was tried.
    pub variant: String,
    /// Solver that ran the wrong physics.
    pub solver: String,
    /// Quantity of the gate that was tried.
    pub quantity: String,
    /// What was made wrong, in words.
    pub wrong_physics: String,
    /// Signed error that the gate saw; absent when not finite or the run broke.
    pub error: Option<f64>,
    /// Largest |error| that would have passed.
    pub allowed: f64,
    /// Whether the gate turned red, as it must.
    pub turned_red: bool,
}
