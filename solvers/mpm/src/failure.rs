//! Description of a failed run.

use grainbench_scene::record::Owner;
use grainbench_scene::solver::{Cause, FailedParticle, SimulationFailure};
use nalgebra::Vector3;

/// A material point with an invalid state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Failure {
    /// Grain or body of the point.
    pub(crate) owner: Owner,
    /// Position (m).
    pub(crate) position: Vector3<f64>,
    pub(crate) cause: Cause,
}

impl Failure {
    /// Adds the time, the step and advice, for a run with a time step and a critical time step (s).
    pub(crate) fn into_simulation_failure(self, step: u64, time_step: f64, critical: f64) -> Box<SimulationFailure> {
        let advice = match self.cause {
            Cause::GainedEnergy { .. } => {
                "halve the time step: what a step that is too long makes falls with it; what is left comes from the method, \
                 of which APIC damps most"
                    .to_owned()
            }
            Cause::StartsInside { strain, allowed, .. } => format!(
                "cells {:.1} times as large would do, since the strain is that of the overlap over a cell; or bodies that start \
                 apart and are pressed together by what drives them",
                strain / allowed
            ),
            _ if time_step > critical => {
                format!("the step was above the limit h/c; {:.4e} s is stable for most scenes", 0.5 * critical)
            }
            _ => "the step is within h/c: look at velocities, at the stress update, or refine the grid".to_owned(),
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
