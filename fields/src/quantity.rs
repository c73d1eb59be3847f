//! Quantities of the material inside grains, for figures.

use grainbench_solver::record::PointState;
use nalgebra::{Matrix2, Vector3};
use serde::{Deserialize, Serialize};

/// Quantity that is defined at every position in the material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Quantity {
    /// Difference of the principal stresses in the plane, σ₁ − σ₂ (Pa).
    StressDifference,
    /// Photoelastic fringes cos((σ₁ − σ₂)/f) for a stress f (Pa), as in Bardenhagen and others (2001). They are bright
    /// at zero stress.
    Fringes(f64),
    /// Equivalent plastic strain.
    PlasticStrain,
    /// Rotation since the start (rad).
    Rotation,
    /// Speed (m/s).
    Speed,
}

impl Quantity {
    /// Returns the label of the quantity and its SI unit.
    #[must_use]
    pub const fn label(self) -> (&'static str, &'static str) {
        match self {
            Self::StressDifference => ("σ₁ − σ₂", "Pa"),
            Self::Fringes(_) => ("cos((σ₁ − σ₂)/f)", "1"),
            Self::PlasticStrain => ("plastic strain", "1"),
            Self::Rotation => ("rotation", "rad"),
            Self::Speed => ("speed", "m/s"),
        }
    }

    /// Returns the values of a material point from which the quantity is computed. Means are taken over these values.
    pub(crate) fn parts(self, point: &PointState) -> [f64; 3] {
        let [xx, yy, _, xy, ..] = point.stress;
        match self {
            Self::StressDifference | Self::Fringes(_) => [xx, yy, xy],
            Self::PlasticStrain => [point.plastic_strain, 0.0, 0.0],
            Self::Rotation => [point.rotation, 0.0, 0.0],
            Self::Speed => point.velocity.into(),
        }
    }

    /// Computes the quantity from the values of [`Self::parts`] or from their means.
    pub(crate) fn of_parts(self, parts: [f64; 3]) -> f64 {
        let [first, second, third] = parts;
        match self {
            Self::StressDifference | Self::Fringes(_) => self.of_stress(&Matrix2::new(first, third, third, second)),
            Self::PlasticStrain | Self::Rotation => first,
            Self::Speed => Vector3::from(parts).norm(),
        }
    }

    /// Computes the quantity from the stress in the plane (Pa); NaN for quantities that do not depend on stress.
    #[must_use]
    pub fn of_stress(self, stress: &Matrix2<f64>) -> f64 {
        let difference = (stress.m11 - stress.m22).hypot(2.0 * stress.m12);
        match self {
            Self::StressDifference => difference,
            Self::Fringes(constant) => (difference / constant).cos(),
            Self::PlasticStrain | Self::Rotation | Self::Speed => f64::NAN,
        }
    }
}
