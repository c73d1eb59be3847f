//! Constitutive laws. Tensors are 3 × 3 also in two dimensions, because in plane strain the out-of-plane strain is zero
//! but the stress is not.

mod laws;
pub(crate) mod stress;

pub use laws::{Hypoelastic, KelvinVoigt, NeoHookean, VonMises};
pub(crate) use laws::{Material, with_law};

use grainbench_lanes::logarithm::ln;
use grainbench_solver::space::{Solid, Space};
use nalgebra::Matrix3;

/// State of a material point.
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

/// Volume of a point relative to its initial volume.
#[derive(Clone, Copy, Debug)]
pub struct VolumeRatio {
    /// Volume divided by initial volume, J = det F.
    pub ratio: f64,
    /// ln J, for laws that use it. It is computed for many points at once.
    pub logarithm: f64,
}

impl VolumeRatio {
    /// Returns the ratio `ratio` with its logarithm.
    #[inline(always)]
    #[must_use]
    pub fn new(ratio: f64) -> Self {
        Self { ratio, logarithm: ln(ratio) }
    }
}

/// Step of a material point, from which a law computes the stress.
#[derive(Clone, Copy, Debug)]
pub struct PointStep<S: Space> {
    /// Displacement gradient Δt ∇v on the configuration at the start of the step.
    pub increment: S::Matrix,
    /// Deformation after the step.
    pub deformation: S::Matrix,
    /// Determinant of `deformation`.
    pub volume: VolumeRatio,
    /// Stress before the step (Pa).
    pub stress: S::Symmetric,
}

/// Constitutive law, which gives the stress of a material point.
pub trait Law: Copy + Send + Sync + 'static {
    /// True if the law reads and changes the plastic strain.
    const YIELDS: bool = false;
    /// True if the stress depends on the logarithm of the volume ratio.
    const LOGARITHM: bool = false;
    /// True if a part of the stress is viscous.
    const VISCOUS: bool = false;
    /// Returns the stress after a step.
    #[inline(always)]
    fn follow<S: Space>(&self, step: PointStep<S>, plastic_strain: &mut f64) -> S::Symmetric {
        self.flow::<S>(self.trial::<S>(step.increment, step.stress), plastic_strain)
    }
    /// Updates stress and plastic strain of a state in three dimensions. On entry, the state contains the deformation
    /// after the step and the stress before the step.
    fn update(&self, increment: &Matrix3<f64>, volume_ratio: f64, state: &mut State) {
        let (deformation, stress) = (state.deformation, Solid::restrict_symmetric(state.stress));
        let step = PointStep { increment: *increment, deformation, volume: VolumeRatio::new(volume_ratio), stress };
        state.stress = Solid::embed_symmetric(self.follow::<Solid>(step, &mut state.plastic_strain));
    }
    /// True if the stress is computed by [`Law::trial`], for many points at once, followed by [`Law::flow`].
    const TRIES: bool = false;
    /// Returns the trial stress after a step without plastic flow, and 3/2 s:s of this stress with s = dev σ (Pa²).
    ///
    /// The second value is read only for laws with yielding.
    #[inline(always)]
    fn trial<S: Space>(&self, _increment: S::Matrix, stress: S::Symmetric) -> (S::Symmetric, f64) {
        (stress, 0.0)
    }
    /// Returns the stress after plastic flow, if any, from the result of [`Law::trial`].
    #[inline(always)]
    fn flow<S: Space>(&self, (stress, _squared): (S::Symmetric, f64), _plastic_strain: &mut f64) -> S::Symmetric {
        stress
    }
    /// Returns the flow stress at a plastic strain (Pa); zero for laws without yielding.
    #[inline(always)]
    fn flow_stress(&self, _plastic_strain: f64) -> f64 {
        0.0
    }
    /// Returns the work per volume of the viscous stress on the strain of a step (J/m³); zero without viscosity.
    /// Deformation and stress belong to one state, before or after the step.
    #[inline(always)]
    fn viscous_work<S: Space>(&self, _step: PointStep<S>) -> f64 {
        0.0
    }
    /// Returns ρ₀c² (Pa) of the fastest longitudinal wave, with the initial density ρ₀ and the spatial wave speed c
    /// (m/s).
    ///
    /// The state is given by the volume ratio and the left Cauchy–Green tensor b = F Fᵀ. If b has shear components, the
    /// result is an upper bound. For a wave along n, ρ₀c² is the second derivative with respect to ε of the elastic
    /// energy per initial volume of (1 + ε n ⊗ n) F.
    fn wave_modulus(&self, volume_ratio: f64, finger: &Matrix3<f64>) -> f64;
    /// Returns the elastic energy per initial volume (J/m³).
    fn energy(&self, state: &State) -> f64;
    /// Returns the state with this Cauchy stress (Pa), no rotation and no plastic strain, or `None` if there is no such
    /// state.
    ///
    /// Only the first `dimensions` axes deform. Hypoelastic laws also store the stress components of the other axes.
    fn under_stress(&self, stress: &Matrix3<f64>, dimensions: usize) -> Option<State>;
}

/// Returns the symmetric square root of a positive definite matrix near the identity.
///
/// The coupled iteration of Denman and Beavers (1976) needs only sums and inverses. Returns `None` if it does not
/// converge.
fn symmetric_root(matrix: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let (mut root, mut inverse) = (*matrix, Matrix3::identity());
    for _ in 0..50 {
        let next = (root + inverse.try_inverse()?) * 0.5;
        inverse = (inverse + root.try_inverse()?) * 0.5;
        let way = (next - root).norm();
        root = next;
        // Convergence is quadratic, so a further step would change only the last digits.
        if way <= 1e-13 * root.norm() {
            let is_root = (root * root - matrix).norm() <= 1e-12 * matrix.norm() && root.determinant() > 0.0;
            return is_root.then_some(root);
        }
    }
    None
}
