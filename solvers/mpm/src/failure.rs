//! What to say when a run breaks.

use grainbench_scene::record::Owner;
use grainbench_scene::solver::{Broken, Cause, Subject};
use nalgebra::Vector3;

/// A material point that broke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Failure {
    /// Whose it is.
    pub(crate) owner: Owner,
    /// Where it is (m).
    pub(crate) position: Vector3<f64>,
    pub(crate) cause: Cause,
}

impl Failure {
    /// The same with when it was and what may help, of a run with a time step and a critical one (s).
    pub(crate) fn told(self, step: u64, time_step: f64, critical: f64) -> Box<Broken> {
        let advice = if time_step > critical {
            format!("the step was above the limit h/c; {:.4e} s is stable for most scenes", 0.5 * critical)
        } else {
            "the step is within h/c: look at velocities, at the stress update, or refine the grid".to_owned()
        };
        Box::new(Broken {
            time: step as f64 * time_step,
            step,
            subject: match self.owner {
                Owner::Grain(id) => Subject::PointOfGrain(id),
                Owner::Body(at) => Subject::PointOfBody(at + 1),
            },
            position: self.position,
            cause: self.cause,
            time_step,
            critical,
            advice,
        })
    }
}
