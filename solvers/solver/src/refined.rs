//! Repetition of a run with a finer time step and the same sample times.

use crate::resolution::Resolution;
use grainbench_scene::motion::Moment;
use grainbench_scene::scene::{Duration, Sampling, Scene};

/// Returns a scene and a resolution with `parts` steps for each step of a given run. The given run has `steps` steps of
/// `time_step` (s), and a sample every `interval` steps.
#[must_use]
pub fn refined(scene: &Scene, time_step: f64, [steps, interval]: [u64; 2], parts: u64) -> (Scene, Resolution) {
    let mut scene = Scene {
        duration: Duration::Cycles(steps * parts),
        sampling: Sampling::Cycles(interval * parts),
        ..scene.clone()
    };
    // Times in cycles are multiplied by `parts`, because the cycles are shorter.
    for phase in scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases) {
        for moment in [&mut phase.start, &mut phase.stop] {
            if let Moment::Cycle(cycle) = moment {
                *cycle *= parts;
            }
        }
    }
    (scene, Resolution::TimeStep(time_step / parts as f64))
}
