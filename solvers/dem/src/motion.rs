//! Newton's law for every grain, in central differences, with gravity and global damping where the scene has them.
//!
//! ```text
//! v ← keep·v + gain·(F/m + g)        x ← x + v Δt        ω ← keep·ω + gain·M/I
//! ```
//!
//! Source: Cundall & Strack, Géotechnique 29 (1979) 47–65, eqs. 22 and 22a, and eqs. 35 and 36 with global damping.

use crate::geometry::Geometry;
use crate::grains::Grains;
use grainbench_lanes::{Quad, take_off};
use nalgebra::Vector3;
use std::ops::Range;

/// Global damping of the equation of motion, or its absence.
trait Drag {
    /// `keep`, the part of a velocity that is left after a step, and `gain` (s), what an acceleration is multiplied by;
    /// from the rate α (1/s) and the time step Δt (s).
    fn factors(rate: f64, time_step: f64) -> (f64, f64);
    /// `keep · velocity`, without arithmetic where nothing is lost.
    fn keep(velocity: f64, keep: f64) -> f64;
}

/// No global damping: `keep` is 1 and `gain` is Δt.
struct NoDrag;

impl Drag for NoDrag {
    fn factors(_rate: f64, time_step: f64) -> (f64, f64) {
        (1.0, time_step)
    }
    #[inline(always)]
    fn keep(velocity: f64, _keep: f64) -> f64 {
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
    fn keep(velocity: f64, keep: f64) -> f64 {
        velocity * keep
    }
}

/// What acts on every grain beside its contacts, and for how long.
#[derive(Clone, Copy)]
pub(crate) struct Motion {
    /// Gravity g (m/s²), nothing out of the plane in two dimensions.
    pub(crate) gravity: Vector3<f64>,
    /// Rate α of global damping (1/s).
    pub(crate) global_damping: f64,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
}

/// What motion reads and writes of grains.
pub(crate) struct Moving<'a> {
    place: &'a mut [Quad],
    movement: &'a mut [Quad],
    turning: &'a mut [Quad],
    load: &'a mut [Quad],
    torque: &'a mut [Quad],
    inverse_inertia: &'a [f64],
}

impl<'a> Moving<'a> {
    /// Of the grains in these slots.
    pub(crate) fn of<S: Geometry>(grains: &'a mut Grains<S>, slots: Range<usize>) -> Self {
        let Grains { place, movement, turning, load, torque, inverse_inertia, .. } = grains;
        Self {
            place: &mut place[slots.clone()],
            movement: &mut movement[slots.clone()],
            turning: turning.get_mut(slots.clone()).unwrap_or_default(),
            load: &mut load[slots.clone()],
            torque: torque.get_mut(slots.clone()).unwrap_or_default(),
            inverse_inertia: inverse_inertia.get(slots).unwrap_or_default(),
        }
    }

    /// Takes off the first grains, so many.
    pub(crate) fn take_off(&mut self, count: usize) -> Self {
        let (inertia, others) = self.inverse_inertia.split_at(count.min(self.inverse_inertia.len()));
        self.inverse_inertia = others;
        Self {
            place: take_off(&mut self.place, count),
            movement: take_off(&mut self.movement, count),
            turning: take_off(&mut self.turning, count),
            load: take_off(&mut self.load, count),
            torque: take_off(&mut self.torque, count),
            inverse_inertia: inertia,
        }
    }
}

impl Motion {
    /// Moves grains over one step, by the forces on them, and sets those to zero. Gives the speed of the fastest, squared
    /// (m²/s²), infinite where one is not a number.
    pub(crate) fn advance<S: Geometry>(&self, grains: Moving<'_>) -> f64 {
        match (self.global_damping == 0.0, self.gravity == Vector3::zeros()) {
            (true, true) => self.drift::<S, NoDrag, false>(grains),
            (true, false) => self.drift::<S, NoDrag, true>(grains),
            (false, true) => self.drift::<S, MassProportional, false>(grains),
            (false, false) => self.drift::<S, MassProportional, true>(grains),
        }
    }

    /// The same, compiled for one kind of damping, with gravity or without. In the plane the angle moves with the
    /// spin as a position does with its velocity.
    fn drift<S: Geometry, D: Drag, const GRAVITY: bool>(&self, grains: Moving<'_>) -> f64 {
        let (keep, gain) = D::factors(self.global_damping, self.time_step);
        let Moving { place, movement, turning, load, torque, inverse_inertia } = grains;
        let linear = place.iter_mut().zip(movement).zip(load).map(|((place, movement), load)| [place, movement, load]);
        let fastest = if S::DIMENSION == 2 && !inverse_inertia.is_empty() {
            self.drift_along::<S, D, GRAVITY>(linear, inverse_inertia.iter().copied())
        } else {
            self.drift_along::<S, D, GRAVITY>(linear, std::iter::repeat(0.0))
        };
        // Nothing is left of this loop in the plane, and where grains do not rotate.
        for ((Quad(spin), torque), inverse_inertia) in turning.iter_mut().zip(torque).zip(inverse_inertia) {
            for (spin, torque) in spin.iter_mut().take(3).zip(torque.0) {
                *spin = D::keep(*spin, keep) + torque * inverse_inertia * gain;
            }
            *torque = Quad::default();
        }
        fastest
    }

    /// Velocities and positions of it, in the plane spins and angles too, with the inverse moments of inertia (1/(kg m²)).
    #[inline(always)]
    fn drift_along<'a, S: Geometry, D: Drag, const GRAVITY: bool>(
        &self,
        grains: impl Iterator<Item = [&'a mut Quad; 3]>,
        inverse_inertia: impl Iterator<Item = f64>,
    ) -> f64 {
        let (keep, gain) = D::factors(self.global_damping, self.time_step);
        let (gravity, time_step) = ([self.gravity.x, self.gravity.y, self.gravity.z], self.time_step);
        let (mut fastest, mut total) = (0.0, 0.0);
        for ([Quad(place), Quad(movement), load], inverse_inertia) in grains.zip(inverse_inertia) {
            let mut inverse = [movement[3]; 3];
            if S::DIMENSION == 2 {
                inverse[2] = inverse_inertia;
            }
            let mut squared = 0.0;
            for axis in 0..3 {
                let mut acceleration = load.0[axis] * inverse[axis];
                if GRAVITY {
                    acceleration += gravity[axis];
                }
                movement[axis] = D::keep(movement[axis], keep) + acceleration * gain;
                place[axis] += movement[axis] * time_step;
                if axis < S::DIMENSION {
                    squared += movement[axis] * movement[axis];
                }
            }
            *load = Quad::default();
            fastest = if squared > fastest { squared } else { fastest };
            total += squared;
        }
        // What is not a number is no larger than another, but it stays in a sum.
        if f64::is_finite(total) { fastest } else { f64::INFINITY }
    }

    /// The velocity half a step before (m/s) of a grain that has one (m/s) and that nothing touches.
    pub(crate) fn half_before(&self, velocity: Vector3<f64>) -> Vector3<f64> {
        let half = 0.5 * self.time_step;
        velocity * (1.0 + self.global_damping * half) - self.gravity * half
    }

    /// Takes the velocities of grains that begin to move by forces to half a step before, so that the first cycle ends at half a
    /// step after it.
    pub(crate) fn step_back_half<S: Geometry>(&self, grains: &mut Grains<S>, slots: impl Iterator<Item = usize>) {
        let half = 0.5 * self.time_step;
        let drag = 1.0 + self.global_damping * half;
        for slot in slots {
            let acceleration = grains.force(slot) * grains.inverse_mass(slot) + self.gravity;
            let velocity = grains.velocity(slot) * drag - acceleration * half;
            S::put(velocity, &mut grains.movement[slot]);
            if let Some(spin) = grains.spin(slot) {
                let acceleration = grains.torque(slot) * grains.inverse_inertia[slot];
                grains.set_spin(slot, spin * drag - acceleration * half);
            }
        }
    }
}
