//! Contact between two grains, prepared for the chain of stages.

use super::chain::{Answer, BodyRotations, stages};
use super::normal::Normal;
use super::rolling::Rolling;
use super::tangential::Tangential;
use super::{ContactInput, ContactRotation, Memory, MidStepNormal, Terms, stiffness_ratio};
use crate::geometry::{Geometry, Linear};
use crate::laws::Constants;
use grainbench_lanes::Number;

/// Distances between the grains of one pair, or of several pairs at a time.
#[derive(Clone, Copy)]
pub(crate) struct PairDistances<S: Geometry, X: Number> {
    /// Vector from the first centre to the second (m).
    pub(crate) between: S::Vectors<X>,
    /// Distance d between the centres (m).
    pub(crate) distance: X,
    /// Inverse distance 1/d (1/m).
    pub(crate) inverse_distance: X,
    /// Sum of the radii (m).
    pub(crate) reach: X,
    /// Radii R of both grains (m); zero if no law needs them or if they are read together with the spins.
    pub(crate) radii: [X; 2],
}

/// Two grains in contact, or several such pairs at a time.
pub(crate) struct Pair<'a, S: Geometry, X: Number> {
    /// Law between the two materials.
    pub(crate) law: &'a Constants<X>,
    /// Distances between the grains, with radii for all laws that need them.
    pub(crate) apart: PairDistances<S, X>,
    /// Velocity of the first centre relative to the second (m/s).
    pub(crate) velocity: S::Vectors<X>,
    /// Sum of the inverse masses, 1/m₁ + 1/m₂ (1/kg).
    pub(crate) inverse_mass: X,
    /// Inverse masses 1/m of both grains (1/kg), for rolling resistance only.
    pub(crate) inverse_masses: [X; 2],
    /// Angular velocities ω of both grains (rad/s); `None` if grains do not rotate.
    pub(crate) spins: Option<[S::Spins<X>; 2]>,
    /// Inverse moments of inertia 1/I of both grains (1/(kg m²)); only set for rolling resistance.
    pub(crate) inverse_inertia: [X; 2],
}

impl<S: Geometry, X: Number> Pair<'_, S, X> {
    /// Returns the forces and moments at the contact.
    #[inline(always)]
    pub(crate) fn respond<N: Normal, T: Tangential<S>, R: Rolling<S>>(
        &self,
        terms: Terms<'_>,
        memory: &mut Memory<X>,
    ) -> Answer<S, X> {
        let PairDistances { between, distance, inverse_distance, reach, radii: [first, second] } = self.apart;
        let (velocity, zero, elapsed) = (self.velocity, distance.like(0.0), terms.elapsed);
        let overlap = reach - distance;
        let normal = between * inverse_distance;
        let is_mid_step = terms.options.mid_step && T::MAY_BE_MID_STEP && (N::DAMPED || T::ACTIVE);
        let turns = T::TURNED && S::DIMENSION == 3;
        let changes = N::CURVED && T::ACTIVE && (T::TURNED || R::ACTIVE || terms.record);
        let middle = if is_mid_step || turns || changes {
            MidStepNormal::<S, X>::of_centres(normal, inverse_distance, velocity, elapsed)
        } else {
            MidStepNormal::end(normal, distance)
        };
        // One division serves both the effective radius and the ratio of stiffnesses. Contacts without friction use the
        // same operations, so that friction in another contact changes no bit of them.
        let inverse = if N::CURVED { distance.like(1.0) / (reach * overlap) } else { zero };
        let touch = ContactInput {
            law: self.law,
            between,
            inverse_distance,
            normal,
            overlap,
            velocity_normal: if is_mid_step { middle.normal } else { normal },
            turn: self.spins.filter(|_| turns).map(|[a, b]| ContactRotation::new(middle.normal, a + b, elapsed)),
            stiffness_ratio: if changes {
                stiffness_ratio(inverse * reach, velocity.dot(middle.normal), elapsed)
            } else {
                distance.like(1.0)
            },
            velocity,
            effective_mass: if N::DAMPED { harmonic(self.inverse_mass) } else { zero },
            effective_radius: match (N::CURVED, R::ACTIVE) {
                (true, _) => first * second * (inverse * overlap),
                (false, true) => first * second / reach,
                (false, false) => zero,
            },
        };
        let off = overlap * terms.options.arm_reduction;
        let arms = [first - off, second - off];
        let turning = match self.spins {
            Some([a, b]) => {
                let inertia = if R::ACTIVE { harmonic(self.about_contact(0) + self.about_contact(1)) } else { zero };
                let surface = a * arms[0] + b * arms[1];
                let surface = if is_mid_step { surface * middle.chord } else { surface };
                Some(BodyRotations { surface, relative: a - b, inertia })
            }
            None => None,
        };
        stages::<S, N, T, R, X>(&touch, arms, turning, terms, memory)
    }

    /// Returns the inverse moment of inertia of a grain about the contact, 1/(I + m R²) (1/(kg m²)).
    #[inline(always)]
    fn about_contact(&self, grain: usize) -> X {
        let radius = self.apart.radii[grain];
        let one = radius.like(1.0);
        one / (one / self.inverse_inertia[grain] + radius * radius / self.inverse_masses[grain])
    }
}

/// Returns the effective mass (kg), or moment of inertia (kg m²), of two bodies from the sum of their inverses. It is
/// zero if this sum is zero, because both bodies have prescribed motion.
#[inline(always)]
pub(crate) fn harmonic<X: Number>(inverse: X) -> X {
    let [zero, one] = [inverse.like(0.0), inverse.like(1.0)];
    X::choose(zero.below(inverse), one / inverse, zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::MEMORY;
    use crate::contact::normal::Spring;
    use crate::contact::options::Options;
    use crate::contact::rolling::FreeRolling;
    use crate::contact::tangential::{Coulomb, Projected};
    use crate::convention::Convention;
    use crate::geometry::Components;
    use crate::laws::Laws;
    use grainbench_solver::space::Solid;
    use nalgebra::Vector3;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Two spheres stick together and rotate by a quarter turn about z as one body, with a displaced tangential spring.
    /// The tangential force F_s stays perpendicular to the normal e. Each of N steps removes the normal part of the
    /// displacement. Together they shorten it by a fraction 1 − cos^N(π/2N) < π²/(8N).
    ///
    /// The rotation causes no slip if the lever arms a are R − δ/2: (v₁ − v₂) + ω (a₁ + a₂) × e = 0 with v₁ − v₂ = −ω × e
    /// (2R − δ).
    #[test]
    fn stuck_spheres_carry_their_spring_when_they_swing() {
        type Stretched = Coulomb<Projected>;
        let law = Constants { springs: [1e6, 5e5], friction: 1e3, ..Constants::default() };
        let (laws, options) = (Laws::default(), Options::from_convention(&Convention::LIGGGHTS));
        let (steps, overlap, slip) = (1000, 0.01, 1e-4);
        let spin = Vector3::z() * FRAC_PI_2;
        let mut memory = [0.0; MEMORY];
        let mut swung = |turned: f64, extra: Vector3<f64>, elapsed: f64| {
            let (sine, cosine) = (FRAC_PI_2 * turned).sin_cos();
            let between = Vector3::new(cosine, sine, 0.0) * (1.0 - overlap);
            let apart = PairDistances {
                between: Components(between.into()),
                distance: between.norm(),
                inverse_distance: 1.0 / between.norm(),
                reach: 1.0,
                radii: [0.4, 0.6],
            };
            let pair = Pair::<Solid, f64> {
                law: &law,
                apart,
                velocity: Components((extra - spin.cross(&between)).into()),
                inverse_mass: 2.0,
                inverse_masses: [1.0; 2],
                spins: Some([Components(spin.into()); 2]),
                inverse_inertia: [0.0; 2],
            };
            let terms = Terms { laws: &laws, options: &options, elapsed, record: false };
            let answer = pair.respond::<Spring, Stretched, FreeRolling>(terms, &mut memory);
            (Vector3::from(answer.shear.0), Vector3::from(answer.normal.0))
        };
        // The first step displaces the spring along +y; the spring pulls the first sphere back.
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
