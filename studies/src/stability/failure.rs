//! Kinds of failure of a run.

use grainbench_solver::failure::{Cause, RunError};
use grainbench_solver::record::Snapshot;
use std::fmt;

/// Failure because of which a time step counts as unstable.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A position, velocity or spin is infinite or NaN.
    NotFinite,
    /// Energy or perturbation exceeds its limit by this factor.
    Growth(f64),
    /// A grain has passed through a wall or another grain.
    Tunnelling(String),
    /// Grains do not move or separate although they must.
    Freeze(String),
    /// A cell has collapsed to zero volume.
    CellCollapsed,
    /// The overlap of two grains, in radii, exceeds its limit.
    Overlap(f64),
    /// Another condition is violated.
    Wrong(String),
    /// The solver stopped with this message.
    Broken(String),
}

impl Failure {
    /// Returns true if the solver itself reported the failure.
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

/// Returns the failure of a run that ended in an error, or `None` for errors that prevent the run.
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

/// Checks that positions, velocities and spins of all grains are finite.
///
/// # Errors
/// When a number is infinite or NaN.
pub fn finite(snapshot: &Snapshot) -> Result<(), Failure> {
    let sound = snapshot.grains.iter().all(|grain| {
        let vectors = [grain.position, grain.velocity, grain.spin];
        vectors.iter().all(|vector| vector.iter().all(|value| value.is_finite()))
    });
    if sound { Ok(()) } else { Err(Failure::NotFinite) }
}
