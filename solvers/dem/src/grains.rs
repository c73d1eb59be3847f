//! Grain data in memory, as quads (four numbers each). Grains are sorted by cell, so that grains that are close in space
//! are close in memory. The data of a grain are then read by a few aligned loads.
//!
//! Without tangential forces at contacts there are no torques. In this case, grains do not rotate, and data needed only
//! for rotation are neither stored nor computed.

use crate::geometry::Geometry;
use grainbench_lanes::{Quad, take_off};
use grainbench_scene::scene::{Driven, Grain, Scene};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;

/// Slot value of a grain that is not inserted yet or is removed.
pub(crate) const ABSENT: u32 = u32::MAX;

/// All grains that are present, by slot. The slot of a grain changes when the grains are sorted; its index in the scene
/// does not.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Grains<S: Geometry> {
    /// Position (m) and radius (m) of each grain. In two dimensions, the angle θ (rad) replaces z.
    pub(crate) place: Vec<Quad>,
    /// Velocity (m/s) and inverse mass (1/kg) of each grain. In two dimensions, the spin ω (rad/s) replaces v_z. In
    /// three dimensions, if grains rotate, each velocity is followed by the angular velocity ω (rad/s) and a copy of
    /// the radius (m).
    pub(crate) movement: Vec<Quad>,
    /// Sum of contact forces F on each grain (N), without the weight. In two dimensions, the torque M (N m) replaces
    /// F_z. In three dimensions, if grains rotate, each force is followed by the torque M (N m).
    pub(crate) load: Vec<Quad>,
    /// Inverse moment of inertia 1/I (1/(kg m²)); empty if grains do not rotate.
    pub(crate) inverse_inertia: Vec<f64>,
    /// Index of the material.
    pub(crate) material: Vec<u16>,
    /// Index of the grain in the scene.
    pub(crate) id: Vec<u32>,
    /// Slot of every grain of the scene; [`ABSENT`] for an absent grain.
    pub(crate) slot: Vec<u32>,
    space: PhantomData<S>,
}

impl<S: Geometry> Grains<S> {
    /// Returns true if these grains can be the present grains of a scene, in any order.
    pub(crate) fn is_of(&self, scene: &Scene, rotate: bool) -> bool {
        let Self { place, movement, load, inverse_inertia, material, id, slot, space: _ } = self;
        let count = place.len();
        let quads = count * quads::<S>(rotate);
        let lengths = [material.len(), id.len()];
        let turning = if rotate { count } else { 0 };
        let spins = movement.iter().skip(1).step_by(2).filter(|_| quads > count);
        let placed = slot.iter().filter(|&&slot| slot != ABSENT).count();
        lengths.iter().all(|&length| length == count)
            && [movement.len(), load.len(), inverse_inertia.len()] == [quads, quads, turning]
            && spins.zip(place).all(|(spin, place)| spin.0[3].to_bits() == place.0[3].to_bits())
            && slot.len() == scene.grains.len()
            && placed == count
            && (placed == slot.len() || !scene.stays.is_always())
            && id.iter().enumerate().all(|(at, &id)| slot.get(id as usize).is_some_and(|&slot| slot as usize == at))
            && material.iter().zip(id).all(|(&material, &id)| material == scene.grains[id as usize].material)
            && self.has_bodies_of(scene, quads / count.max(1))
    }

    /// Returns true if radii, masses and moments of inertia are those of the scene. A grain with prescribed motion may
    /// have an inverse mass of 0.
    fn has_bodies_of(&self, scene: &Scene, quads: usize) -> bool {
        let is_one = |found: f64, expected: f64| found.to_bits() == expected.to_bits();
        self.id.iter().enumerate().all(|(slot, &id)| {
            let grain = &scene.grains[id as usize];
            let inverse_mass = self.movement[slot * quads].0[3];
            let inverse_inertia = self.inverse_inertia.get(slot).copied();
            is_one(self.place[slot].0[3], grain.radius)
                && (is_one(inverse_mass, 1.0 / grain.mass) || inverse_mass == 0.0)
                && inverse_inertia.is_none_or(|found| is_one(found, 1.0 / grain.inertia))
        })
    }

    /// Returns the grains that a scene has at the start, in their initial state and without forces.
    pub(crate) fn new(scene: &Scene, rotate: bool) -> Self {
        let count = scene.grains.len();
        let mut later = vec![false; count];
        let entered = scene.stays.entered_by(0.0);
        scene.stays.entries[entered..].iter().for_each(|entry| later[entry.grain] = true);
        let mut grains = Self {
            place: Vec::with_capacity(count),
            movement: Vec::with_capacity(count * quads::<S>(rotate)),
            load: Vec::with_capacity(count * quads::<S>(rotate)),
            inverse_inertia: Vec::new(),
            material: Vec::with_capacity(count),
            id: Vec::with_capacity(count),
            slot: vec![ABSENT; count],
            space: PhantomData,
        };
        for (id, grain) in scene.grains.iter().enumerate().filter(|&(id, _)| !later[id]) {
            grains.enter(id as u32, grain, rotate);
        }
        scene
            .driven
            .iter()
            .filter(|driven| driven.is_moved_at(0.0))
            .for_each(|driven| grains.weigh(scene, driven, true));
        grains
    }

    /// Sets the inverse mass of a group of grains. If `is_moved` is true, the motion of the group is prescribed and its
    /// inverse mass is zero, as for a wall. Otherwise it is 1/m with the mass m from the scene.
    pub(crate) fn weigh(&mut self, scene: &Scene, driven: &Driven, is_moved: bool) {
        for &grain in &driven.grains {
            let slot = self.slot[grain] as usize;
            let inverse_mass = if is_moved { 0.0 } else { 1.0 / scene.grains[grain].mass };
            let at = self.first_quad(slot);
            self.movement[at].0[3] = inverse_mass;
        }
    }

    /// Appends a grain in its initial state, with its index `id` in the scene.
    pub(crate) fn enter(&mut self, id: u32, grain: &Grain, rotate: bool) {
        let quad = |vector: Vector3<f64>, last: f64| {
            let mut quad = Quad([0.0, 0.0, 0.0, last]);
            S::put(vector, &mut quad);
            quad
        };
        let slot = self.place.len();
        self.place.push(quad(grain.position, grain.radius));
        self.movement.push(quad(grain.velocity, 1.0 / grain.mass));
        self.load.push(Quad::default());
        self.material.push(grain.material);
        self.id.push(id);
        self.slot[id as usize] = slot as u32;
        if rotate {
            self.inverse_inertia.push(1.0 / grain.inertia);
            if S::DIMENSION == 3 {
                // The fourth number of a spin is free, so it stores the radius, which is read together with the spin.
                self.movement.push(Quad([0.0, 0.0, 0.0, grain.radius]));
                self.load.push(Quad::default());
            }
        }
        self.set_spin(slot, grain.spin);
    }

    /// Returns the number of grains.
    pub(crate) fn len(&self) -> usize {
        self.place.len()
    }

    /// Returns the number of quads per grain in `movement` (velocity, spin) and in `load` (force, torque).
    pub(crate) fn quads(&self) -> usize {
        quads::<S>(self.rotate())
    }

    /// Returns the index in `movement` and `load` of the first quad of the grain in a slot.
    pub(crate) fn first_quad(&self, slot: usize) -> usize {
        slot * self.quads()
    }

    /// Returns true if the grains rotate. Without grains, it returns false, which has no effect.
    pub(crate) fn rotate(&self) -> bool {
        !self.inverse_inertia.is_empty()
    }

    /// Returns the position of the centre (m).
    pub(crate) fn position(&self, slot: usize) -> Vector3<f64> {
        S::vector_in_space(&self.place[slot])
    }

    /// Returns the radius R (m).
    pub(crate) fn radius(&self, slot: usize) -> f64 {
        self.place[slot].0[3]
    }

    /// Returns the velocity (m/s).
    pub(crate) fn velocity(&self, slot: usize) -> Vector3<f64> {
        S::vector_in_space(&self.movement[self.first_quad(slot)])
    }

    /// Returns the inverse mass (1/kg); zero while the motion of the grain is prescribed.
    pub(crate) fn inverse_mass(&self, slot: usize) -> f64 {
        self.movement[self.first_quad(slot)].0[3]
    }

    /// Returns the angular velocity ω (rad/s); `None` if grains do not rotate.
    pub(crate) fn spin(&self, slot: usize) -> Option<Vector3<f64>> {
        self.rotate().then(|| turned::<S>(&self.movement[self.first_quad(slot)..]))
    }

    /// Returns the sum of the contact forces (N).
    pub(crate) fn force(&self, slot: usize) -> Vector3<f64> {
        S::vector_in_space(&self.load[self.first_quad(slot)])
    }

    /// Returns the sum of the contact torques (N m).
    pub(crate) fn torque(&self, slot: usize) -> Vector3<f64> {
        if self.rotate() { turned::<S>(&self.load[self.first_quad(slot)..]) } else { Vector3::zeros() }
    }

    /// Sets the angular velocity ω (rad/s), if grains rotate.
    pub(crate) fn set_spin(&mut self, slot: usize, spin: Vector3<f64>) {
        let at = self.first_quad(slot);
        match (self.rotate(), S::DIMENSION) {
            (false, _) => {}
            (true, 2) => self.movement[at].0[2] = spin.z,
            (true, _) => S::put(spin, &mut self.movement[at + 1]),
        }
    }

    /// Sets the force and the torque to zero.
    pub(crate) fn unload(&mut self, slot: usize) {
        let at = self.first_quad(slot);
        let end = at + self.quads();
        self.load[at..end].fill(Quad::default());
    }

    /// Sorts the grains: slot `k` gets the grain of slot `order[k]`. Grains that are not in `order` are dropped.
    pub(crate) fn reorder(&mut self, order: &[u32]) {
        fn gather<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
            if !values.is_empty() {
                *values = order.iter().map(|&from| values[from as usize]).collect();
            }
        }
        let quads = self.quads();
        for values in [&mut self.movement, &mut self.load] {
            *values = order.iter().flat_map(|&from| &values[from as usize * quads..][..quads]).copied().collect();
        }
        gather(&mut self.place, order);
        gather(&mut self.inverse_inertia, order);
        gather(&mut self.material, order);
        gather(&mut self.id, order);
        for (slot, &id) in self.id.iter().enumerate() {
            self.slot[id as usize] = slot as u32;
        }
    }
}

/// Grain data that the loops over pairs read, by slot. `movement` has one or two quads per grain, and `inverse_inertia`
/// is empty if grains do not rotate.
#[derive(Clone, Copy)]
pub(crate) struct GrainTables<'a> {
    pub(crate) place: &'a [Quad],
    pub(crate) movement: &'a [Quad],
    pub(crate) inverse_inertia: &'a [f64],
    pub(crate) material: &'a [u16],
    pub(crate) id: &'a [u32],
}

/// Sums of force and torque for grains in consecutive slots.
pub(crate) struct Sums<'a> {
    /// First slot.
    pub(crate) first: usize,
    /// Number of slots.
    pub(crate) count: usize,
    pub(crate) load: &'a mut [Quad],
}

impl<'a> Sums<'a> {
    /// Returns the same sums, mutably borrowed for a shorter time.
    pub(crate) fn lent(&mut self) -> Sums<'_> {
        Sums { first: self.first, count: self.count, load: self.load }
    }

    /// Returns true if a slot is among the summed slots.
    #[inline(always)]
    pub(crate) fn holds(&self, slot: usize) -> bool {
        slot.wrapping_sub(self.first) < self.count
    }

    /// Returns the sums of all `grains` grains; `None` if the summed slots do not cover all of them.
    #[inline(always)]
    pub(crate) fn all(&mut self, grains: usize) -> Option<AllGrainSums<'_>> {
        (self.first == 0 && self.count >= grains).then_some(AllGrainSums { grains, load: self.load })
    }

    /// Splits off the sums of the first `count` grains.
    pub(crate) fn take_off(&mut self, count: usize) -> Self {
        let (first, quads) = (self.first, self.load.len() / self.count.max(1));
        self.first += count;
        self.count -= count;
        Self { first, count, load: take_off(&mut self.load, count * quads) }
    }
}

/// Sums to which forces and torques are added.
pub(crate) trait Loads {
    /// Returns the sums of force and torque of a grain; `None` if its slot is not among the summed slots.
    fn load<const Q: usize>(&mut self, slot: usize) -> Option<&mut [Quad; Q]>;
}

impl Loads for Sums<'_> {
    #[inline(always)]
    fn load<const Q: usize>(&mut self, slot: usize) -> Option<&mut [Quad; Q]> {
        self.load.as_chunks_mut::<Q>().0.get_mut(slot.wrapping_sub(self.first))
    }
}

/// Sums of force and torque for all grains.
pub(crate) struct AllGrainSums<'a> {
    grains: usize,
    load: &'a mut [Quad],
}

impl Loads for AllGrainSums<'_> {
    #[inline(always)]
    fn load<const Q: usize>(&mut self, slot: usize) -> Option<&mut [Quad; Q]> {
        Some(&mut self.load.as_chunks_mut::<Q>().0[..self.grains][slot])
    }
}

impl<S: Geometry> Grains<S> {
    /// Returns the tables that a force evaluation reads, and the sums to which it adds forces and torques.
    pub(crate) fn parts(&mut self) -> (GrainTables<'_>, Sums<'_>) {
        let Self { place, movement, load, inverse_inertia, material, id, .. } = self;
        let count = place.len();
        (GrainTables { place, movement, inverse_inertia, material, id }, Sums { first: 0, count, load })
    }
}

/// Returns the number of quads per grain in `movement` (velocity, spin) and in `load` (force, torque).
fn quads<S: Geometry>(rotate: bool) -> usize {
    if rotate && S::DIMENSION == 3 { 2 } else { 1 }
}

/// Returns a spin or torque from the quads of a grain. In two dimensions, it is the third number of the first quad. In
/// three dimensions, it is the second quad.
fn turned<S: Geometry>(quads: &[Quad]) -> Vector3<f64> {
    if S::DIMENSION == 2 { Vector3::new(0.0, 0.0, quads[0].0[2]) } else { S::vector_in_space(&quads[1]) }
}

#[cfg(test)]
impl<S: Geometry> Grains<S> {
    /// Returns equal grains that do not rotate, at rest at these points.
    pub(crate) fn at(points: &[Vector3<f64>], radius: f64) -> Self {
        let count = points.len();
        let place = |point: &Vector3<f64>| {
            let mut place = Quad([0.0, 0.0, 0.0, radius]);
            S::put(*point, &mut place);
            place
        };
        Self {
            place: points.iter().map(place).collect(),
            movement: vec![Quad([0.0, 0.0, 0.0, 1.0]); count],
            load: vec![Quad::default(); count],
            inverse_inertia: Vec::new(),
            material: vec![0; count],
            id: (0..count as u32).collect(),
            slot: (0..count as u32).collect(),
            space: PhantomData,
        }
    }
}
