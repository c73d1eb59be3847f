//! Constitutive laws and their selection. A new law needs a variant of [`Material`], a line in [`with_law`] and an
//! implementation of [`Law`].

use super::{Law, PointStep, State, VolumeRatio, symmetric_root};
use grainbench_lanes::logarithm::ln;
use grainbench_scene::material::{Constitutive, Deformable};
use grainbench_solver::space::{Solid, Space};
use nalgebra::Matrix3;

/// Constitutive law of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Material {
    NeoHookean(NeoHookean),
    KelvinVoigt(KelvinVoigt),
    Hypoelastic(Hypoelastic),
    VonMises(VonMises),
}

/// Evaluates an expression with the law of a [`Material`] as its own type.
macro_rules! with_law {
    ($material:expr, $law:ident => $call:expr) => {
        match $material {
            $crate::material::Material::NeoHookean($law) => $call,
            $crate::material::Material::KelvinVoigt($law) => $call,
            $crate::material::Material::Hypoelastic($law) => $call,
            $crate::material::Material::VonMises($law) => $call,
        }
    };
}

pub(crate) use with_law;

impl Material {
    /// Returns the law of a material for steps of `time_step` (s).
    pub(crate) fn new(deformable: &Deformable, time_step: f64) -> Self {
        let &Deformable { bulk_modulus, shear_modulus, constitutive } = deformable;
        let elastic = Hypoelastic { bulk_modulus, shear_modulus };
        let rubber = NeoHookean { lame: deformable.lame(), shear_modulus };
        match constitutive {
            Constitutive::NeoHookean => Self::NeoHookean(rubber),
            Constitutive::KelvinVoigt { viscosity, bulk_viscosity } => Self::KelvinVoigt(KelvinVoigt {
                elastic: rubber,
                shear_viscosity: viscosity / time_step,
                bulk_viscosity: bulk_viscosity / time_step,
            }),
            Constitutive::Hypoelastic => Self::Hypoelastic(elastic),
            Constitutive::VonMises { yield_stress, hardening_modulus } => {
                Self::VonMises(VonMises { elastic, yield_stress, hardening_modulus })
            }
        }
    }
}

/// Neo-Hookean law: Kirchhoff stress τ = Jσ = λ (ln J) I + G (b − I), with b = F Fᵀ, J = det F and the identity I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    /// Lamé's λ (Pa).
    pub lame: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl NeoHookean {
    #[inline(always)]
    fn stress<S: Space>(&self, deformation: S::Matrix, volume: VolumeRatio) -> S::Symmetric {
        let inverse = 1.0 / volume.ratio;
        let part = (self.lame * volume.logarithm - self.shear_modulus) * inverse;
        S::scaled_sum(S::finger(deformation), self.shear_modulus * inverse, S::isotropic(part))
    }
}

impl Law for NeoHookean {
    const LOGARITHM: bool = true;

    #[inline(always)]
    fn follow<S: Space>(&self, step: PointStep<S>, _plastic_strain: &mut f64) -> S::Symmetric {
        self.stress::<S>(step.deformation, step.volume)
    }

    /// Returns λ (1 − ln J) + G (1 + b_nn), with the largest row sum of |b| as an upper bound of b_nn.
    fn wave_modulus(&self, volume_ratio: f64, finger: &Matrix3<f64>) -> f64 {
        let stretch = finger.row_iter().map(|row| row.abs().sum()).fold(0.0, f64::max);
        self.lame * (1.0 - ln(volume_ratio)) + self.shear_modulus * (1.0 + stretch)
    }

    /// Returns W = λ/2 ln²J + G/2 (tr b − 3 − 2 ln J).
    fn energy(&self, state: &State) -> f64 {
        let log = ln(state.deformation.determinant());
        let stretch = state.deformation.norm_squared() - 3.0 - 2.0 * log;
        0.5 * (self.lame * log * log + self.shear_modulus * stretch)
    }

    /// Solves b = 1 + (Jσ − λ ln J 1)/G along the axes that deform. Secant steps find J from det b = J².
    fn under_stress(&self, stress: &Matrix3<f64>, dimensions: usize) -> Option<State> {
        let finger = |volume_ratio: f64| {
            let part = 1.0 - self.lame * ln(volume_ratio) / self.shear_modulus;
            Matrix3::from_fn(|row, column| match (row == column, row.max(column) < dimensions) {
                (true, true) => part + volume_ratio * stress[(row, column)] / self.shear_modulus,
                (false, true) => volume_ratio * stress[(row, column)] / self.shear_modulus,
                (same, false) => f64::from(u8::from(same)),
            })
        };
        let excess = |volume_ratio: f64| finger(volume_ratio).determinant() - volume_ratio * volume_ratio;
        let sum: f64 = (0..dimensions).map(|axis| stress[(axis, axis)]).sum();
        let linear = sum / (dimensions as f64 * self.lame + 2.0 * self.shear_modulus);
        // Start of the secant method: the linear solution and a value next to it.
        let (mut before, mut now) = (1.0001 * (1.0 + linear), 1.0 + linear);
        let mut old = excess(before);
        for _ in 0..50 {
            let new = excess(now);
            if new.abs() <= f64::EPSILON * now * now || new == old {
                break;
            }
            (before, now, old) = (now, now - new * (now - before) / (new - old), new);
        }
        let is_found = now > 0.0 && excess(now).abs() <= 1e-12 * now * now;
        let deformation = symmetric_root(&finger(now)).filter(|_| is_found)?;
        let stress = Solid::embed_symmetric(self.stress::<Solid>(deformation, VolumeRatio::new(now)));
        Some(State { deformation, stress, plastic_strain: 0.0 })
    }
}

/// Neo-Hookean law with an additional viscous stress: σ + 2η dev D + ζ tr D 1.
///
/// D is the symmetric part of ∇v (1/s) on the configuration at the middle of a step, so a rotation gives D = 0
/// ([`Space::at_midpoint`]). For small strain the material is a Kelvin–Voigt solid. The amplitude of a wave with wave
/// number k decays at the rate η_L k²/2ρ, with η_L = 4η/3 + ζ for longitudinal waves and η for transverse waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KelvinVoigt {
    /// Law of the elastic part of the stress.
    pub elastic: NeoHookean,
    /// Shear viscosity divided by the time step, η/Δt (Pa).
    pub shear_viscosity: f64,
    /// Bulk viscosity divided by the time step, ζ/Δt (Pa).
    pub bulk_viscosity: f64,
}

impl Law for KelvinVoigt {
    const LOGARITHM: bool = true;
    const VISCOUS: bool = true;

    #[inline(always)]
    fn follow<S: Space>(&self, step: PointStep<S>, _plastic_strain: &mut f64) -> S::Symmetric {
        let strain = S::symmetric_part(S::at_midpoint(step.increment));
        let mean = (self.bulk_viscosity - 2.0 / 3.0 * self.shear_viscosity) * S::trace(strain);
        let elastic = self.elastic.stress::<S>(step.deformation, step.volume);
        S::scaled_sum(strain, 2.0 * self.shear_viscosity, S::scaled_sum(S::isotropic(mean), 1.0, elastic))
    }

    #[inline(always)]
    fn viscous_work<S: Space>(&self, step: PointStep<S>) -> f64 {
        let elastic = self.elastic.stress::<S>(step.deformation, step.volume);
        let strain = S::symmetric_part(S::at_midpoint(step.increment));
        S::double_dot(S::scaled_sum(elastic, -1.0, step.stress), strain)
    }

    fn wave_modulus(&self, volume_ratio: f64, finger: &Matrix3<f64>) -> f64 {
        self.elastic.wave_modulus(volume_ratio, finger)
    }

    fn energy(&self, state: &State) -> f64 {
        self.elastic.energy(state)
    }

    fn under_stress(&self, stress: &Matrix3<f64>, dimensions: usize) -> Option<State> {
        self.elastic.under_stress(stress, dimensions)
    }
}

/// Hypoelastic law: σ̂ = 2G dev D + K tr D 1 with the Jaumann rate σ̂ = σ̇ − Wσ + σW. D and W are the symmetric and
/// skew parts of ∇v (1/s).
///
/// A step is integrated by the midpoint rule (Hughes & Winget 1980): σ ← R σ Rᵀ + 2G dev ε + K tr ε 1. Here ε = sym H,
/// W = skew H and R = (1 − W/2)⁻¹(1 + W/2), with H = Δt ∇v on the configuration at the middle of the step
/// ([`Space::at_midpoint`]). For any step size, a rigid rotation gives no strain and keeps the invariants of the
/// stress. On the configuration at the start of the step, a rotation by θ would give a compression by 1 − cos θ, and a
/// spinning body would grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hypoelastic {
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Law for Hypoelastic {
    const TRIES: bool = true;

    #[inline(always)]
    fn trial<S: Space>(&self, increment: S::Matrix, stress: S::Symmetric) -> (S::Symmetric, f64) {
        let middle = S::at_midpoint(increment);
        let strain = S::symmetric_part(middle);
        let pressure = (self.bulk_modulus - 2.0 / 3.0 * self.shear_modulus) * S::trace(strain);
        let turned = S::turned(stress, middle);
        let sum = S::scaled_sum(turned, 1.0, S::isotropic(pressure));
        (S::scaled_sum(strain, 2.0 * self.shear_modulus, sum), 0.0)
    }

    /// Returns J (K + 4G/3), because the moduli belong to the Cauchy stress and the density is ρ₀/J.
    fn wave_modulus(&self, volume_ratio: f64, _finger: &Matrix3<f64>) -> f64 {
        volume_ratio * (self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus)
    }

    fn energy(&self, state: &State) -> f64 {
        let mean = state.stress.trace() / 3.0;
        let deviator = state.stress - Matrix3::from_diagonal_element(mean);
        let density = mean * mean / (2.0 * self.bulk_modulus) + deviator.norm_squared() / (4.0 * self.shear_modulus);
        density * state.deformation.determinant()
    }

    /// Returns the given stress with F = 1, because the law does not define the deformation for a stress.
    fn under_stress(&self, stress: &Matrix3<f64>, _dimensions: usize) -> Option<State> {
        Some(State { stress: *stress, ..State::default() })
    }
}

/// Hypoelastic law with von Mises yielding. It is elastic up to q = Y + H ε_p with q = √(3/2 s:s), s = dev σ. Beyond
/// this limit, the stress returns radially: Δε_p = (q − Y − H ε_p)/(3G + H), s ← s (1 − 3G Δε_p/q) (Simo & Hughes 1998,
/// box 3.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMises {
    /// Law below the yield limit.
    pub elastic: Hypoelastic,
    /// Yield stress Y (Pa).
    pub yield_stress: f64,
    /// Hardening modulus H (Pa).
    pub hardening_modulus: f64,
}

impl Law for VonMises {
    const YIELDS: bool = true;
    const TRIES: bool = true;

    #[inline(always)]
    fn trial<S: Space>(&self, increment: S::Matrix, stress: S::Symmetric) -> (S::Symmetric, f64) {
        let (stress, _) = self.elastic.trial::<S>(increment, stress);
        let deviator = S::scaled_sum(stress, 1.0, S::isotropic(-(S::trace(stress) / 3.0)));
        (stress, 1.5 * S::norm_squared(deviator))
    }

    #[inline(always)]
    fn flow<S: Space>(&self, (stress, squared): (S::Symmetric, f64), plastic_strain: &mut f64) -> S::Symmetric {
        let limit = self.flow_stress(*plastic_strain);
        // The square root is computed only when the point yields, which is rare.
        if squared <= limit * limit {
            return stress;
        }
        let mean = S::trace(stress) / 3.0;
        let deviator = S::scaled_sum(stress, 1.0, S::isotropic(-mean));
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

    fn wave_modulus(&self, volume_ratio: f64, finger: &Matrix3<f64>) -> f64 {
        self.elastic.wave_modulus(volume_ratio, finger)
    }

    fn energy(&self, state: &State) -> f64 {
        self.elastic.energy(state)
    }

    fn under_stress(&self, stress: &Matrix3<f64>, dimensions: usize) -> Option<State> {
        let deviator = stress - Matrix3::from_diagonal_element(stress.trace() / 3.0);
        let equivalent = (1.5 * deviator.norm_squared()).sqrt();
        self.elastic.under_stress(stress, dimensions).filter(|_| equivalent <= self.yield_stress)
    }
}
