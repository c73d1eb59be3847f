//! Plasticity.

use super::{Hypoelastic, Law, State};
use crate::off::Off;
use grainbench_scene::space::Space;
use nalgebra::Matrix3;

/// Hypoelastic up to q = Y + H ε_p with q = √(3/2 s:s), s = dev σ; beyond, radial return:
/// Δε_p = (q − Y − H ε_p)/(3G + H), s ← s (1 − 3G Δε_p/q) (Simo & Hughes 1998, box 3.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMises {
    /// The elastic part.
    pub elastic: Hypoelastic,
    /// Yield stress Y (Pa).
    pub yield_stress: f64,
    /// Hardening modulus H (Pa).
    pub hardening_modulus: f64,
}

impl Law for VonMises {
    type PlasticStrain = f64;

    #[inline(always)]
    fn follow<S: Space>(
        &self,
        increment: S::Matrix,
        volume_ratio: f64,
        deformation: S::Matrix,
        stress: S::Symmetric,
        plastic_strain: &mut f64,
    ) -> S::Symmetric {
        let stress = self.elastic.follow::<S>(increment, volume_ratio, deformation, stress, &mut Off);
        let mean = S::trace(stress) / 3.0;
        let deviator = S::scaled_sum(stress, 1.0, S::isotropic(-mean));
        let squared = 1.5 * S::norm_squared(deviator);
        let limit = self.flow_stress(*plastic_strain);
        // A root only where it is needed: most of the time nothing flows.
        if squared <= limit * limit {
            return stress;
        }
        let equivalent = squared.sqrt();
        let excess = equivalent - limit;
        let stiffness = 3.0 * self.elastic.shear_modulus;
        let flow = excess / (stiffness + self.hardening_modulus);
        *plastic_strain += flow;
        S::scaled_sum(deviator, 1.0 - stiffness * flow / equivalent, S::isotropic(mean))
    }

    #[inline(always)]
    fn flow_stress(&self, plastic_strain: f64) -> f64 {
        self.yield_stress + self.hardening_modulus * plastic_strain
    }

    fn energy(&self, state: &State) -> f64 {
        self.elastic.energy(state)
    }

    fn under_pressure(&self, pressure: f64, dimensions: usize) -> (f64, Matrix3<f64>) {
        self.elastic.under_pressure(pressure, dimensions)
    }
}
