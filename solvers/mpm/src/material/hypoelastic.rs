//! Hypoelasticity.

use super::{Law, State};
use nalgebra::Matrix3;

/// σ̂ = 2G dev D + K tr D 1 with the Jaumann rate σ̂ = σ̇ − Wσ + σW, D and W the symmetric and skew parts of ∇v (1/s).
///
/// The stress is turned by the exact rotation of the midpoint rule (Hughes & Winget 1980), so that rigid rotation leaves
/// its invariants alone whatever the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hypoelastic {
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Law for Hypoelastic {
    #[inline(always)]
    fn update(&self, increment: &Matrix3<f64>, _volume_ratio: f64, state: &mut State) {
        let strain = (increment + increment.transpose()) * 0.5;
        let volumetric = strain.trace();
        let turned = turn(&state.stress, increment);
        let pressure = (self.bulk_modulus - 2.0 / 3.0 * self.shear_modulus) * volumetric;
        state.stress = turned + strain * (2.0 * self.shear_modulus) + Matrix3::from_diagonal_element(pressure);
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

/// R σ Rᵀ, R = (1 − W/2)⁻¹(1 + W/2) = 1 + (W + W²/2)/(1 + |w|²/4), w the axial vector of W.
#[inline(always)]
fn turn(stress: &Matrix3<f64>, increment: &Matrix3<f64>) -> Matrix3<f64> {
    let skew = (increment - increment.transpose()) * 0.5;
    let axial = skew.m12 * skew.m12 + skew.m23 * skew.m23 + skew.m31 * skew.m31;
    let rotation = Matrix3::identity() + (skew + skew * skew * 0.5) / (1.0 + 0.25 * axial);
    rotation * stress * rotation.transpose()
}
