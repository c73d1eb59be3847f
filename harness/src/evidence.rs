//! What kind of evidence a row is. It follows from its source and its expectation, and is never typed beside them.

use serde::{Deserialize, Serialize};

/// What kind of source the expected value has, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// An exact solution of the same equations.
    Analytic,
    /// A measurement on real grains.
    Experiment,
    /// Another program ran the same scene: a run of it is stored, or it was run now.
    OtherCode,
    /// A figure or statement printed in a paper.
    Paper,
    /// An independent prototype, whose numbers are stored.
    Prototype,
    /// Our own results at several resolutions, or by several methods.
    Convergence,
    /// A law that holds whatever the answer is: conservation, symmetry, determinism.
    Invariant,
    /// Today's value, kept so that a change is seen. It shows nothing about being right.
    Regression,
}

impl Evidence {
    /// Every kind.
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

    /// The word used in result files and tables.
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
