//! How bodies touch: springs between surfaces, or conditions at nodes.

pub(crate) mod friction;
pub(crate) mod grip;
pub(crate) mod nodal;
pub(crate) mod pairs;
pub(crate) mod penalty;
pub(crate) mod search;
pub(crate) mod shared;

use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Other {
    Body(u32),
    Wall(u16),
}

/// One place where a body touches another or a wall, as the last step had it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<S: Space> {
    /// Which body.
    pub(crate) body: u32,
    pub(crate) other: Other,
    /// Where (m).
    pub(crate) point: S::Vector,
    /// Force on the body along the normal into it (N).
    pub(crate) push: S::Vector,
    /// Force on the body along the surface (N).
    pub(crate) shear: S::Vector,
    /// How deep the surfaces overlap (m).
    pub(crate) depth: f64,
    pub(crate) slipping: bool,
    /// Energy in its springs at the end of the step (J).
    pub(crate) energy: f64,
}

/// Friction between materials; pairs without a law do not feel each other.
#[derive(Clone, Debug)]
pub(crate) struct FrictionTable {
    coefficients: Vec<Option<f64>>,
    materials: usize,
}

impl FrictionTable {
    pub(crate) fn of(scene: &grainbench_scene::scene::Scene) -> Self {
        let coefficients = scene.laws.iter().map(|law| law.map(|law| law.friction)).collect();
        Self { coefficients, materials: scene.materials.len() }
    }

    /// Whether any law has friction.
    pub(crate) fn acts(&self) -> bool {
        self.coefficients.iter().flatten().any(|&friction| friction != 0.0)
    }

    #[inline(always)]
    pub(crate) fn between(&self, a: u16, b: u16) -> Option<f64> {
        self.coefficients[usize::from(a) * self.materials + usize::from(b)]
    }
}
