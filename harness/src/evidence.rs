//! Kind of evidence of a result. It follows from the source and the expectation, and is never stated separately.

use serde::{Deserialize, Serialize};

/// Kind of evidence, ordered from strongest to weakest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// An exact solution of the equations of the model.
    Analytic,
    /// A measurement on real grains.
    Experiment,
    /// A run of the same scene with another program, stored or done now.
    OtherCode,
    /// A figure or statement printed in a paper.
    Paper,
    /// An independent prototype, whose numbers are stored.
    Prototype,
    /// Our own results at several resolutions, or by several methods.
    Convergence,
    /// A law that holds for every solution: conservation, symmetry, determinism.
    Invariant,
    /// Value of an earlier version, stored to detect changes. It does not show that the value is correct.
    #[default]
    Regression,
}

impl Evidence {
    /// All kinds, from the strongest to the weakest.
    pub const ALL: [Self; 8] = [
        Self::Analytic,
        Self::Experiment,
        Self::OtherCode,
        Self::Paper,
        Self::Prototype,
        Self::Convergence,
        Self::Invariant,
        Self::Regression,
    ];

    /// Returns the name used in result files and tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Analytic => "analytic",
            Self::Experiment => "experiment",
            Self::OtherCode => "other-code",
            Self::Paper => "paper",
            Self::Prototype => "prototype",
            Self::Convergence => "convergence",
            Self::Invariant => "invariant",
            Self::Regression => "regression",
        }
    }
}
