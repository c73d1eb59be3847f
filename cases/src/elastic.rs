//! A grain as an elastic body on a plane: how it starts, and the change of stiffness that leads to the rigid answer.

use grainbench_scene::body::Settle;
use grainbench_scene::scene::{Duration, Scene};

/// A phase of settling: how long (s), and its mass-proportional damping (1/s).
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// How long (s).
    pub duration: f64,
    /// Damping α (1/s).
    pub damping: f64,
}

/// The first grain touches its plane and comes to rest on it under the part of gravity that presses it there; the run then
/// lasts `time` (s).
pub fn settle(scene: &mut Scene, rest: Rest, time: f64) {
    let normal = scene.dimension.count() - 1;
    scene.grains[0].position[normal] = scene.grains[0].radius;
    let mut gravity = scene.gravity;
    for axis in 0..normal {
        gravity[axis] = 0.0;
    }
    scene.start.settle = Some(Settle { duration: rest.duration, damping: rest.damping, gravity });
    scene.duration = Duration::Seconds(time);
}

/// All moduli times a factor.
pub fn stiffen(scene: &mut Scene, factor: f64) {
    for material in scene.deformable.iter_mut().flatten() {
        material.bulk_modulus *= factor;
        material.shear_modulus *= factor;
    }
}
