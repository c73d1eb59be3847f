//! Plasticity.

use super::{Hypoelastic, Law, State};
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
    #[inline(always)]
    fn update(&self, increment: &Matrix3<f64>, volume_ratio: f64, state: &mut State) {
        self.elastic.update(increment, volume_ratio, state);
        let mean = Matrix3::from_diagonal_element(state.stress.trace() / 3.0);
        let deviator = state.stress - mean;
        let equivalent = (1.5 * deviator.norm_squared()).sqrt();
        let excess = equivalent - self.yield_stress - self.hardening_modulus * state.plastic_strain;
        if excess > 0.0 {
            let stiffness = 3.0 * self.elastic.shear_modulus;
            let flow = excess / (stiffness + self.hardening_modulus);
            state.plastic_strain += flow;
            state.stress = mean + deviator * (1.0 - stiffness * flow / equivalent);
        }
    }

    fn energy(&self, state: &State) -> f64 {
        self.elastic.energy(state)
    }

    fn under_pressure(&self, pressure: f64, dimensions: usize) -> (f64, Matrix3<f64>) {
        self.elastic.under_pressure(pressure, dimensions)
    }
}
