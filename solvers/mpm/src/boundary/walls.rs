//! Rigid planes with prescribed motion.

use grainbench_scene::motion::Motion;
use grainbench_scene::scene::{Wall, WallShape};
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Plane of a wall, with its current position and velocity.
#[derive(Clone, Debug)]
pub(crate) struct RigidPlane<S: Space> {
    /// Point on the plane (m).
    pub(crate) point: S::Vector,
    /// Unit normal out of the solid wall.
    pub(crate) normal: S::Vector,
    /// Force of bodies on the plane in the last step (N).
    pub(crate) force: S::Vector,
    /// Index of the material in the scene.
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

    /// Moves the plane to its position at `time` (s) and sets its velocity in the step that starts at this time.
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

    /// Sets the velocity to zero, for the relaxation before time zero.
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

#[cfg(test)]
mod tests {
    use crate::options::Setting;
    use crate::trial::prepared;
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;

    /// A plane rotates at .5 rad/s about a centre that starts at (2, 1) m. A ramp to 1 m/s over 2 s moves the centre
    /// along x. In a step from t on, the plane has the velocity (t + Δt/2)/2 m/s + ω × r, with r from the centre at t,
    /// (2 + t²/4, 1) m.
    #[test]
    fn a_plane_turns_about_where_its_centre_is() {
        let text = "dimension = 2\nduration = 0.1\nreference_length = 1.0\n\
            materials.m = { density = 1.0, young_modulus = 1.0, poisson_ratio = 0.0 }\n\
            contacts.m = { between = ['m', 'm'], law = 'coulomb', friction = 0.0 }\n\
            [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\n\
            [walls.w]\nmaterial = 'm'\nplane = { point = [0.0, -5.0], normal = [0.0, 1.0] }\n\
            motion = [{ spin = 0.5, centre = [2.0, 1.0] }, { velocity = [1.0, 0.0], ramp = 2.0 }]\n";
        let (mut simulation, _) = prepared::<Plane>(Setting::BEST, text, 1.0, 2);
        let (plane, time, step) = (&mut simulation.boundary.walls[0], 1.5, 0.01);
        plane.move_to(time, step);
        let place = Vector2::new(0.3, -4.0);
        let arm = place - Vector2::new(2.0 + 0.25 * time * time, 1.0);
        let expected = Vector2::new(0.5 * (time + 0.5 * step) - 0.5 * arm.y, 0.5 * arm.x);
        assert!((plane.velocity(place) - expected).norm() < 1e-13, "{} for {expected}", plane.velocity(place));
    }
}
