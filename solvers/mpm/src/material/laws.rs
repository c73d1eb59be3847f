//! The laws between deformation and stress, and which of them a material has. A new one is a variant of [`Material`], a line of
//! [`with_law`], and its stress.

use super::{Law, State};
use crate::off::Off;
use grainbench_lanes::logarithm::ln;
use grainbench_scene::material::{Constitutive, Deformable};
use grainbench_scene::space::{Solid, Space};
use nalgebra::Matrix3;

/// The law of a body's material.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    NeoHookean(NeoHookean),
    Hypoelastic(Hypoelastic),
    VonMises(VonMises),
}

/// An expression with the law of a [`Material`] as a type of its own.
macro_rules! with_law {
    ($material:expr, $law:ident => $call:expr) => {
        match $material {
            $crate::material::Material::NeoHookean($law) => $call,
            $crate::material::Material::Hypoelastic($law) => $call,
            $crate::material::Material::VonMises($law) => $call,
        }
    };
}

pub(crate) use with_law;

impl Material {
    pub(crate) fn of(deformable: &Deformable) -> Self {
        let &Deformable { bulk_modulus, shear_modulus, constitutive } = deformable;
        let elastic = Hypoelastic { bulk_modulus, shear_modulus };
        match constitutive {
            Constitutive::NeoHookean => Self::NeoHookean(NeoHookean { lame: deformable.lame(), shear_modulus }),
            Constitutive::Hypoelastic => Self::Hypoelastic(elastic),
            Constitutive::VonMises { yield_stress, hardening_modulus } => {
                Self::VonMises(VonMises { elastic, yield_stress, hardening_modulus })
            }
        }
    }
}

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
