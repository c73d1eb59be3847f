//! The twin of a run with a finer time step, sampled at the same times.

use grainbench_scene::motion::Moment;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_scene::solver::Resolution;

use crate::deck::Stepping;

/// A scene and a resolution that take `parts` steps for each one of a run.
#[must_use]
pub fn refined(scene: &Scene, stepping: &Stepping, parts: u64) -> (Scene, Resolution) {
    let Stepping { time_step, steps, interval } = *stepping;
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
