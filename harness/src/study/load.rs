//! What a step costs of a scene with few grains and with many, start-up apart, as data.

use serde::{Deserialize, Serialize};

/// What a solver took for a scene of so many grains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Grains.
    pub grains: usize,
    /// The solver.
    pub solver: String,
    /// Its resolution.
    pub resolution: String,
    /// Lap by lap.
    pub laps: Vec<Lap>,
    /// Why it took no part.
    pub absent: Option<String>,
}

/// A long run less a short one, in processor time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lap {
    /// All that is no step: reading, setting up, neighbours of the start, settling, output (s).
    pub start_up: f64,
    /// One step (s).
    pub step: f64,
    /// One second of the simulated motion (s).
    pub second: f64,
}
