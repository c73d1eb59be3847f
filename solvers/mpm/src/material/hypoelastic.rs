//! Hypoelasticity.

use super::{Law, State};
use crate::off::Off;
use grainbench_scene::space::Space;
use nalgebra::Matrix3;

/// σ̂ = 2G dev D + K tr D 1 with the Jaumann rate σ̂ = σ̇ − Wσ + σW, D and W the symmetric and skew parts of ∇v (1/s).
///
/// The stress is turned by the exact rotation of the midpoint rule (Hughes & Winget 1980), so that rigid rotation
/// leaves its invariants alone whatever the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hypoelastic {
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Law for Hypoelastic {
    type PlasticStrain = Off;

    #[inline(always)]
    fn follow<S: Space>(
        &self,
        increment: S::Matrix,
        _volume_ratio: f64,
        _deformation: S::Matrix,
        stress: S::Symmetric,
        _plastic_strain: &mut Off,
    ) -> S::Symmetric {
        let strain = S::symmetric_part(increment);
        let pressure = (self.bulk_modulus - 2.0 / 3.0 * self.shear_modulus) * S::trace(strain);
        let turned = S::turned(stress, increment);
        S::scaled_sum(strain, 2.0 * self.shear_modulus, S::scaled_sum(turned, 1.0, S::isotropic(pressure)))
    }

    fn energy(&self, state: &State) -> f64 {
        let mean = state.stress.trace() / 3.0;
        let deviator = state.stress - Matrix3::from_diagonal_element(mean);
        let density = mean * mean / (2.0 * self.bulk_modulus) + deviator.norm_squared() / (4.0 * self.shear_modulus);
        density * state.deformation.determinant()
    }

    fn under_pressure(&self, pressure: f64, _dimensions: usize) -> (f64, Matrix3<f64>) {
        (1.0, Matrix3::from_diagonal_element(-pressure))
    }
}
