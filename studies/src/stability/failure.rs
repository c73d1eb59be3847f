//! Kinds of failure of a run.

use grainbench_solver::failure::{Cause, RunError};
use grainbench_solver::record::Snapshot;

/// Failure because of which a time step counts as unstable.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// A position, velocity or spin is infinite or NaN.
    #[error("not finite")]
    NotFinite,
    /// Energy or perturbation exceeds its limit by this factor.
    #[error("growth by a factor {0:.3e}")]
    Growth(f64),
    /// A grain has passed through a wall or another grain.
    #[error("tunnelling: {0}")]
    Tunnelling(String),
    /// Grains do not move or separate although they must.
    #[error("frozen: {0}")]
    Freeze(String),
    /// A cell has collapsed to zero volume.
    #[error("a cell collapsed")]
    CellCollapsed,
    /// The overlap of two grains, in radii, exceeds its limit.
    #[error("overlap of {0:.3} R")]
    Overlap(f64),
    /// Another condition is violated.
    #[error("{0}")]
    Wrong(String),
    /// The solver stopped with this message.
    #[error("{0}")]
    Broken(String),
}

impl Failure {
    /// Returns true if the solver itself reported the failure.
    #[must_use]
    pub const fn is_typed(&self) -> bool {
        matches!(self, Self::Broken(_) | Self::CellCollapsed)
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
