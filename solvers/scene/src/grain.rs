//! Grains of a scene or of a final state.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// State of a grain at the start of a run or, in [`crate::end_state::EndState`], at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grain {
    /// Index in [`crate::scene::Scene::materials`].
    pub material: u16,
    /// Radius R (m).
    pub radius: f64,
    /// Mass m (kg; kg per metre of depth for discs).
    pub mass: f64,
    /// Moment of inertia I (kg m²).
    pub inertia: f64,
    /// Centre (m).
    pub position: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub spin: Vector3<f64>,
}

/// List of the grains of a scene. Copies share the same list. A copy that changes gets its own list.
#[derive(Clone, Default, PartialEq)]
pub struct Grains(Arc<Vec<Grain>>);

impl Grains {
    /// Returns all data of the grains as bytes, one grain after the other.
    #[must_use]
    pub fn bits(&self) -> Vec<u8> {
        let mut bits = Vec::with_capacity(self.len() * size_of::<Grain>());
        for Grain { material, radius, mass, inertia, position, velocity, spin } in self {
            bits.extend(material.to_le_bytes());
            let vectors = [position, velocity, spin].into_iter().flat_map(|vector| vector.iter());
            for number in [radius, mass, inertia].into_iter().chain(vectors) {
                bits.extend(number.to_le_bytes());
            }
        }
        bits
    }
}

impl From<Vec<Grain>> for Grains {
    fn from(grains: Vec<Grain>) -> Self {
        Self(Arc::new(grains))
    }
}

impl Deref for Grains {
    type Target = Vec<Grain>;

    fn deref(&self) -> &Vec<Grain> {
        &self.0
    }
}

impl DerefMut for Grains {
    fn deref_mut(&mut self) -> &mut Vec<Grain> {
        Arc::make_mut(&mut self.0)
    }
}

impl<'g> IntoIterator for &'g Grains {
    type Item = &'g Grain;
    type IntoIter = std::slice::Iter<'g, Grain>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

/// Prints the grains as a list.
impl fmt::Debug for Grains {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}
