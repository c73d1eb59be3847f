//! Kinds of failure of a run.

use grainbench_solver::failure::{Cause, Failure as ProgramFailure, RunError};
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

/// Runs a simulation, and repeats it once if an external program fails.
///
/// An unstable run fails each time. A crash that does not repeat, such as one of MPI before the first step, has another reason
/// and is no evidence of instability.
///
/// # Errors
/// The error of the last run.
pub fn confirmed<T>(mut run: impl FnMut() -> Result<T, RunError>) -> Result<T, RunError> {
    match run() {
        Err(RunError::Program { .. }) => run(),
        result => result,
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
        RunError::Program { failure: ProgramFailure::NotRun(_) | ProgramFailure::Interrupted, .. } => None,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn program(failure: ProgramFailure) -> RunError {
        RunError::Program { solver: "liggghts".to_owned(), failure, last_lines: Vec::new() }
    }

    #[test]
    fn only_a_crash_that_repeats_is_a_failure() {
        let crash = || program(ProgramFailure::Crash("exit status: 1".to_owned()));
        let outcome = |errors: &[RunError]| {
            let mut runs = 0;
            let result = confirmed(|| {
                runs += 1;
                errors.get(runs - 1).cloned().map_or_else(|| Ok(()), Err)
            });
            (runs, result.err())
        };
        assert_eq!(outcome(&[]), (1, None));
        assert_eq!(outcome(&[crash()]), (2, None));
        assert_eq!(outcome(&[crash(), crash()]), (2, Some(crash())));
        let other = RunError::NotAvailable { solver: "liggghts".to_owned(), reason: "not found".to_owned() };
        assert_eq!(outcome(std::slice::from_ref(&other)), (1, Some(other)));
    }

    #[test]
    fn a_program_that_did_not_run_is_not_unstable() {
        assert_eq!(of_error(&program(ProgramFailure::NotRun("no such file".to_owned()))), None);
        assert_eq!(of_error(&program(ProgramFailure::Interrupted)), None);
        let lost = program(ProgramFailure::Crash("lost atoms".to_owned()));
        assert_eq!(of_error(&lost), Some(Failure::Broken(lost.to_string())));
    }
}
