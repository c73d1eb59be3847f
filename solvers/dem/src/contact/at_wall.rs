//! A grain that touches a wall, made ready for the chain of stages.

use super::chain::{Answer, Memory, Turning, stages};
use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{Options, Touch};
use crate::laws::Constants;
use grainbench_scene::space::Space;

/// A grain that touches a wall, as the loop over walls finds it. The wall is a body of infinite mass and does not
/// rotate by itself.
pub(crate) struct AtWall<'a, S: Space> {
    /// The law between the materials of grain and wall.
    pub(crate) law: &'a Constants,
    /// Unit normal e from the grain to the wall.
    pub(crate) normal: S::Vector,
    /// Distance from the grain's centre to the wall (m).
    pub(crate) distance: f64,
    /// Radius R of the grain (m).
    pub(crate) radius: f64,
    /// Velocity of the grain's centre relative to the wall where it touches (m/s).
    pub(crate) velocity: S::Vector,
    /// Inverse mass 1/m of the grain (1/kg).
    pub(crate) inverse_mass: f64,
    /// Angular velocity ω of the grain (rad/s).
    pub(crate) spin: Option<S::Spin>,
    /// Moment of inertia I of the grain (kg m²), only set for rolling resistance.
    pub(crate) inertia: f64,
}

impl<S: Space> AtWall<'_, S> {
    /// Forces and moments at the contact; `elapsed` is the time since the last evaluation (s).
    #[inline(always)]
    pub(crate) fn respond<N: Normal, T: Tangential<S>, R: Rolling<S>, const RECORD: bool>(
        &self,
        options: &Options,
        elapsed: f64,
        history: &mut Memory<S, T, R>,
    ) -> Answer<S> {
        let touch = Touch {
            law: self.law,
            between: self.normal,
            inverse_distance: 1.0,
            normal: self.normal,
            overlap: self.radius - self.distance,
            velocity: self.velocity,
            effective_mass: 1.0 / self.inverse_mass,
            effective_radius: self.radius,
        };
        let arms = [self.radius - options.arm_reduction * touch.overlap, 0.0];
        let rolling = if R::ACTIVE && options.rolls_by_surface { arms[0] / self.distance } else { 1.0 };
        let turning = self.spin.map(|spin| Turning {
            surface: spin * arms[0],
            relative: spin * rolling,
            inertia: self.inertia + touch.effective_mass * self.radius * self.radius,
        });
        stages::<S, N, T, R, RECORD>(&touch, arms, turning, options, elapsed, history)
    }
}
