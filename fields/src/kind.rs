//! What grains are to whoever takes means over them.

use grainbench_scene::scene::{Dimension, Scene};

/// What grains are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Discs in the plane, a metre deep. A sphere that is kept in a plane is one to whoever looks at the plane.
    Discs,
    /// Spheres in space.
    Spheres,
}

impl Kind {
    /// Of a scene.
    #[must_use]
    pub const fn of(scene: &Scene) -> Self {
        match scene.dimension {
            Dimension::Two => Self::Discs,
            Dimension::Three => Self::Spheres,
        }
    }

    /// Number of axes.
    #[must_use]
    pub const fn dimension(self) -> usize {
        match self {
            Self::Discs => 2,
            Self::Spheres => 3,
        }
    }
}
