//! Constitutive laws, three by three in both dimensions: in the plane the strain out of it is zero, the stress is not.

mod laws;
mod plastic_strain;

pub use laws::{Hypoelastic, KelvinVoigt, NeoHookean, VonMises};
pub(crate) use laws::{Material, with_law};
pub use plastic_strain::PlasticStrain;

use grainbench_lanes::logarithm::ln;
use grainbench_scene::space::{Solid, Space};
use nalgebra::Matrix3;

/// The state of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Deformation gradient F.
    pub deformation: Matrix3<f64>,
    /// Cauchy stress σ (Pa), tension positive.
    pub stress: Matrix3<f64>,
    /// Equivalent plastic strain.
    pub plastic_strain: f64,
}

impl Default for State {
    fn default() -> Self {
        Self { deformation: Matrix3::identity(), stress: Matrix3::zeros(), plastic_strain: 0.0 }
    }
}

/// The volume of a point over that at the start.
#[derive(Clone, Copy, Debug)]
pub struct VolumeRatio {
    /// The ratio J.
    pub ratio: f64,
    /// ln J, of laws that take it: it is found for many points at once.
    pub logarithm: f64,
}

impl VolumeRatio {
    /// A ratio with its logarithm.
    #[inline(always)]
    #[must_use]
    pub fn of(ratio: f64) -> Self {
        Self { ratio, logarithm: ln(ratio) }
    }
}

/// A law between deformation and stress.
pub trait Law: Copy + Send + Sync + 'static {
    /// The plastic strain that it reads and changes: [`crate::off::Off`] for laws that never yield.
    type PlasticStrain: PlasticStrain;
    /// Whether its stress takes the logarithm of the volume ratio.
    const LOGARITHM: bool = false;
    /// Whether a part of its stress is viscous.
    const VISCOUS: bool = false;
    /// Returns the stress after a step with the displacement gradient `increment` = Δt ∇v on the configuration at its start,
    /// from the stress before it and the deformation after it, of which `volume` is the determinant.
    fn follow<S: Space>(
        &self,
        increment: S::Matrix,
        volume: VolumeRatio,
        deformation: S::Matrix,
        stress: S::Symmetric,
        plastic_strain: &mut Self::PlasticStrain,
    ) -> S::Symmetric;
    /// The same of a state in three dimensions, which holds the deformation after the step and the stress before it.
    fn update(&self, increment: &Matrix3<f64>, volume_ratio: f64, state: &mut State) {
        let stress = Solid::restrict_symmetric(state.stress);
        let own = std::slice::from_mut(&mut state.plastic_strain);
        let mut plastic_strain = Self::PlasticStrain::read(own, 0);
        let volume = VolumeRatio::of(volume_ratio);
        let stress = self.follow::<Solid>(*increment, volume, state.deformation, stress, &mut plastic_strain);
        plastic_strain.write(own, 0);
        state.stress = Solid::embed_symmetric(stress);
    }
    /// Whether its stress is that of [`Law::trial`], found for many points at once, and then of [`Law::flow`].
    const TRIES: bool = false;
    /// The stress after a step if nothing flows, and 3/2 s:s of it, s = dev σ (Pa²), of laws that yield; of others that is not
    /// read.
    #[inline(always)]
    fn trial<S: Space>(&self, _increment: S::Matrix, stress: S::Symmetric) -> (S::Symmetric, f64) {
        (stress, 0.0)
    }
    /// The stress after flow, where there is some, from what [`Law::trial`] gave.
    #[inline(always)]
    fn flow<S: Space>(
        &self,
        (stress, _squared): (S::Symmetric, f64),
        _plastic_strain: &mut Self::PlasticStrain,
    ) -> S::Symmetric {
        stress
    }
    /// Stress at which it flows after a plastic strain (Pa); zero for laws that do not.
    #[inline(always)]
    fn flow_stress(&self, _plastic_strain: Self::PlasticStrain) -> f64 {
        0.0
    }
    /// What the viscous part of the stress in a state does on a strain, per volume (J/m³); zero for laws without viscosity.
    #[inline(always)]
    fn viscous_work<S: Space>(
        &self,
        _strain: S::Symmetric,
        _volume_ratio: f64,
        _deformation: S::Matrix,
        _stress: S::Symmetric,
    ) -> f64 {
        0.0
    }
    /// Returns ρ₀c² (Pa) of the fastest longitudinal wave, ρ₀ the density at the start and c its speed in space (m/s), of
    /// material with a volume ratio and the left Cauchy–Green tensor b = F Fᵀ; from above where b has shear.
    ///
    /// For a wave along n it is the second derivative of the elastic energy of (1 + ε n ⊗ n) F per volume at the start by ε.
    fn wave_modulus(&self, volume_ratio: f64, finger: &Matrix3<f64>) -> f64;
    /// Elastic energy per volume at the start (J/m³).
    fn energy(&self, state: &State) -> f64;
    /// The state without rotation and plastic strain in which a stress (Pa) acts along the axes that can deform: the first
    /// `dimensions`. Laws that know the stress by its history take the rest of it too. None where there is no such state.
    fn under_stress(&self, stress: &Matrix3<f64>, dimensions: usize) -> Option<State>;
}

/// The symmetric root of a positive definite matrix near the unit one, by the coupled iteration of Denman and Beavers (1976),
/// which needs sums and inverses alone; none where it does not converge.
fn symmetric_root(of: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let (mut root, mut inverse) = (*of, Matrix3::identity());
    for _ in 0..50 {
        let next = (root + inverse.try_inverse()?) * 0.5;
        inverse = (inverse + root.try_inverse()?) * 0.5;
        let way = (next - root).norm();
        root = next;
        // What it gains with each step is squared: the next would change nothing but the last digits.
        if way <= 1e-13 * root.norm() {
            let is_root = (root * root - of).norm() <= 1e-12 * of.norm() && root.determinant() > 0.0;
            return is_root.then_some(root);
        }
    }
    None
}
