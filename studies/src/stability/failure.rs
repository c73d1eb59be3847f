//! How a run fails, told apart.

use grainbench_scene::record::Snapshot;
use grainbench_scene::solver::{Cause, RunError};
use std::fmt;

/// A failure that a step can be called unstable for.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A number is infinite or none.
    NotFinite,
    /// There is more energy, or a larger perturbation, by this factor than there may be.
    Growth(f64),
    /// A grain is on the wrong side of what it cannot pass.
    Tunnelling(String),
    /// What must move does not.
    Freeze(String),
    /// A cell lost its volume.
    CellCollapsed,
    /// Grains overlap by this part of a radius, more than they may.
    Overlap(f64),
    /// Something else that must hold does not.
    Wrong(String),
    /// The solver itself gave up, and said why.
    Broken(String),
}

impl Failure {
    /// Whether the solver said so itself.
    #[must_use]
    pub const fn is_typed(&self) -> bool {
        matches!(self, Self::Broken(_) | Self::CellCollapsed)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(formatter, "not finite"),
            Self::Growth(factor) => write!(formatter, "growth by a factor {factor:.3e}"),
            Self::Tunnelling(what) => write!(formatter, "tunnelling: {what}"),
            Self::Freeze(what) => write!(formatter, "frozen: {what}"),
            Self::CellCollapsed => write!(formatter, "a cell collapsed"),
            Self::Overlap(ratio) => write!(formatter, "overlap of {ratio:.3} R"),
            Self::Wrong(what) => formatter.write_str(what),
            Self::Broken(why) => formatter.write_str(why),
        }
    }
}

/// Why a run that ended in an error failed; nothing when the error says that it could not even begin.
#[must_use]
pub fn of_error(error: &RunError) -> Option<Failure> {
    match error {
        RunError::Broken(broken) => Some(match broken.cause {
            Cause::CollapsedCell { .. } => Failure::CellCollapsed,
            _ => Failure::Broken(broken.to_string()),
        }),
        RunError::Program { .. } => Some(Failure::Broken(error.to_string())),
        _ => None,
    }
}

/// Whether every number of a snapshot is finite.
///
/// # Errors
/// When one is not.
pub fn finite(snapshot: &Snapshot) -> Result<(), Failure> {
    let sound = snapshot.grains.iter().all(|grain| {
        let vectors = [grain.position, grain.velocity, grain.spin];
        vectors.iter().all(|vector| vector.iter().all(|value| value.is_finite()))
    });
    if sound { Ok(()) } else { Err(Failure::NotFinite) }
}
