//! Integration of Newton's law for every grain by central differences, with gravity g and global damping if the scene has
//! them.
//!
//! ```text
//! v ← keep·v + gain·(F/m + g)        x ← x + v Δt        ω ← keep·ω + gain·M/I
//! ```
//!
//! Here x, v and ω are position, velocity and spin, F and M force and torque, m and I mass and moment of inertia. Without
//! global damping, keep = 1 and gain = Δt. Source: Cundall & Strack, Géotechnique 29 (1979) 47–65, eqs. 22 and 22a, and
//! eqs. 35 and 36 with global damping.

use crate::geometry::Geometry;
use crate::grains::Grains;
use grainbench_lanes::{Kernel, Lanes, Processor, Quad, take_off};
use nalgebra::Vector3;
use std::marker::PhantomData;
use std::ops::Range;

/// Gravity, global damping and time step, common to all grains.
#[derive(Clone, Copy)]
pub(crate) struct Motion {
    /// Gravity g (m/s²). Its out-of-plane component is zero in two dimensions.
    pub(crate) gravity: Vector3<f64>,
    /// Rate α of global damping (1/s).
    pub(crate) global_damping: f64,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
}

/// Grain data that the integration reads and writes.
pub(crate) struct MotionData<'a> {
    place: &'a mut [Quad],
    movement: &'a mut [Quad],
    load: &'a mut [Quad],
    /// Number of quads per grain in `movement` (velocity, spin) and in `load` (force, torque).
    quads: usize,
    inverse_inertia: &'a [f64],
}

impl<'a> MotionData<'a> {
    /// Returns the data of the grains in these slots.
    pub(crate) fn new<S: Geometry>(grains: &'a mut Grains<S>, slots: Range<usize>) -> Self {
        let quads = grains.quads();
        let Grains { place, movement, load, inverse_inertia, .. } = grains;
        let all = slots.start * quads..slots.end * quads;
        Self {
            place: &mut place[slots.clone()],
            movement: &mut movement[all.clone()],
            load: &mut load[all],
            quads,
            inverse_inertia: inverse_inertia.get(slots).unwrap_or_default(),
        }
    }

    /// Splits off the data of the first `count` grains.
    pub(crate) fn take_off(&mut self, count: usize) -> Self {
        let (inertia, others) = self.inverse_inertia.split_at(count.min(self.inverse_inertia.len()));
        self.inverse_inertia = others;
        Self {
            place: take_off(&mut self.place, count),
            movement: take_off(&mut self.movement, count * self.quads),
            load: take_off(&mut self.load, count * self.quads),
            quads: self.quads,
            inverse_inertia: inertia,
        }
    }
}

impl Motion {
    /// Moves grains over one step by the forces and torques on them, then sets forces and torques to zero. Returns the
    /// square of the largest speed (m²/s²); infinite if any speed is NaN.
    pub(crate) fn advance<S: Geometry>(&self, processor: Processor, grains: MotionData<'_>) -> f64 {
        let (motion, space) = (self, PhantomData);
        match (self.global_damping == 0.0, self.gravity == Vector3::zeros()) {
            (true, true) => processor.run(Drift::<S, false, false> { motion, grains, space }),
            (true, false) => processor.run(Drift::<S, false, true> { motion, grains, space }),
            (false, true) => processor.run(Drift::<S, true, false> { motion, grains, space }),
            (false, false) => processor.run(Drift::<S, true, true> { motion, grains, space }),
        }
    }

    /// Returns the velocity half a step earlier (m/s) of a grain without contacts that has the velocity `velocity` (m/s)
    /// now.
    pub(crate) fn half_before(&self, velocity: Vector3<f64>) -> Vector3<f64> {
        let half = 0.5 * self.time_step;
        velocity * (1.0 + self.global_damping * half) - self.gravity * half
    }

    /// Shifts the velocities and spins of grains back by half a step, when the grains start to move freely. The first
    /// cycle then gives the velocities half a step after the start.
    pub(crate) fn step_back_half<S: Geometry>(&self, grains: &mut Grains<S>, slots: impl Iterator<Item = usize>) {
        let half = 0.5 * self.time_step;
        let drag = 1.0 + self.global_damping * half;
        for slot in slots {
            let acceleration = grains.force(slot) * grains.inverse_mass(slot) + self.gravity;
            let velocity = grains.velocity(slot) * drag - acceleration * half;
            let at = grains.first_quad(slot);
            S::put(velocity, &mut grains.movement[at]);
            if let Some(spin) = grains.spin(slot) {
                let acceleration = grains.torque(slot) * grains.inverse_inertia[slot];
                grains.set_spin(slot, spin * drag - acceleration * half);
            }
        }
    }
}

/// Loop over grains, compiled with and without global damping, with and without gravity, and for each instruction set.
struct Drift<'a, S, const DAMPED: bool, const GRAVITY: bool> {
    motion: &'a Motion,
    grains: MotionData<'a>,
    space: PhantomData<S>,
}

/// Factors of a step. Each has one value for each number of a quad, so that a quad is updated as one register. The
/// fourth number of a quad is an inverse mass or a radius; its factors leave it unchanged.
struct Step {
    /// Fraction of a velocity that remains after the step.
    keep: [f64; 4],
    /// Factor by which the acceleration is multiplied (s).
    gain: [f64; 4],
    time_step: [f64; 4],
    gravity: [f64; 4],
}

impl Step {
    /// Returns the factors of a step Δt. The damping force −α m v (α: damping rate, m: mass) is evaluated at mid-step: v ←
    /// [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2) with the acceleration a (Cundall & Strack 1979, eq. 35).
    fn new(&Motion { gravity, global_damping, time_step }: &Motion) -> Self {
        let half = 0.5 * global_damping * time_step;
        let three = |value: f64, last: f64| [value, value, value, last];
        Self {
            keep: three((1.0 - half) / (1.0 + half), 1.0),
            gain: three(time_step / (1.0 + half), 0.0),
            time_step: three(time_step, 0.0),
            gravity: [gravity.x, gravity.y, gravity.z, 0.0],
        }
    }

    /// Updates a velocity or spin by the force or torque, sets the force or torque to zero, and returns the new velocity
    /// or spin. `inverse` holds the inverse mass or inverse moment of inertia for each number of the quad.
    #[inline(always)]
    fn push<const DAMPED: bool, const GRAVITY: bool>(
        &self,
        velocity: &mut Quad,
        load: &mut Quad,
        inverse: [f64; 4],
    ) -> Quad {
        let (before, forces) = (velocity.0, load.0);
        let mut after = before;
        for axis in 0..4 {
            let mut acceleration = forces[axis] * inverse[axis];
            if GRAVITY {
                acceleration += self.gravity[axis];
            }
            let kept = if DAMPED { before[axis] * self.keep[axis] } else { before[axis] };
            after[axis] = kept + acceleration * self.gain[axis];
        }
        *velocity = Quad(after);
        *load = Quad::default();
        Quad(after)
    }

    /// Advances a position by its velocity. In two dimensions, the angle is advanced by the spin in the same way.
    /// Returns the square of the speed (m²/s²).
    #[inline(always)]
    fn carry<S: Geometry>(&self, Quad(place): &mut Quad, Quad(velocity): Quad) -> f64 {
        for axis in 0..4 {
            place[axis] += velocity[axis] * self.time_step[axis];
        }
        let squares = velocity.map(|component| component * component);
        let plane = squares[0] + squares[1];
        if S::DIMENSION == 2 { plane } else { plane + squares[2] }
    }
}

impl<S: Geometry, const DAMPED: bool, const GRAVITY: bool> Kernel for Drift<'_, S, DAMPED, GRAVITY> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> f64 {
        let step = Step::new(self.motion);
        let MotionData { place, movement, load, quads, inverse_inertia } = self.grains;
        // Read as integers, the bits of non-negative numbers have the same order as the numbers, with NaN last.
        let mut fastest = 0;
        if quads == 2 {
            let movement = movement.as_chunks_mut::<2>().0;
            let load = load.as_chunks_mut::<2>().0;
            for (((place, [velocity, spin]), [load, torque]), inertia) in
                place.iter_mut().zip(movement).zip(load).zip(inverse_inertia)
            {
                let inverse = velocity.0[3];
                let velocity = step.push::<DAMPED, GRAVITY>(velocity, load, [inverse; 4]);
                step.push::<DAMPED, false>(spin, torque, [*inertia; 4]);
                fastest = fastest.max(step.carry::<S>(place, velocity).to_bits());
            }
        } else if S::DIMENSION == 2 && !inverse_inertia.is_empty() {
            for (((place, velocity), load), inertia) in place.iter_mut().zip(movement).zip(load).zip(inverse_inertia) {
                let inverse = velocity.0[3];
                let velocity = step.push::<DAMPED, GRAVITY>(velocity, load, [inverse, inverse, *inertia, inverse]);
                fastest = fastest.max(step.carry::<S>(place, velocity).to_bits());
            }
        } else {
            for ((place, velocity), load) in place.iter_mut().zip(movement).zip(load) {
                let inverse = velocity.0[3];
                let about_z = if S::DIMENSION == 2 { 0.0 } else { inverse };
                let velocity = step.push::<DAMPED, GRAVITY>(velocity, load, [inverse, inverse, about_z, inverse]);
                fastest = fastest.max(step.carry::<S>(place, velocity).to_bits());
            }
        }
        let fastest = f64::from_bits(fastest);
        if fastest.is_finite() { fastest } else { f64::INFINITY }
    }
}
