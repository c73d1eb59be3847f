//! Two grains that touch, made ready for the chain of stages.

use super::chain::{Answer, Memory, Turning, stages};
use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{Options, Touch};
use crate::laws::Constants;
use grainbench_scene::space::Space;

/// Two grains that touch, as the loop over pairs finds them.
pub(crate) struct Pair<'a, S: Space> {
    /// The law between their materials.
    pub(crate) law: &'a Constants,
    /// Vector from the first centre to the second (m).
    pub(crate) between: S::Vector,
    /// Its squared length (m²).
    pub(crate) squared: f64,
    /// Radii R (m).
    pub(crate) radii: [f64; 2],
    /// Velocity of the first centre relative to the second (m/s).
    pub(crate) velocity: S::Vector,
    /// Inverse masses 1/m (1/kg).
    pub(crate) inverse_masses: [f64; 2],
    /// Angular velocities ω (rad/s).
    pub(crate) spins: [Option<S::Spin>; 2],
    /// Moments of inertia I (kg m²), only set for rolling resistance.
    pub(crate) inertia: [f64; 2],
}

impl<S: Space> Pair<'_, S> {
    /// Forces and moments at the contact; `elapsed` is the time since the last evaluation (s).
    #[inline(always)]
    pub(crate) fn respond<N: Normal, T: Tangential<S>, R: Rolling<S>, const RECORD: bool>(
        &self,
        options: &Options,
        elapsed: f64,
        history: &mut Memory<S, T, R>,
    ) -> Answer<S> {
        let distance = self.squared.sqrt();
        let inverse_distance = 1.0 / distance;
        let [first, second] = self.radii;
        let overlap = first + second - distance;
        let touch = Touch {
            law: self.law,
            between: self.between,
            inverse_distance,
            normal: self.between * inverse_distance,
            overlap,
            velocity: self.velocity,
            effective_mass: if N::DAMPED { harmonic(self.inverse_masses) } else { 0.0 },
            effective_radius: if N::CURVED || R::ACTIVE { first * second / (first + second) } else { 0.0 },
        };
        let arms = self.radii.map(|radius| radius - options.arm_reduction * overlap);
        let turning = match self.spins {
            [Some(a), Some(b)] => {
                let about = |k: usize| self.inertia[k] + self.radii[k] * self.radii[k] / self.inverse_masses[k];
                let inertia = if R::ACTIVE { harmonic([1.0 / about(0), 1.0 / about(1)]) } else { 0.0 };
                Some(Turning { surface: a * arms[0] + b * arms[1], relative: a - b, inertia })
            }
            _ => None,
        };
        stages::<S, N, T, R, RECORD>(&touch, arms, turning, options, elapsed, history)
    }
}

/// The mass (kg), or moment of inertia (kg m²), of two bodies against each other, from the inverses of both; none where
/// both are driven: they do not feel each other.
#[inline(always)]
fn harmonic([first, second]: [f64; 2]) -> f64 {
    let inverse = first + second;
    if inverse > 0.0 { 1.0 / inverse } else { 0.0 }
}
