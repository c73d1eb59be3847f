//! The grains in memory: arrays in the order of the cells they lie in, so that neighbours in space are neighbours
//! there.

use crate::rotation::Rotation;
use grainbench_scene::scene::{Grain, Scene};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Position (m) and radius (m) of a grain: what is read for every pair that is tested.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Place<S: Space> {
    pub(crate) position: S::Vector,
    pub(crate) radius: f64,
}

/// Velocity (m/s) and inverse mass (1/kg) of a grain: what is read for every pair that touches.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Movement<S: Space> {
    pub(crate) velocity: S::Vector,
    pub(crate) inverse_mass: f64,
}

/// All grains, by slot. The slot of a grain changes when the grains are sorted, its place in the scene never.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Grains<S: Space, R: Rotation<S>> {
    pub(crate) place: Vec<Place<S>>,
    pub(crate) movement: Vec<Movement<S>>,
    pub(crate) rotation: Vec<R>,
    /// Force F (N), the sum over contacts; the weight is not in it.
    pub(crate) force: Vec<S::Vector>,
    /// Torque M (N m), the sum over contacts.
    pub(crate) torque: Vec<R::Torque>,
    /// Number of the material.
    pub(crate) material: Vec<u16>,
    /// Place of the grain in the scene.
    pub(crate) id: Vec<u32>,
    /// Slot of every place in the scene.
    pub(crate) slot: Vec<u32>,
}

impl<S: Space, R: Rotation<S>> Grains<S, R> {
    /// Whether these can be the same grains, sorted otherwise.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let Self { place, movement, rotation, force, torque, material, id, slot } = self;
        let count = other.len();
        let lengths = [place.len(), movement.len(), rotation.len(), force.len(), torque.len(), id.len(), slot.len()];
        let mut placed = slot.iter().enumerate();
        lengths.iter().all(|&length| length == count)
            && material.len() == count
            && placed.all(|(place, &slot)| id.get(slot as usize).is_some_and(|&id| id as usize == place))
            && (0..count).all(|slot| material[slot] == other.material[other.slot[id[slot] as usize] as usize])
    }

    /// The grains as the scene has them at the start, without forces.
    pub(crate) fn new(scene: &Scene) -> Self {
        let all = &scene.grains;
        let place = |grain: &Grain| Place { position: S::restrict(grain.position), radius: grain.radius };
        let movement =
            |grain: &Grain| Movement { velocity: S::restrict(grain.velocity), inverse_mass: 1.0 / grain.mass };
        let ids = || (0..all.len()).map(|id| id as u32);
        let mut grains = Self {
            place: all.iter().map(place).collect(),
            movement: all.iter().map(movement).collect(),
            rotation: all.iter().map(|grain| R::new(S::restrict_spin(grain.spin), 1.0 / grain.inertia)).collect(),
            force: vec![S::ORIGIN; all.len()],
            torque: vec![R::Torque::default(); all.len()],
            material: all.iter().map(|grain| grain.material).collect(),
            id: ids().collect(),
            slot: ids().collect(),
        };
        // Nothing moves a driven grain: to what meets it, it is as heavy as a wall.
        for &driven in scene.driven.iter().flat_map(|driven| &driven.grains) {
            grains.movement[driven].inverse_mass = 0.0;
        }
        grains
    }

    /// Number of grains.
    pub(crate) fn len(&self) -> usize {
        self.place.len()
    }

    /// Force on a group of grains together (N); `group` holds their places in the scene.
    pub(crate) fn force_on(&self, group: &[usize]) -> Vector3<f64> {
        group.iter().map(|&id| S::embed(self.force[self.slot[id] as usize])).sum()
    }

    /// Sorts: slot `k` gets what was in slot `order[k]`.
    pub(crate) fn reorder(&mut self, order: &[u32]) {
        fn gather<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
            *values = order.iter().map(|&from| values[from as usize]).collect();
        }
        gather(&mut self.place, order);
        gather(&mut self.movement, order);
        gather(&mut self.rotation, order);
        gather(&mut self.force, order);
        gather(&mut self.torque, order);
        gather(&mut self.material, order);
        gather(&mut self.id, order);
        for (slot, &id) in self.id.iter().enumerate() {
            self.slot[id as usize] = slot as u32;
        }
    }
}
