//! Rigid planes with prescribed motion.

use grainbench_scene::motion::Motion;
use grainbench_scene::scene::{Wall, WallShape};
use grainbench_scene::space::Space;
use nalgebra::Vector3;

/// A plane at its current position.
#[derive(Clone, Debug)]
pub(crate) struct RigidPlane<S: Space> {
    /// Point on the plane (m).
    pub(crate) point: S::Vector,
    /// Unit normal out of the solid wall.
    pub(crate) normal: S::Vector,
    /// Force of bodies on the plane in the last step (N).
    pub(crate) force: S::Vector,
    /// Index of its material in the scene.
    pub(crate) material: u16,
    start: [Vector3<f64>; 2],
    motion: Motion,
    centre: Vector3<f64>,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
}

impl<S: Space> RigidPlane<S> {
    /// Returns the plane of a wall, or `None` for walls of other shapes.
    pub(crate) fn new(wall: &Wall) -> Option<Self> {
        let WallShape::Plane { point, normal } = wall.shape else { return None };
        Some(Self {
            point: S::restrict(point),
            normal: S::restrict(normal),
            force: S::ORIGIN,
            material: wall.material,
            start: [point, normal],
            centre: wall.motion.centre,
            motion: wall.motion.clone(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        })
    }

    /// Moves the plane to its position at `time` (s), with the velocity of the step that starts then.
    pub(crate) fn move_to(&mut self, time: f64, time_step: f64) {
        let now = self.motion.displacement(time, time_step);
        self.point = S::restrict(self.motion.moved(self.start[0], &now));
        self.normal = S::restrict(self.motion.turned(self.start[1], &now));
        if self.motion.is_moving() {
            let next = self.motion.displacement(time + time_step, time_step);
            self.velocity = (next.translation - now.translation) / time_step;
            self.spin = (next.rotation - now.rotation) / time_step;
            self.centre = self.motion.centre + now.translation;
        }
    }

    /// Stops the plane, for the phase before time zero.
    pub(crate) fn stop(&mut self) {
        (self.velocity, self.spin) = (Vector3::zeros(), Vector3::zeros());
    }

    /// Returns the height of a position above the plane (m).
    #[inline(always)]
    pub(crate) fn height(&self, position: S::Vector) -> f64 {
        S::dot(position - self.point, self.normal)
    }

    /// Returns the velocity of the plane at a position (m/s).
    #[inline(always)]
    pub(crate) fn velocity(&self, position: S::Vector) -> S::Vector {
        S::restrict(self.velocity + self.spin.cross(&(S::embed(position) - self.centre)))
    }
}
