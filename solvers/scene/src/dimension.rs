//! Number of dimensions, and shape of the grains.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Number of dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Two dimensions (x, y).
    Two,
    /// Three dimensions (x, y, z).
    Three,
}

impl Dimension {
    /// Returns the number of dimensions, 2 or 3.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// Shape of the grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GrainShape {
    /// Cylinder one metre deep that moves in the plane.
    Disc,
    /// Sphere.
    Sphere,
}

impl GrainShape {
    /// Returns the mass of a grain of this shape, of a radius (m) and a density (kg/m³): kg/m for discs (per metre of
    /// depth), kg for spheres.
    #[must_use]
    pub fn mass(self, radius: f64, density: f64) -> f64 {
        match self {
            Self::Disc => density * PI * radius * radius,
            Self::Sphere => density * (4.0 / 3.0) * PI * radius.powi(3),
        }
    }

    /// Returns I/(mR²): 1/2 for a disc, 2/5 for a sphere.
    #[must_use]
    pub const fn inertia_factor(self) -> f64 {
        match self {
            Self::Disc => 0.5,
            Self::Sphere => 0.4,
        }
    }
}
