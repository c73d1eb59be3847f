//! Rows of the study of stability: largest stable steps, and hard cases.

use serde::{Deserialize, Serialize};

/// The largest stable step of an assembly with one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Assembly, such as `square lattice of discs`.
    pub scene: String,
    /// Name of the knob beside the step, such as `k_s/k_n`; empty where there is none.
    pub knob: String,
    /// Its value.
    pub at: Option<f64>,
    /// Solver.
    pub solver: String,
    /// What steps are divided by, such as `√(m/k)`.
    pub unit: String,
    /// Largest step that was stable.
    pub found: Option<f64>,
    /// Smallest step that was not.
    pub unstable: Option<f64>,
    /// Exact limit.
    pub exact: Option<f64>,
    /// (found − exact)/exact.
    pub error: Option<f64>,
    /// The step that is taken by default.
    pub default: Option<f64>,
    /// Found over default.
    pub margin: Option<f64>,
    /// How it fails above, or why there is no number.
    pub detail: String,
}

/// How a solver stands in a hard case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hardness {
    /// What must hold does, at the default step.
    Holds,
    /// It does at a smaller step.
    HoldsAtASmallerStep,
    /// The run ends in an error that says when, where and why, at the default step and at smaller ones.
    TypedFailure,
    /// The run ends as if nothing were wrong, and what must hold does not.
    QuietlyWrong,
    /// The solver cannot express the scene.
    Unsupported,
    /// A program that is not installed.
    NotAvailable,
}

impl Hardness {
    /// The word used in tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsAtASmallerStep => "holds at a smaller step",
            Self::TypedFailure => "typed failure",
            Self::QuietlyWrong => "quietly wrong",
            Self::Unsupported => "cannot express it",
            Self::NotAvailable => "not installed",
        }
    }
}

/// One solver in one hard case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hard {
    /// Name of the case, such as `mass-ratio-1e6`.
    pub case: String,
    /// What must hold.
    pub must: String,
    /// Solver.
    pub solver: String,
    /// How it stands.
    pub standing: Hardness,
    /// The resolution at which it holds, or the default one.
    pub resolution: String,
    /// What was seen at the default step.
    pub detail: String,
}
