//! Newton's law for every grain, in central differences, with gravity and global damping where the scene has them.
//!
//! ```text
//! v ← keep·v + gain·(F/m + g)        x ← x + v Δt        ω ← keep·ω + gain·M/I
//! ```
//!
//! Source: Cundall & Strack, Géotechnique 29 (1979) 47–65, eqs. 22 and 22a, and eqs. 35 and 36 with global damping.

use crate::grains::Grains;
use crate::rotation::Rotation;
use grainbench_scene::space::Space;

/// Global damping of the equation of motion, or its absence.
trait Drag {
    /// `keep`, the part of a velocity that is left after a step, and `gain` (s), what an acceleration is multiplied by;
    /// from the rate α (1/s) and the time step Δt (s).
    fn factors(rate: f64, time_step: f64) -> (f64, f64);
    /// `keep · velocity`, without arithmetic where nothing is lost.
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, keep: f64) -> V;
}

/// No global damping: `keep` is 1 and `gain` is Δt.
struct NoDrag;

impl Drag for NoDrag {
    fn factors(_rate: f64, time_step: f64) -> (f64, f64) {
        (1.0, time_step)
    }
    #[inline(always)]
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, _keep: f64) -> V {
        velocity
    }
}

/// A force −α m v, taken at mid-step: v ← [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2) (Cundall & Strack 1979, eq. 35).
struct MassProportional;

impl Drag for MassProportional {
    fn factors(rate: f64, time_step: f64) -> (f64, f64) {
        let half = 0.5 * rate * time_step;
        ((1.0 - half) / (1.0 + half), time_step / (1.0 + half))
    }
    #[inline(always)]
    fn keep<V: std::ops::Mul<f64, Output = V>>(velocity: V, keep: f64) -> V {
        velocity * keep
    }
}

/// What acts on every grain beside its contacts, and for how long.
#[derive(Clone, Copy)]
pub(crate) struct Motion<S: Space> {
    /// Gravity g (m/s²).
    pub(crate) gravity: S::Vector,
    /// Rate α of global damping (1/s).
    pub(crate) global_damping: f64,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
}

impl<S: Space> Motion<S> {
    /// Moves every grain over one step, by the forces on it, and sets those to zero. Whether every grain is still
    /// within `nearby` (m) of its reference position.
    pub(crate) fn advance<R: Rotation<S>>(
        &self,
        grains: &mut Grains<S, R>,
        reference: &[S::Vector],
        nearby: f64,
    ) -> bool {
        match (self.global_damping == 0.0, self.gravity == S::ORIGIN) {
            (true, true) => self.drift::<R, NoDrag, false>(grains, reference, nearby),
            (true, false) => self.drift::<R, NoDrag, true>(grains, reference, nearby),
            (false, true) => self.drift::<R, MassProportional, false>(grains, reference, nearby),
            (false, false) => self.drift::<R, MassProportional, true>(grains, reference, nearby),
        }
    }

    /// The same, compiled for one kind of damping, with gravity or without.
    fn drift<R: Rotation<S>, D: Drag, const GRAVITY: bool>(
        &self,
        grains: &mut Grains<S, R>,
        reference: &[S::Vector],
        nearby: f64,
    ) -> bool {
        let (keep, gain) = D::factors(self.global_damping, self.time_step);
        let (gravity, time_step) = (self.gravity, self.time_step);
        let near_enough = nearby * nearby;
        let mut stayed = true;
        let linear = grains.place.iter_mut().zip(&mut grains.movement).zip(&mut grains.force);
        for (((place, movement), force), reference) in linear.zip(reference) {
            let mut acceleration = *force * movement.inverse_mass;
            if GRAVITY {
                acceleration += gravity;
            }
            *force = S::ORIGIN;
            movement.velocity = D::keep(movement.velocity, keep) + acceleration * gain;
            place.position += movement.velocity * time_step;
            let away = place.position - *reference;
            // A position that is not a number has not stayed: listing anew looks at every grain.
            stayed &= S::dot(away, away) <= near_enough;
        }
        // Nothing is left of this loop where grains do not rotate.
        for (rotation, torque) in grains.rotation.iter_mut().zip(&mut grains.torque) {
            rotation.advance(*torque, keep, gain, time_step);
            *torque = Default::default();
        }
        stayed
    }

    /// Takes the velocities at the start to half a step before it, so that the first cycle ends at half a step after
    /// it.
    pub(crate) fn step_back_half<R: Rotation<S>>(&self, grains: &mut Grains<S, R>) {
        let half = 0.5 * self.time_step;
        let drag = 1.0 + self.global_damping * half;
        for slot in 0..grains.len() {
            let movement = &mut grains.movement[slot];
            let acceleration = grains.force[slot] * movement.inverse_mass + self.gravity;
            movement.velocity = movement.velocity * drag - acceleration * half;
            let rotation = &mut grains.rotation[slot];
            if let Some(spin) = rotation.spin() {
                let acceleration = rotation.acceleration(grains.torque[slot]);
                rotation.set_spin(spin * drag - acceleration * half);
            }
        }
    }
}
