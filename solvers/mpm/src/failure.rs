//! Description of a failed run.

use grainbench_solver::failure::{Cause, FailedParticle, SimulationFailure};
use grainbench_solver::record::Owner;
use nalgebra::Vector3;

/// Failure at a material point, with its cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Failure {
    /// Grain or body of the point.
    pub(crate) owner: Owner,
    /// Position (m).
    pub(crate) position: Vector3<f64>,
    pub(crate) cause: Cause,
}

impl Failure {
    /// Returns the failure with time, step and advice, for a run with a time step and a critical time step (s).
    pub(crate) fn into_simulation_failure(self, step: u64, time_step: f64, critical: f64) -> Box<SimulationFailure> {
        let advice = match self.cause {
            Cause::GainedEnergy { .. } => {
                "halve the time step: an error of a too long step becomes smaller; the remaining error comes from the \
                 method, and APIC damps it most"
                    .to_owned()
            }
            Cause::StartsInside { strain, allowed, .. } => format!(
                "use cells {:.1} times as large, because the strain is the overlap over a cell; or let the bodies \
                 start apart and press them together by their motion",
                strain / allowed
            ),
            _ if time_step > critical => {
                format!("the time step was above the limit h/c; {:.4e} s is stable for most scenes", 0.5 * critical)
            }
            _ => "the time step is below the limit h/c; check the velocities and the stress update, or refine the grid"
                .to_owned(),
        };
        Box::new(SimulationFailure {
            time: step as f64 * time_step,
            step,
            subject: match self.owner {
                Owner::Grain(id) => FailedParticle::PointOfGrain(id),
                Owner::Body(at) => FailedParticle::PointOfBody(at + 1),
            },
            position: self.position,
            cause: self.cause,
            time_step,
            critical,
            advice,
        })
    }
}
