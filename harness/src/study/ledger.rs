//! Rows of the ledger of effects: what a scene calls for, and what it is worth.

use serde::{Deserialize, Serialize};

/// What an effect turned out to be worth in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Worth {
    /// It is on; without it a gate turns red.
    Needed,
    /// It is on, and nothing that is gated changes beyond what its gates allow: not worth simulating here.
    NotWorthSimulating,
    /// It is on, and without it nothing could be judged.
    Untold,
    /// It is off; compiled in with a value that does nothing, the answer is the same in every bit.
    Inert,
    /// It is off; compiled in with a value that does nothing, the answer differs.
    NotInert,
}

impl Worth {
    /// The word used in tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Needed => "needed",
            Self::NotWorthSimulating => "not worth simulating here",
            Self::Untold => "untold",
            Self::Inert => "inert",
            Self::NotInert => "not inert",
        }
    }
}

/// What a gated quantity does when an effect is switched off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Quantity.
    pub quantity: String,
    /// Solver.
    pub solver: String,
    /// Signed error with the effect.
    pub with: Option<f64>,
    /// Signed error without it; none where the run broke.
    pub without: Option<f64>,
    /// Largest error that passes.
    pub allowed: f64,
    /// Whether its gate turned red.
    pub red: bool,
}

/// One effect in one scene of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Case.
    pub case: String,
    /// Variant of its scene.
    pub variant: String,
    /// Effect, in words.
    pub effect: String,
    /// Whether the scene calls for it.
    pub on: bool,
    /// The key that turned it on.
    pub key: String,
    /// What it is worth.
    pub worth: Worth,
    /// Every gated quantity without it.
    pub shifts: Vec<Shift>,
    /// Particle-steps and contact evaluations with the effect over those without it.
    pub counts: Option<f64>,
    /// Processor time with the effect over that without it.
    pub time: Option<f64>,
    /// The solvers that an absent effect was tried with.
    #[serde(default)]
    pub tried: Vec<String>,
}
