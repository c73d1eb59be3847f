//! A run again with a finer time step, sampled at the same times.

use crate::motion::Moment;
use crate::scene::{Duration, Sampling, Scene};
use crate::solver::Resolution;

/// A scene and a resolution that take `parts` steps for each one of a run of `steps` steps of `time_step` (s), sampled
/// every `interval` of them.
#[must_use]
pub fn refined(scene: &Scene, time_step: f64, [steps, interval]: [u64; 2], parts: u64) -> (Scene, Resolution) {
    let mut scene = Scene {
        duration: Duration::Cycles(steps * parts),
        sampling: Sampling::Cycles(interval * parts),
        ..scene.clone()
    };
    // What lasts a number of cycles lasts so many times as many shorter ones.
    for phase in scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases) {
        for moment in [&mut phase.start, &mut phase.stop] {
            if let Moment::Cycle(cycle) = moment {
                *cycle *= parts;
            }
        }
    }
    (scene, Resolution::TimeStep(time_step / parts as f64))
}
