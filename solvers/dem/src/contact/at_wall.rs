//! A grain that touches a wall, made ready for the chain of stages.

use super::chain::{Answer, Evaluation, Turning, stages};
use super::normal::Normal;
use super::pair::harmonic;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{Memory, Touch};
use crate::geometry::Geometry;
use crate::laws::Constants;

/// A grain that touches a wall, as the loop over walls finds it. The wall is a body of infinite mass and does not
/// rotate by itself.
pub(crate) struct AtWall<'a, S: Geometry> {
    /// The law between the materials of grain and wall.
    pub(crate) law: &'a Constants<f64>,
    /// Unit normal e from the grain to the wall.
    pub(crate) normal: S::Vectors<f64>,
    /// Distance from the grain's centre to the wall (m).
    pub(crate) distance: f64,
    /// Radius R of the grain (m).
    pub(crate) radius: f64,
    /// Velocity of the grain's centre relative to the wall where it touches (m/s).
    pub(crate) velocity: S::Vectors<f64>,
    /// Inverse mass 1/m of the grain (1/kg).
    pub(crate) inverse_mass: f64,
    /// Angular velocity ω of the grain (rad/s), if it rotates.
    pub(crate) spin: Option<S::Spins<f64>>,
    /// Moment of inertia I of the grain (kg m²), only set for rolling resistance.
    pub(crate) inertia: f64,
}

impl<S: Geometry> AtWall<'_, S> {
    /// Forces and moments at the contact.
    #[inline(always)]
    pub(crate) fn respond<N: Normal, T: Tangential<S>, R: Rolling<S>>(
        &self,
        evaluation: Evaluation<'_>,
        memory: &mut Memory<f64>,
    ) -> Answer<S, f64> {
        let touch = Touch {
            law: self.law,
            between: self.normal,
            inverse_distance: 1.0,
            normal: self.normal,
            overlap: self.radius - self.distance,
            velocity: self.velocity,
            effective_mass: harmonic(self.inverse_mass),
            effective_radius: self.radius,
        };
        let options = evaluation.options;
        let arms = [self.radius - touch.overlap * options.arm_reduction, 0.0];
        let rolling = if R::ACTIVE && options.rolls_by_surface { arms[0] / self.distance } else { 1.0 };
        let turning = self.spin.map(|spin| Turning {
            surface: spin * arms[0],
            relative: spin * rolling,
            inertia: self.inertia + touch.effective_mass * self.radius * self.radius,
        });
        stages::<S, N, T, R, f64>(&touch, arms, turning, evaluation, memory)
    }
}
