//! Second stage of a contact law. It computes the tangential force of a spring and a dashpot with the Coulomb limit.
//!
//! The contact history is the displacement s of the tangential spring (m). It grows by the slip velocity times the time
//! step, and rotates with the contact ([`SpringTransport`]). The Coulomb limit reduces it ([`Cap`]).

use super::normal::{Normal, NormalForce};
use super::options::Cap;
use super::{ContactInput, Memory, Terms};
use crate::geometry::{Geometry, Linear};
use grainbench_lanes::Number;
use std::fmt::Debug;
use std::marker::PhantomData;

/// Result of the tangential stage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear<S: Geometry, X: Number> {
    /// Tangential force F_s on the first body (N).
    pub(crate) force: S::Tangents<X>,
    /// True if the Coulomb limit was reached.
    pub(crate) slipping: X::Mask,
}

/// Tangential force law of a contact, as a stage of the chain. The provided functions are those of a stage without
/// friction.
pub(crate) trait Tangential<S: Geometry>: Copy + Send + Sync + 'static {
    /// Number of history values: the components of the tangential spring displacement (m). They come first in the history.
    const NUMBERS: usize;
    /// True if the stage exerts a tangential force.
    const ACTIVE: bool = Self::NUMBERS > 0;
    /// True if springs rotate with the contact ([`crate::convention::History::Turned`]).
    const TURNED: bool;
    /// True if a convention with this stage may decompose velocities along the mid-step normal.
    const MAY_BE_MID_STEP: bool = Self::TURNED || !Self::ACTIVE;
    /// Factor by which the history values are multiplied when the first and the second grain are exchanged.
    const EXCHANGED: f64;

    /// Returns the tangential force for a slip velocity (m/s), and updates the contact history.
    #[inline(always)]
    fn respond<N: Normal, X: Number>(
        _touch: &ContactInput<'_, S, X>,
        _normal: NormalForce<X>,
        slip: S::Tangents<X>,
        _terms: Terms<'_>,
        _memory: &mut Memory<X>,
    ) -> Shear<S, X> {
        let squared = slip.dot(slip);
        Shear { force: slip * squared.like(0.0), slipping: squared.below(squared) }
    }

    /// Returns two energies lost in a step (J): the frictional work, and the energy released by a change of stiffness.
    ///
    /// Before the step, the spring has the displacement s₀, already rotated with the contact, and the stiffness k₀. The
    /// change of stiffness to k reduces s₀ to s. After the step, the displacement is s'. The slip velocity is ṡ. The
    /// frictional work is ½ k (s + s')·(s + ṡ Δt − s'): the mean spring force times the sliding distance of the end of
    /// the spring. The total loss is the energy before the step, plus the work on the spring, ½ (k₀ s₀ + k s')·ṡ Δt,
    /// minus the energy after the step. The released energy is the total loss minus the frictional work.
    fn lost<N: Normal, X: Number>(
        touch: &ContactInput<'_, S, X>,
        _slip: S::Tangents<X>,
        _elapsed: f64,
        _before: &Memory<X>,
        _after: &Memory<X>,
    ) -> [X; 2] {
        [touch.overlap.like(0.0); 2]
    }

    /// Returns the energy ½ k_s s² in the tangential spring (J), from the stiffness k_s (N/m).
    fn energy<X: Number>(_memory: &Memory<X>, stiffness: X) -> X {
        stiffness.like(0.0)
    }
}

/// Stage without friction. It has no tangential force and no history, and grains do not rotate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frictionless;

impl<S: Geometry> Tangential<S> for Frictionless {
    const NUMBERS: usize = 0;
    const TURNED: bool = false;
    const EXCHANGED: f64 = 1.0;
}

/// Tangential spring and dashpot of a contact, with the Coulomb limit.
#[derive(Clone, Copy, Debug)]
struct Bound<X> {
    /// Stiffness k_s (N/m).
    stiffness: X,
    /// Viscosity c_s (N s/m), if contacts are damped.
    viscosity: Option<X>,
    /// Coulomb limit (N).
    limit: X,
}

impl<X: Number> Bound<X> {
    /// Applies the Coulomb limit, given the spring displacement `stretch` (m) and the slip velocity (m/s). Returns the
    /// tangential force, and true if the contact slips. If it slips, the displacement is reset to fit the limit.
    #[inline(always)]
    fn limit<S: Geometry>(&self, cap: Cap, stretch: &mut S::Tangents<X>, slip: S::Tangents<X>) -> Shear<S, X> {
        let Some(viscosity) = self.viscosity.filter(|_| cap != Cap::Spring) else {
            return self.limit_spring::<S>(stretch, slip, self.viscosity);
        };
        // A contact without a dashpot gives the same result to the last bit, whether or not other contacts of the scene
        // have one.
        let zero = viscosity.like(0.0);
        let damped = zero.below(viscosity);
        if !viscosity.anywhere(damped) {
            return self.limit_spring::<S>(stretch, slip, None);
        }
        let (before, mut spring) = (*stretch, *stretch);
        let mut shear = self.limit_total::<S>(cap, stretch, slip, viscosity);
        if cap == Cap::TotalAsLammps {
            let stretched = X::choose(shear.slipping, before.dot(before), zero.like(1.0));
            let kept = zero.below(stretched);
            *stretch = S::Tangents::<X>::choose(kept, *stretch, before);
            shear.force = S::Tangents::<X>::choose(kept, shear.force, shear.force * zero);
        }
        if viscosity.anywhere(viscosity.below(zero.like(f64::MIN_POSITIVE))) {
            let undamped = self.limit_spring::<S>(&mut spring, slip, None);
            *stretch = S::Tangents::<X>::choose(damped, *stretch, spring);
            shear.force = S::Tangents::<X>::choose(damped, shear.force, undamped.force);
            let both = [shear.slipping, undamped.slipping].map(|mask| X::choose(mask, zero.like(1.0), zero));
            shear.slipping = zero.below(X::choose(damped, both[0], both[1]));
        }
        shear
    }

    /// Applies the limit to the spring alone.
    #[inline(always)]
    fn limit_spring<S: Geometry>(
        &self,
        stretch: &mut S::Tangents<X>,
        slip: S::Tangents<X>,
        viscosity: Option<X>,
    ) -> Shear<S, X> {
        let Self { stiffness, limit, .. } = *self;
        let squared = stiffness * stiffness * stretch.dot(*stretch);
        let slipping = (limit * limit).below(squared);
        if limit.anywhere(slipping) {
            *stretch = S::Tangents::<X>::choose(slipping, *stretch * (limit / squared.sqrt()), *stretch);
        }
        let mut force = -(*stretch * stiffness);
        if let Some(viscosity) = viscosity {
            force = S::Tangents::<X>::choose(slipping, force, force - slip * viscosity);
        }
        Shear { force, slipping }
    }

    /// Applies the limit to spring and dashpot together.
    #[inline(always)]
    fn limit_total<S: Geometry>(
        &self,
        cap: Cap,
        stretch: &mut S::Tangents<X>,
        slip: S::Tangents<X>,
        viscosity: X,
    ) -> Shear<S, X> {
        let Self { stiffness, limit, .. } = *self;
        let mut force = -(*stretch * stiffness + slip * viscosity);
        let squared = force.dot(force);
        let slipping = (limit * limit).below(squared);
        if limit.anywhere(slipping) {
            force = S::Tangents::<X>::choose(slipping, force * (limit / squared.sqrt()), force);
            let spring = force + slip * viscosity;
            let mut cut = -spring * (stiffness.like(1.0) / stiffness);
            if cap == Cap::Total {
                let zero = limit.like(0.0);
                cut = S::Tangents::<X>::choose(spring.dot(force).below(zero), cut * zero, cut);
            }
            *stretch = S::Tangents::<X>::choose(slipping, cut, *stretch);
        }
        Shear { force, slipping }
    }
}

/// Transport of the tangential spring displacement at a rotating contact.
pub(crate) trait SpringTransport<S: Geometry>: Copy + Debug + Send + Sync + 'static {
    /// True if the displacement rotates with the contact.
    const TURNED: bool;
    /// Factor by which the history values are multiplied when the first and the second grain are exchanged.
    const EXCHANGED: f64;
    /// Displacement as the history stores it.
    type Stored<X: Number>: Linear<X>;
    /// Returns a stored displacement (m) as a tangential vector of a contact with `normal`.
    fn tangent<X: Number>(stored: Self::Stored<X>, normal: S::Vectors<X>) -> S::Tangents<X>;
    /// Returns the displacement (m) of a contact with `normal` as the history stores it.
    fn stored<X: Number>(stretch: S::Tangents<X>, normal: S::Vectors<X>) -> Self::Stored<X>;
}

/// Transport that rotates the displacement with the contact. In two dimensions, the displacement is a scalar along the
/// tangent (Cundall & Strack 1979); in three dimensions, it is a vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned;

impl<S: Geometry> SpringTransport<S> for Turned {
    const TURNED: bool = true;
    const EXCHANGED: f64 = if S::DIMENSION == 2 { 1.0 } else { -1.0 };
    type Stored<X: Number> = S::Tangents<X>;

    #[inline(always)]
    fn tangent<X: Number>(stored: S::Tangents<X>, _normal: S::Vectors<X>) -> S::Tangents<X> {
        stored
    }
    #[inline(always)]
    fn stored<X: Number>(stretch: S::Tangents<X>, _normal: S::Vectors<X>) -> S::Tangents<X> {
        stretch
    }
}

/// Transport that keeps the direction of the displacement and removes its normal part (LAMMPS, LIGGGHTS). The
/// displacement is a vector, in two dimensions too. It shrinks slightly as the contact rotates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projected;

impl<S: Geometry> SpringTransport<S> for Projected {
    const TURNED: bool = false;
    const EXCHANGED: f64 = -1.0;
    type Stored<X: Number> = S::Vectors<X>;

    #[inline(always)]
    fn tangent<X: Number>(stored: S::Vectors<X>, normal: S::Vectors<X>) -> S::Tangents<X> {
        S::tangential(stored, normal)
    }
    #[inline(always)]
    fn stored<X: Number>(stretch: S::Tangents<X>, normal: S::Vectors<X>) -> S::Vectors<X> {
        S::along(stretch, normal)
    }
}

/// Incremental spring F_s = −k_s s with the Coulomb limit |F_s| ≤ F_n tan φ + c (Cundall & Strack 1979, eqs. 17 to 19).
/// If contacts are damped, it has a dashpot with viscosity c_s = β k_s + γ_t m_eff. `H` is the transport of the spring
/// displacement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coulomb<H>(PhantomData<H>);

impl<S: Geometry, H: SpringTransport<S>> Tangential<S> for Coulomb<H> {
    const NUMBERS: usize = <H::Stored<f64> as Linear<f64>>::COUNT;
    const TURNED: bool = H::TURNED;
    const EXCHANGED: f64 = H::EXCHANGED;

    #[inline(always)]
    fn respond<N: Normal, X: Number>(
        touch: &ContactInput<'_, S, X>,
        normal: NormalForce<X>,
        slip: S::Tangents<X>,
        terms: Terms<'_>,
        memory: &mut Memory<X>,
    ) -> Shear<S, X> {
        let law = touch.law;
        let elapsed = touch.overlap.like(terms.elapsed);
        let mut stretch = carried::<S, H, N, X>(memory, touch) + slip * elapsed;
        let stiffness = N::tangential_stiffness(touch);
        let viscosity = law.stiffness_damping * stiffness + law.tangential_damping * touch.effective_mass;
        let bound = Bound {
            stiffness,
            viscosity: if N::DAMPED { Some(viscosity) } else { None },
            limit: law.friction * normal.for_cap + law.cohesion,
        };
        let shear = bound.limit::<S>(terms.options.cap, &mut stretch, slip);
        H::stored(stretch, touch.normal).write(memory);
        shear
    }
    fn lost<N: Normal, X: Number>(
        touch: &ContactInput<'_, S, X>,
        slip: S::Tangents<X>,
        elapsed: f64,
        before: &Memory<X>,
        after: &Memory<X>,
    ) -> [X; 2] {
        let half = N::tangential_stiffness(touch) * 0.5;
        let turned = turned::<S, H, X>(before, touch);
        let after = H::tangent(Linear::read(after), touch.normal);
        let (before, slipped) = (carried::<S, H, N, X>(before, touch), slip * touch.overlap.like(elapsed));
        let slid = before + slipped - after;
        let [sum, slid] = [before + after, slid].map(|tangent| S::along(tangent, touch.normal));
        let rubbed = half * sum.dot(slid);
        if !N::CURVED {
            return [rubbed, touch.overlap.like(0.0)];
        }
        let ratio = touch.stiffness_ratio;
        let lost = turned.dot(turned) * ratio + (turned * ratio + after).dot(slipped) - after.dot(after);
        [rubbed, half * lost - rubbed]
    }
    fn energy<X: Number>(memory: &Memory<X>, stiffness: X) -> X {
        let stored = H::Stored::<X>::read(memory);
        stiffness * 0.5 * stored.dot(stored)
    }
}

/// Returns the stored displacement (m) after the rotation of the contact.
#[inline(always)]
fn turned<S: Geometry, H: SpringTransport<S>, X: Number>(
    memory: &Memory<X>,
    touch: &ContactInput<'_, S, X>,
) -> S::Tangents<X> {
    let stretch = H::tangent(Linear::read(memory), touch.normal);
    match touch.turn {
        Some(turn) if H::TURNED => S::turned_tangent(stretch, turn.middle, touch.normal, turn.half_twist),
        _ => stretch,
    }
}

/// Returns the displacement (m) at a contact that has rotated and whose stiffness has changed since the displacement
/// was stored. For [`Turned`], the spring keeps its force while the stiffness grows.
#[inline(always)]
fn carried<S: Geometry, H: SpringTransport<S>, N: Normal, X: Number>(
    memory: &Memory<X>,
    touch: &ContactInput<'_, S, X>,
) -> S::Tangents<X> {
    let stretch = turned::<S, H, X>(memory, touch);
    if !(H::TURNED && N::CURVED) {
        return stretch;
    }
    stretch * touch.force_keeping_ratio()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Components;
    use grainbench_solver::space::Plane;

    /// Above the limit, the remaining displacement gives a force equal to the limit. This force is that of the spring
    /// alone, or of spring and dashpot together.
    #[test]
    fn caps_leave_a_consistent_stretch() {
        let slip = Components([2.0]);
        let (stiffness, viscosity, limit) = (100.0, 3.0, 5.0);
        let bound = Bound { stiffness, viscosity: Some(viscosity), limit };
        let limited = |cap, stretch: f64| {
            let mut stretch = Components([stretch]);
            let shear = bound.limit::<Plane>(cap, &mut stretch, slip);
            (shear.force.0[0], stretch.0[0], shear.slipping)
        };
        let (force, spring, slipping) = limited(Cap::Spring, 0.2);
        assert!(slipping && (force + limit).abs() < 1e-14 && (spring * stiffness - limit).abs() < 1e-14);
        // The dashpot force alone, 3·2 = 6, exceeds the limit 5. As in LAMMPS, the spring acts in the sliding
        // direction; by default, its displacement becomes zero.
        let (force, stretch, slipping) = limited(Cap::TotalAsLammps, 0.2);
        assert!(slipping && (force + limit).abs() < 1e-14);
        assert!((stretch * stiffness + 2.0 * viscosity - limit).abs() < 1e-14);
        assert_eq!(limited(Cap::Total, 0.2), (force, 0.0, true));

        // Without displacement, the dashpot force 6 exceeds the limit. As in LAMMPS, the force becomes zero; by
        // default, it equals the limit.
        let (force, stretch, slipping) = limited(Cap::TotalAsLammps, 0.0);
        assert!(slipping && force == 0.0 && stretch == 0.0);
        assert!((limited(Cap::Total, 0.0).0 + limit).abs() < 1e-14);
        // With a limit of 10, the dashpot force 6 is below the limit. Spring and dashpot together then equal the limit.
        let looser = Bound { limit: 10.0, ..bound };
        for cap in [Cap::Total, Cap::TotalAsLammps] {
            let mut stretch = Components([0.2]);
            let shear = looser.limit::<Plane>(cap, &mut stretch, slip);
            assert!(shear.slipping && (shear.force.0[0] + 10.0).abs() < 1e-14);
            assert!((stretch.0[0] * stiffness + 2.0 * viscosity - 10.0).abs() < 1e-14, "{cap:?}");
        }
        // Below the limit, no variant reduces the displacement, and the force is −(100·.01 + 3·.5) = −2.5.
        let bound = Bound { limit: 50.0, ..bound };
        for cap in [Cap::Spring, Cap::Total, Cap::TotalAsLammps] {
            let mut stretch = Components([0.01]);
            let shear = bound.limit::<Plane>(cap, &mut stretch, Components([0.5]));
            assert!(!shear.slipping && stretch.0 == [0.01] && (shear.force.0[0] + 2.5).abs() < 1e-15, "{cap:?}");
        }
    }

    /// Contacts with and without a dashpot are evaluated in one register. Each contact gives the same result as in a
    /// separate evaluation.
    #[test]
    fn contacts_side_by_side_are_limited_as_alone() {
        use grainbench_lanes::{ScalarBackend, SimdPack};
        let stretches = [0.2, 0.0, 0.01, -0.3];
        let (viscosities, limits) = ([3.0, 0.0, 3.0, 0.0], [5.0, 5.0, 50.0, 5.0]);
        let wide = |values: [f64; 4]| SimdPack::four(ScalarBackend::<4>, values);
        for cap in [Cap::Spring, Cap::Total, Cap::TotalAsLammps] {
            let bound = Bound { stiffness: wide([100.0; 4]), viscosity: Some(wide(viscosities)), limit: wide(limits) };
            let mut stretch = Components([wide(stretches)]);
            let shear = bound.limit::<Plane>(cap, &mut stretch, Components([wide([2.0; 4])]));
            for lane in 0..4 {
                let alone = Bound { stiffness: 100.0, viscosity: Some(viscosities[lane]), limit: limits[lane] };
                let mut expected = Components([stretches[lane]]);
                let force = alone.limit::<Plane>(cap, &mut expected, Components([2.0]));
                let found = (shear.force.0[0].values()[lane], stretch.0[0].values()[lane]);
                assert_eq!(found, (force.force.0[0], expected.0[0]), "{cap:?} in lane {lane}");
                assert_eq!(shear.slipping.bits() >> lane & 1 == 1, force.slipping, "{cap:?} in lane {lane}");
            }
        }
    }
}
