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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::normal::Spring;
    use crate::contact::rolling::FreeRolling;
    use crate::contact::tangential::{CapOnSpring, Coulomb, Turned};
    use crate::convention::Convention;
    use grainbench_scene::space::Solid;
    use nalgebra::Vector3;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Two spheres that are stuck together, their spring stretched, swing by a quarter turn about z as one body: F_s keeps
    /// its length, but for 1 − cos^N(π/2N) < π²/(8N) of it that N steps take off as the normal part, and F_s·e = 0.
    ///
    /// Rigid motion slips by nothing where the torque arms meet, at R − δ/2: (v₁ − v₂) + ω (a₁ + a₂) × e = 0 with v₁ − v₂ =
    /// −ω × e (2R − δ).
    #[test]
    fn stuck_spheres_carry_their_spring_when_they_swing() {
        type Stretched = Coulomb<CapOnSpring, Turned>;
        let law = Constants { springs: [1e6, 5e5], friction: 1e3, ..Constants::default() };
        let options = Options::of(&Convention::LIGGGHTS);
        let (steps, overlap, slip) = (1000, 0.01, 1e-4);
        let spin = Vector3::z() * FRAC_PI_2;
        let mut history = Memory::<Solid, Stretched, FreeRolling>::default();
        let mut swung = |turned: f64, extra: Vector3<f64>, elapsed: f64| {
            let (sine, cosine) = (FRAC_PI_2 * turned).sin_cos();
            let between = Vector3::new(cosine, sine, 0.0) * (1.0 - overlap);
            let pair = Pair::<Solid> {
                law: &law,
                between,
                squared: between.norm_squared(),
                radii: [0.4, 0.6],
                velocity: extra - spin.cross(&between),
                inverse_masses: [1.0; 2],
                spins: [Some(spin); 2],
                inertia: [0.0; 2],
            };
            let answer = pair.respond::<Spring, Stretched, FreeRolling, false>(&options, elapsed, &mut history);
            (answer.shear, answer.normal)
        };
        // Stretched along +y in a first step; the spring pulls the first sphere back.
        let (start, _) = swung(0.0, Vector3::y() * slip, 1.0);
        let force = 5e5 * slip;
        assert!((start + Vector3::y() * force).norm() < 1e-9 * force, "{start:?}");
        let ends = (1..=steps).map(|step| swung(f64::from(step) / f64::from(steps), Vector3::zeros(), 1e-3));
        let (shear, normal) = ends.last().unwrap_or_default();
        assert!((normal - Vector3::y()).norm() < 1e-12 && shear.dot(&normal).abs() < 1e-12 * force, "{shear:?}");
        let kept = shear.x / force;
        assert!(kept < 1.0 + 1e-9 && 1.0 - kept < PI * PI / (8.0 * f64::from(steps)), "{kept}");
    }
}
