//! What a step costs, piece of work by piece of work, as data.

use serde::{Deserialize, Serialize};

/// What a solver takes for a piece of work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Price {
    /// The solver.
    pub solver: String,
    /// The piece: a grain in space, a listed pair, a contact, a material point, a node.
    pub piece: String,
    /// How it was found.
    pub found: String,
    /// Processor time for one in one step, lap by lap (ns).
    pub nanoseconds: Vec<f64>,
}

/// What the machine does at most on one thread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Bytes read and written in a nanosecond, out of the caches' reach, lap by lap.
    pub streamed: Vec<f64>,
    /// Numbers multiplied or added in registers in a nanosecond, lap by lap.
    pub computed: Vec<f64>,
}

/// Prices, beside what the machine can do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Piece by piece.
    pub prices: Vec<Price>,
    /// The machine.
    pub probe: Probe,
}
