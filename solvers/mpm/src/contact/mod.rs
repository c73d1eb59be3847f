//! Contact between bodies and with walls, by springs between surfaces or by conditions at nodes.

pub(crate) mod friction;
pub(crate) mod nodal;
pub(crate) mod pairs;
pub(crate) mod penalty;
pub(crate) mod search;
pub(crate) mod shared;
pub(crate) mod stages;

use crate::grid::lattice::Lattice;
use crate::options::Setting;
use grainbench_solver::space::Space;
use serde::{Deserialize, Serialize};

/// Contact partner of a body: a second body or a wall, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum ContactPartner {
    Body(u32),
    Wall(u16),
}

/// Contact point between a body and its contact partner in the last step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactPoint<S: Space> {
    pub(crate) body: u32,
    pub(crate) other: ContactPartner,
    /// Contact point (m).
    pub(crate) point: S::Vector,
    /// Normal force on the body (N), directed into it.
    pub(crate) push: S::Vector,
    /// Tangential force on the body (N).
    pub(crate) shear: S::Vector,
    /// Overlap of the surfaces (m).
    pub(crate) depth: f64,
    pub(crate) slipping: bool,
    /// Energy in the springs at the end of the step (J).
    pub(crate) energy: f64,
}

/// Parameters of contact.
#[derive(Clone, Copy)]
pub(crate) struct Rules<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) friction: &'a FrictionTable,
    pub(crate) setting: &'a Setting,
    pub(crate) time_step: f64,
}

/// Friction coefficients between materials. Materials without a contact law do not interact.
#[derive(Clone, Debug)]
pub(crate) struct FrictionTable {
    coefficients: Vec<Option<f64>>,
    materials: usize,
}

impl FrictionTable {
    pub(crate) fn from_scene(scene: &grainbench_scene::scene::Scene) -> Self {
        let coefficients = scene.laws.iter().map(|law| law.map(|law| law.friction)).collect();
        Self { coefficients, materials: scene.materials.len() }
    }

    /// Returns true if any law has friction.
    pub(crate) fn acts(&self) -> bool {
        self.coefficients.iter().flatten().any(|&friction| friction != 0.0)
    }

    #[inline(always)]
    pub(crate) fn between(&self, a: u16, b: u16) -> Option<f64> {
        self.coefficients[usize::from(a) * self.materials + usize::from(b)]
    }
}
