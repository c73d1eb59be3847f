//! Neo-Hookean elasticity.

use super::{Law, State};
use crate::off::Off;
use grainbench_lanes::logarithm::ln;
use grainbench_scene::space::{Solid, Space};
use nalgebra::Matrix3;

/// Kirchhoff stress τ = Jσ = λ ln J 1 + G (b − 1), b = F Fᵀ, J = det F.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Lamé's λ (Pa).
    pub lame: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl NeoHookean {
    #[inline(always)]
    fn stress<S: Space>(&self, deformation: S::Matrix, volume_ratio: f64) -> S::Symmetric {
        let inverse = 1.0 / volume_ratio;
        let part = (self.lame * ln(volume_ratio) - self.shear_modulus) * inverse;
        S::scaled_sum(S::finger(deformation), self.shear_modulus * inverse, S::isotropic(part))
    }
}

impl Law for NeoHookean {
    type PlasticStrain = Off;

    #[inline(always)]
    fn follow<S: Space>(
        &self,
        _increment: S::Matrix,
        volume_ratio: f64,
        deformation: S::Matrix,
        _stress: S::Symmetric,
        _plastic_strain: &mut Off,
    ) -> S::Symmetric {
        self.stress::<S>(deformation, volume_ratio)
    }

    /// W = λ/2 ln²J + G/2 (tr b − 3 − 2 ln J).
    fn energy(&self, state: &State) -> f64 {
        let log = ln(state.deformation.determinant());
        let stretch = state.deformation.norm_squared() - 3.0 - 2.0 * log;
        0.5 * (self.lame * log * log + self.shear_modulus * stretch)
    }

    fn under_pressure(&self, pressure: f64, dimensions: usize) -> (f64, Matrix3<f64>) {
        let deformed = |stretch: f64| {
            let mut deformation = Matrix3::identity();
            (0..dimensions).for_each(|axis| deformation[(axis, axis)] = stretch);
            Solid::embed_symmetric(self.stress::<Solid>(deformation, stretch.powi(dimensions as i32)))
        };
        // Secant steps: the stress is nearly linear in the stretch at pressures far below the moduli.
        let (mut before, mut now) = (1.0, 1.0 - pressure / (dimensions as f64 * self.lame + 2.0 * self.shear_modulus));
        for _ in 0..50 {
            let (old, new) = (deformed(before).m11 + pressure, deformed(now).m11 + pressure);
            if (new - old).abs() <= 1e-15 * pressure.abs() {
                break;
            }
            (before, now) = (now, now - new * (now - before) / (new - old));
        }
        (now, deformed(now))
    }
}
