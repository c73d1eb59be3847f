//! Second stage: the force along the tangent, a spring and a dashpot under Coulomb's limit.
//!
//! The spring's stretch s (m) is what the contact remembers. It grows by the slip velocity times the time step, and it
//! is carried along with a contact that turns ([`Carrying`]). Coulomb's limit cuts it back ([`Cap`]).

use super::Touch;
use super::normal::{Normal, NormalForce};
use crate::rotation::{Rigid, Rotating, Rotation};
use grainbench_scene::space::{Linear, Space};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::marker::PhantomData;

/// What the tangential stage answers.
#[derive(Clone, Copy, Debug)]
pub struct Shear<S: Space> {
    /// Force F_s on the first body along the tangent (N).
    pub force: S::Tangent,
    /// Whether Coulomb's limit was reached.
    pub slipping: bool,
}

/// The tangential stage.
pub trait Tangential<S: Space>: Copy + Send + 'static {
    /// Whether there is a tangential force at all.
    const ACTIVE: bool;
    /// What a contact remembers from step to step: the stretch of its tangential spring (m).
    type History: Copy + Debug + Default + Send + Serialize + DeserializeOwned;
    /// The rotation of a grain: only tangential forces and rolling moments drive it.
    type Rotation: Rotation<S>;

    /// The tangential force, from the slip velocity (m/s) and the time `elapsed` since the last evaluation (s).
    fn respond<N: Normal>(
        touch: &Touch<'_, S>,
        normal: NormalForce,
        slip: S::Tangent,
        elapsed: f64,
        history: &mut Self::History,
    ) -> Shear<S>;

    /// Work of friction in a step (J), ½ k_s (s + s')·(s + ṡ Δt − s'): the mean force of the spring times the distance
    /// that its end slid. Here s is the stretch before the step, carried to the normal of now, s' the stretch after it,
    /// and ṡ the slip velocity.
    fn rubbed<N: Normal>(
        touch: &Touch<'_, S>,
        slip: S::Tangent,
        elapsed: f64,
        before: Self::History,
        after: Self::History,
    ) -> f64;

    /// The history with the roles of first and second grain exchanged.
    fn exchange(history: Self::History) -> Self::History;
    /// Energy ½ k_s s² in the tangential spring (J), from the stiffness k_s (N/m).
    fn energy(history: Self::History, stiffness: f64) -> f64;
}

/// No friction: no tangential force, no history and no rotation.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

impl<S: Space> Tangential<S> for Frictionless {
    const ACTIVE: bool = false;
    type History = ();
    type Rotation = Rigid;

    #[inline(always)]
    fn respond<N: Normal>(
        _touch: &Touch<'_, S>,
        _normal: NormalForce,
        _slip: S::Tangent,
        _elapsed: f64,
        _history: &mut (),
    ) -> Shear<S> {
        Shear { force: S::NO_TANGENT, slipping: false }
    }
    fn rubbed<N: Normal>(_touch: &Touch<'_, S>, _slip: S::Tangent, _elapsed: f64, (): (), (): ()) -> f64 {
        0.0
    }
    fn exchange((): ()) {}
    fn energy((): (), _stiffness: f64) -> f64 {
        0.0
    }
}

/// How Coulomb's limit is applied to the spring and the dashpot.
pub trait Cap: Copy + Debug + Send + 'static {
    /// The tangential force and whether the contact slips, from the stretch of the spring s (m), the slip velocity
    /// (m/s), the stiffness k_s (N/m), the viscosity c_s (N s/m) and the limit (N). The stretch is cut back when the
    /// contact slips.
    fn limit<S: Space, const DAMPED: bool>(
        stretch: &mut S::Tangent,
        slip: S::Tangent,
        stiffness: f64,
        viscosity: f64,
        limit: f64,
    ) -> Shear<S>;
}

/// The limit acts on the spring; the dashpot is added only while the contact sticks.
#[derive(Clone, Copy, Debug)]
pub struct CapOnSpring;

impl Cap for CapOnSpring {
    #[inline(always)]
    fn limit<S: Space, const DAMPED: bool>(
        stretch: &mut S::Tangent,
        slip: S::Tangent,
        stiffness: f64,
        viscosity: f64,
        limit: f64,
    ) -> Shear<S> {
        let spring_squared = stiffness * stiffness * S::tangent_squared(*stretch);
        let slipping = spring_squared > limit * limit;
        if slipping {
            *stretch = *stretch * (limit / spring_squared.sqrt());
        }
        let mut force = -(*stretch * stiffness);
        if DAMPED && !slipping {
            force -= slip * viscosity;
        }
        Shear { force, slipping }
    }
}

/// The limit acts on spring and dashpot together; the spring is reset so that their sum is the limit (Luding 2008,
/// Granular Matter 10, 235, eq. 22).
#[derive(Clone, Copy, Debug)]
pub struct CapOnTotal;

impl Cap for CapOnTotal {
    #[inline(always)]
    fn limit<S: Space, const DAMPED: bool>(
        stretch: &mut S::Tangent,
        slip: S::Tangent,
        stiffness: f64,
        viscosity: f64,
        limit: f64,
    ) -> Shear<S> {
        // A contact without a dashpot is limited alike, to the last bit, whatever other contacts of the scene have.
        if !DAMPED || viscosity == 0.0 {
            return CapOnSpring::limit::<S, false>(stretch, slip, stiffness, viscosity, limit);
        }
        let mut force = -(*stretch * stiffness + slip * viscosity);
        let squared = S::tangent_squared(force);
        let slipping = squared > limit * limit;
        if slipping {
            force = force * (limit / squared.sqrt());
            *stretch = -(force + slip * viscosity) * (1.0 / stiffness);
        }
        Shear { force, slipping }
    }
}

/// The same, but that a force beyond the limit is dropped where there is no stretch yet: seen of LAMMPS in its evaluation
/// at the start.
#[derive(Clone, Copy, Debug)]
pub struct CapAsLammps;

impl Cap for CapAsLammps {
    #[inline(always)]
    fn limit<S: Space, const DAMPED: bool>(
        stretch: &mut S::Tangent,
        slip: S::Tangent,
        stiffness: f64,
        viscosity: f64,
        limit: f64,
    ) -> Shear<S> {
        let before = *stretch;
        let shear = CapOnTotal::limit::<S, DAMPED>(stretch, slip, stiffness, viscosity, limit);
        if DAMPED && viscosity != 0.0 && shear.slipping && S::tangent_squared(before) == 0.0 {
            *stretch = before;
            return Shear { force: S::NO_TANGENT, ..shear };
        }
        shear
    }
}

/// How the stretch of a tangential spring is carried along with a contact that turns.
pub trait Carrying<S: Space>: Copy + Debug + Send + 'static {
    /// The stretch as it is stored (m).
    type Stored: Linear;
    /// No stretch.
    const NONE: Self::Stored;
    /// The stretch (m) at a contact that has turned to `normal`, from what is stored.
    fn carried(stored: Self::Stored, normal: S::Vector) -> S::Tangent;
    /// What is stored of the stretch (m) at a contact with `normal`.
    fn stored(stretch: S::Tangent, normal: S::Vector) -> Self::Stored;
    /// The stored stretch with the roles of first and second grain exchanged.
    fn exchange(stored: Self::Stored) -> Self::Stored;
    /// Squared length of the stored stretch (m²).
    fn squared(stored: Self::Stored) -> f64;
}

/// The stretch turns with the contact: in the plane it is a scalar along the tangent (Cundall & Strack 1979), in three
/// dimensions its normal part is taken off.
#[derive(Clone, Copy, Debug)]
pub struct Turned;

impl<S: Space> Carrying<S> for Turned {
    type Stored = S::Tangent;
    const NONE: S::Tangent = S::NO_TANGENT;

    #[inline(always)]
    fn carried(stored: S::Tangent, normal: S::Vector) -> S::Tangent {
        S::carry(stored, normal)
    }
    #[inline(always)]
    fn stored(stretch: S::Tangent, _normal: S::Vector) -> S::Tangent {
        stretch
    }
    fn exchange(stored: S::Tangent) -> S::Tangent {
        S::exchange(stored)
    }
    fn squared(stored: S::Tangent) -> f64 {
        S::tangent_squared(stored)
    }
}

/// The stretch is a vector that keeps its direction and loses its normal part, in the plane too (LAMMPS, LIGGGHTS): it
/// shrinks a little as the contact turns.
#[derive(Clone, Copy, Debug)]
pub struct Projected;

impl<S: Space> Carrying<S> for Projected {
    type Stored = S::Vector;
    const NONE: S::Vector = S::ORIGIN;

    #[inline(always)]
    fn carried(stored: S::Vector, normal: S::Vector) -> S::Tangent {
        S::slip_velocity(stored, S::NO_SPIN, normal)
    }
    #[inline(always)]
    fn stored(stretch: S::Tangent, normal: S::Vector) -> S::Vector {
        S::along(stretch, normal)
    }
    fn exchange(stored: S::Vector) -> S::Vector {
        -stored
    }
    fn squared(stored: S::Vector) -> f64 {
        S::dot(stored, stored)
    }
}

/// An incremental spring F_s = −k_s s with Coulomb's limit |F_s| ≤ F_n tan φ + c (Cundall & Strack 1979, eqs. 17 to
/// 19), and a dashpot c_s = β k_s + γ_t m_eff where contacts are damped.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb<C: Cap, H>(PhantomData<(C, H)>);

/// The stretch of a tangential spring (m).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Stretch<S: Space, H: Carrying<S>>(H::Stored);

impl<S: Space, H: Carrying<S>> Default for Stretch<S, H> {
    #[inline(always)]
    fn default() -> Self {
        Self(H::NONE)
    }
}

impl<S: Space, C: Cap, H: Carrying<S>> Tangential<S> for Coulomb<C, H> {
    const ACTIVE: bool = true;
    type History = Stretch<S, H>;
    type Rotation = Rotating<S>;

    #[inline(always)]
    fn respond<N: Normal>(
        touch: &Touch<'_, S>,
        normal: NormalForce,
        slip: S::Tangent,
        elapsed: f64,
        history: &mut Stretch<S, H>,
    ) -> Shear<S> {
        let law = touch.law;
        let mut stretch = H::carried(history.0, touch.normal) + slip * elapsed;
        let limit = law.friction * normal.for_cap + law.cohesion;
        let stiffness = N::tangential_stiffness(touch);
        let shear = if N::DAMPED {
            let viscosity = law.stiffness_damping * stiffness + law.tangential_damping * touch.effective_mass;
            C::limit::<S, true>(&mut stretch, slip, stiffness, viscosity, limit)
        } else {
            C::limit::<S, false>(&mut stretch, slip, stiffness, 0.0, limit)
        };
        history.0 = H::stored(stretch, touch.normal);
        shear
    }
    fn rubbed<N: Normal>(
        touch: &Touch<'_, S>,
        slip: S::Tangent,
        elapsed: f64,
        before: Stretch<S, H>,
        after: Stretch<S, H>,
    ) -> f64 {
        let [before, after] = [before, after].map(|history| H::carried(history.0, touch.normal));
        let slid = before + slip * elapsed - after;
        let [sum, slid] = [before + after, slid].map(|tangent| S::along(tangent, touch.normal));
        0.5 * N::tangential_stiffness(touch) * S::dot(sum, slid)
    }
    fn exchange(history: Stretch<S, H>) -> Stretch<S, H> {
        Stretch(H::exchange(history.0))
    }
    fn energy(history: Stretch<S, H>, stiffness: f64) -> f64 {
        0.5 * stiffness * H::squared(history.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::space::Plane;

    /// Above the limit both conventions leave a stretch that gives the limit: of the spring alone, or of the sum.
    #[test]
    fn caps_leave_a_consistent_stretch() {
        let (slip, stiffness, viscosity, limit) = (2.0, 100.0, 3.0, 5.0);
        let mut spring = 0.2;
        let shear = CapOnSpring::limit::<Plane, true>(&mut spring, slip, stiffness, viscosity, limit);
        assert!(shear.slipping && (shear.force + limit).abs() < 1e-14 && (spring * stiffness - limit).abs() < 1e-14);

        let mut total = 0.2;
        let shear = CapOnTotal::limit::<Plane, true>(&mut total, slip, stiffness, viscosity, limit);
        assert!(shear.slipping && (shear.force + limit).abs() < 1e-14);
        assert!((total * stiffness + slip * viscosity - limit).abs() < 1e-14);
    }

    #[test]
    fn absent_stages_take_no_room() {
        assert_eq!(size_of::<<Frictionless as Tangential<Plane>>::History>(), 0);
        assert_eq!(size_of::<<Frictionless as Tangential<Plane>>::Rotation>(), 0);
    }
}
