//! A scene in another frame: rotated, mirrored or moving. The result, transformed back, must equal the result of the
//! original scene.

use super::end::NoEnd;
use super::end::{End, rounding};
use super::row::PropertyValue;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::terms::Terms;
use nalgebra::{Matrix3, Vector3};

/// Transformation of a scene: x' = Q x + V t, v' = Q v + V, and ω' = det(Q) Q ω, because the spin ω is a pseudovector.
/// Q is `turn` and V is `speed` (m/s).
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) turn: Matrix3<f64>,
    pub(super) speed: Vector3<f64>,
}

impl View {
    pub(super) fn turned(turn: Matrix3<f64>) -> Self {
        Self { turn, speed: Vector3::zeros() }
    }

    pub(super) fn moving(speed: Vector3<f64>) -> Self {
        Self { turn: Matrix3::identity(), speed }
    }

    fn of_spin(&self) -> Matrix3<f64> {
        self.turn * self.turn.determinant()
    }

    fn seen(&self, scene: &Scene) -> Scene {
        let mut seen = scene.clone();
        for grain in &mut seen.grains {
            grain.position = self.turn * grain.position;
            grain.velocity = self.turn * grain.velocity + self.speed;
            grain.spin = self.of_spin() * grain.spin;
        }
        seen
    }

    fn undone(&self, end: &End) -> End {
        let mut undone = end.clone();
        let back = self.turn.transpose();
        for grain in &mut undone.grains {
            grain.position = back * (grain.position - self.speed * end.time);
            grain.velocity = back * (grain.velocity - self.speed);
            grain.spin = self.of_spin().transpose() * grain.spin;
        }
        undone
    }

    /// Runs the scene and the transformed scene, and returns the difference of the final states after the inverse transformation.
    pub(super) fn compare(&self, solver: &dyn Solver, scene: &Scene, terms: &Terms) -> Result<PropertyValue, NoEnd> {
        let straight = End::from_solver(solver, scene, &terms.resolution)?;
        let seen = End::from_solver(solver, &self.seen(scene), &terms.resolution)?;
        let allowed = rounding(scene, [&straight, &seen]);
        Ok(PropertyValue::deviation(straight.apart(&self.undone(&seen)), straight.reach().1, allowed))
    }
}

/// Reason for the tolerance of a comparison of two runs.
pub(super) const ROUNDING: &str = "rounding, summed over all steps: positions by εL, which changes velocities by \
                                   ω²εLΔt, and velocities by εU; relative to the largest surface speed U of a grain";
/// Quantity and unit of a comparison of two runs.
pub(super) const APART: (&str, &str) = ("worst velocity, spin × radius or position / time apart, in the end", "m/s");
