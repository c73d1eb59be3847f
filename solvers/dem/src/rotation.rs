//! The rotation of a grain: angular velocity ω (rad/s), angle θ (rad) and moment of inertia I (kg m²), or none of them.
//!
//! Where no contact has a tangential force nothing exerts a torque: then [`Rigid`] stands in for [`Rotating`], takes no
//! memory and is not computed with.

use grainbench_scene::space::Space;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// The rotation of a grain, or its absence.
pub trait Rotation<S: Space>: Copy + Debug + Send + Serialize + DeserializeOwned {
    /// Torque M on a grain (N m), or its absence.
    type Torque: Copy + Debug + Default + Send + Serialize + DeserializeOwned;

    /// The rotation at the start, from the angular velocity ω (rad/s) and the inverse of the moment of inertia, 1/I
    /// (1/(kg m²)).
    fn new(spin: S::Spin, inverse_inertia: f64) -> Self;
    /// Angular velocity ω (rad/s); `None` when grains do not rotate.
    fn spin(&self) -> Option<S::Spin>;
    /// Angle θ about the z axis by which the grain has turned since the start (rad); zero in three dimensions.
    fn angle(&self) -> f64;
    /// Takes one time step Δt (s): ω ← keep·ω + gain·M/I, then θ ← θ + ω Δt. Without global damping `keep` is 1 and
    /// `gain` is Δt.
    fn advance(&mut self, torque: Self::Torque, keep: f64, gain: f64, time_step: f64);
    /// Moment of inertia I (kg m²); infinite when grains do not rotate.
    fn inertia(&self) -> f64;
    /// Angular acceleration M/I (rad/s²).
    fn acceleration(&self, torque: Self::Torque) -> S::Spin;
    /// Replaces the angular velocity ω (rad/s).
    fn set_spin(&mut self, spin: S::Spin);
    /// Adds a torque `r × F` (N m) to a sum of torques.
    fn add(sum: &mut Self::Torque, torque: S::Spin);
    /// The torque M (N m) as a vector, or as a scalar in the plane.
    fn torque(torque: Self::Torque) -> S::Spin;
}

/// A grain that does not rotate: it takes no memory and no arithmetic.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Rigid;

/// No torque, on a grain that does not rotate.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct NoTorque;

impl<S: Space> Rotation<S> for Rigid {
    type Torque = NoTorque;

    fn new(_spin: S::Spin, _inverse_inertia: f64) -> Self {
        Self
    }
    fn spin(&self) -> Option<S::Spin> {
        None
    }
    fn angle(&self) -> f64 {
        0.0
    }
    #[inline(always)]
    fn advance(&mut self, _torque: NoTorque, _keep: f64, _gain: f64, _time_step: f64) {}
    fn inertia(&self) -> f64 {
        f64::INFINITY
    }
    fn acceleration(&self, _torque: NoTorque) -> S::Spin {
        S::NO_SPIN
    }
    fn set_spin(&mut self, _spin: S::Spin) {}
    #[inline(always)]
    fn add(_sum: &mut NoTorque, _torque: S::Spin) {}
    fn torque(_torque: NoTorque) -> S::Spin {
        S::NO_SPIN
    }
}

/// A grain that rotates: angular velocity ω (rad/s), inverse moment of inertia 1/I (1/(kg m²)) and angle θ (rad).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Rotating<S: Space> {
    spin: S::Spin,
    inverse_inertia: f64,
    angle: f64,
}

/// Torque M on a grain that rotates (N m).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Torque<S: Space>(S::Spin);

impl<S: Space> Default for Torque<S> {
    #[inline(always)]
    fn default() -> Self {
        Self(S::NO_SPIN)
    }
}

impl<S: Space> Rotation<S> for Rotating<S> {
    type Torque = Torque<S>;

    fn new(spin: S::Spin, inverse_inertia: f64) -> Self {
        Self { spin, inverse_inertia, angle: 0.0 }
    }
    #[inline(always)]
    fn spin(&self) -> Option<S::Spin> {
        Some(self.spin)
    }
    fn angle(&self) -> f64 {
        self.angle
    }
    #[inline(always)]
    fn advance(&mut self, torque: Torque<S>, keep: f64, gain: f64, time_step: f64) {
        self.spin = self.spin * keep + torque.0 * (gain * self.inverse_inertia);
        if S::DIMENSION == 2 {
            self.angle += S::embed_spin(self.spin).z * time_step;
        }
    }
    #[inline(always)]
    fn inertia(&self) -> f64 {
        1.0 / self.inverse_inertia
    }
    fn acceleration(&self, torque: Torque<S>) -> S::Spin {
        torque.0 * self.inverse_inertia
    }
    fn set_spin(&mut self, spin: S::Spin) {
        self.spin = spin;
    }
    #[inline(always)]
    fn add(sum: &mut Torque<S>, torque: S::Spin) {
        sum.0 += torque;
    }
    fn torque(torque: Torque<S>) -> S::Spin {
        torque.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grain_that_does_not_rotate_takes_no_room() {
        assert_eq!((size_of::<Rigid>(), size_of::<NoTorque>()), (0, 0));
    }
}
