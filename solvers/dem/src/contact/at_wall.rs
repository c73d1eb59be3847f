//! Contact between a grain and a wall, prepared for the chain of stages.

use super::chain::{Answer, BodyRotations, stages};
use super::normal::Normal;
use super::pair::harmonic;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{ContactInput, ContactRotation, MEMORY, Memory, MidStepNormal, Terms, stiffness_ratio};
use crate::geometry::{Geometry, Linear};
use crate::laws::Constants;

/// Grain in contact with a wall. The wall is a body of infinite mass with prescribed motion.
pub(crate) struct WallContact<'a, S: Geometry> {
    /// Law between the materials of grain and wall.
    pub(crate) law: &'a Constants<f64>,
    /// Unit normal e from the grain to the wall.
    pub(crate) normal: S::Vectors<f64>,
    /// Distance from the grain's centre to the wall (m).
    pub(crate) distance: f64,
    /// Radius R of the grain (m).
    pub(crate) radius: f64,
    /// Velocity of the grain's centre relative to the wall at the contact point (m/s).
    pub(crate) velocity: S::Vectors<f64>,
    /// Inverse mass 1/m of the grain (1/kg).
    pub(crate) inverse_mass: f64,
    /// Angular velocity ω of the grain (rad/s), if it rotates.
    pub(crate) spin: Option<S::Spins<f64>>,
    /// Angular velocity Ω of the wall (rad/s).
    pub(crate) wall_spin: S::Spins<f64>,
    /// Moment of inertia I of the grain (kg m²); only set for rolling resistance.
    pub(crate) inertia: f64,
}

impl<S: Geometry> WallContact<'_, S> {
    /// Returns the forces and moments at the contact.
    #[inline(always)]
    pub(crate) fn respond<N: Normal, T: Tangential<S>, R: Rolling<S>>(
        &self,
        terms: Terms<'_>,
        memory: &mut Memory<f64>,
    ) -> Answer<S, f64> {
        let (options, elapsed, overlap) = (terms.options, terms.elapsed, self.radius - self.distance);
        let middle = self.middle(memory);
        let is_mid_step = options.mid_step && T::MAY_BE_MID_STEP;
        let velocity_normal = if is_mid_step { middle.normal } else { self.normal };
        let chord = if is_mid_step { middle.chord } else { 1.0 };
        let turns = T::TURNED && S::DIMENSION == 3;
        let touch = ContactInput {
            law: self.law,
            between: self.normal,
            inverse_distance: 1.0,
            normal: self.normal,
            overlap,
            velocity_normal,
            turn: self
                .spin
                .filter(|_| turns)
                .map(|spin| ContactRotation::new(middle.normal, spin + self.wall_spin, elapsed)),
            stiffness_ratio: if N::CURVED && T::ACTIVE {
                stiffness_ratio(1.0 / overlap, self.velocity.dot(middle.normal), elapsed)
            } else {
                1.0
            },
            velocity: self.velocity,
            effective_mass: harmonic(self.inverse_mass),
            effective_radius: self.radius,
        };
        let arms = [self.radius - overlap * options.arm_reduction, 0.0];
        let rolling = if R::ACTIVE && options.rolls_by_surface { arms[0] / self.distance } else { 1.0 };
        let turning = self.spin.map(|spin| BodyRotations {
            surface: spin * (arms[0] * chord),
            relative: spin * rolling - self.wall_spin * options.wall_spin,
            inertia: self.inertia + touch.effective_mass * self.radius * self.radius,
        });
        stages::<S, N, T, R, f64>(&touch, arms, turning, terms, memory)
    }

    /// Returns the normal in the middle between the previous and the present force evaluation, and stores the present
    /// normal. It is the present normal for a new contact, if the normal has not changed, and if it has rotated by a
    /// quarter turn or more to another face of the wall.
    #[inline(always)]
    fn middle(&self, memory: &mut Memory<f64>) -> MidStepNormal<S, f64> {
        let remembered = &mut memory[MEMORY - 3..];
        let last = [remembered[0], remembered[1], remembered[2]];
        self.normal.write(remembered);
        let before = S::Vectors::<f64>::read(&last);
        if remembered != last && before.dot(self.normal) > 0.0 {
            MidStepNormal::of_normals(before, self.normal)
        } else {
            MidStepNormal::end(self.normal, self.distance)
        }
    }
}
