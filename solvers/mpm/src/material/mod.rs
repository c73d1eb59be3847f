//! Constitutive laws, three by three in both dimensions: in the plane the strain out of it is zero, the stress is not.

mod laws;
mod plastic_strain;

pub use laws::{Hypoelastic, NeoHookean, VonMises};
pub(crate) use laws::{Material, with_law};
pub use plastic_strain::PlasticStrain;

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

/// A law between deformation and stress.
pub trait Law: Copy + Send + Sync + 'static {
    /// The plastic strain that it reads and changes: [`crate::off::Off`] for laws that never yield.
    type PlasticStrain: PlasticStrain;
    /// The stress after a step with the displacement gradient `increment` = Δt ∇v, from the stress before it and the
    /// deformation after it, of which `volume_ratio` is the determinant.
    fn follow<S: Space>(
        &self,
        increment: S::Matrix,
        volume_ratio: f64,
        deformation: S::Matrix,
        stress: S::Symmetric,
        plastic_strain: &mut Self::PlasticStrain,
    ) -> S::Symmetric;
    /// The same of a state in three dimensions, which holds the deformation after the step and the stress before it.
    fn update(&self, increment: &Matrix3<f64>, volume_ratio: f64, state: &mut State) {
        let stress = Solid::restrict_symmetric(state.stress);
        let own = std::slice::from_mut(&mut state.plastic_strain);
        let mut plastic_strain = Self::PlasticStrain::read(own, 0);
        let stress = self.follow::<Solid>(*increment, volume_ratio, state.deformation, stress, &mut plastic_strain);
        plastic_strain.write(own, 0);
        state.stress = Solid::embed_symmetric(stress);
    }
    /// Stress at which it flows after a plastic strain (Pa); zero for laws that do not.
    #[inline(always)]
    fn flow_stress(&self, _plastic_strain: Self::PlasticStrain) -> f64 {
        0.0
    }
    /// Elastic energy per volume at the start (J/m³).
    fn energy(&self, state: &State) -> f64;
    /// The deformation, equal along the axes that can deform, at which a pressure (Pa) acts along them, as a stretch;
    /// and the stress then.
    fn under_pressure(&self, pressure: f64, dimensions: usize) -> (f64, Matrix3<f64>);
}
