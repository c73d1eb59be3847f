//! Third stage: the moment against rolling, with what the contact must remember for it.

use super::Touch;
use super::normal::{Normal, NormalForce};
use grainbench_scene::space::Space;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// The rolling stage.
pub trait Rolling<S: Space>: Copy + Send + 'static {
    /// Whether there is a moment at all.
    const ACTIVE: bool;
    /// What a contact remembers from step to step.
    type History: Copy + Debug + Default + Send + Serialize + DeserializeOwned;

    /// Moment on the first body (N m), from the angular velocity of the first body relative to the second (rad/s), the
    /// time that has passed since the last one (s) and the moment of inertia of the pair about the contact (kg m²).
    fn moment<N: Normal>(
        touch: &Touch<'_, S>,
        normal: NormalForce,
        rate: S::Spin,
        elapsed: f64,
        inertia: f64,
        history: &mut Self::History,
    ) -> S::Spin;
    /// The history with the roles of first and second grain exchanged.
    fn exchange(history: Self::History) -> Self::History;
    /// Energy in the rolling spring (J).
    fn energy<N: Normal>(touch: &Touch<'_, S>, history: Self::History) -> f64;
}

/// No rolling resistance: no history, no moment.
#[derive(Clone, Copy, Debug)]
pub struct FreeRolling;

impl<S: Space> Rolling<S> for FreeRolling {
    const ACTIVE: bool = false;
    type History = ();

    #[inline(always)]
    fn moment<N: Normal>(
        _touch: &Touch<'_, S>,
        _normal: NormalForce,
        _rate: S::Spin,
        _elapsed: f64,
        _inertia: f64,
        _history: &mut (),
    ) -> S::Spin {
        S::NO_SPIN
    }
    fn exchange((): ()) {}
    fn energy<N: Normal>(_touch: &Touch<'_, S>, (): ()) -> f64 {
        0.0
    }
}

/// An elastic-plastic spring and a dashpot against rolling (Ai, Chen, Rotter & Ooi 2011, model C; LIGGGHTS `epsd`):
///
/// ```text
/// M = −k_r θ − C ω      |k_r θ| ≤ μ_r R_eff F_n      k_r = 2.25 k_n μ_r² R_eff²      C = 2η_r √(I_r k_r)
/// ```
///
/// θ is the rolling angle, cut back when the spring yields; the dashpot acts only while it has not. The part of the
/// relative spin along the normal is twisting, not rolling, and exerts nothing.
#[derive(Clone, Copy, Debug)]
pub struct ElasticPlastic;

/// The angle of a rolling spring (rad).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Angle<S: Space>(S::Spin);

impl<S: Space> Default for Angle<S> {
    #[inline(always)]
    fn default() -> Self {
        Self(S::NO_SPIN)
    }
}

impl<S: Space> Rolling<S> for ElasticPlastic {
    const ACTIVE: bool = true;
    type History = Angle<S>;

    #[inline(always)]
    fn moment<N: Normal>(
        touch: &Touch<'_, S>,
        normal: NormalForce,
        rate: S::Spin,
        elapsed: f64,
        inertia: f64,
        history: &mut Angle<S>,
    ) -> S::Spin {
        let law = touch.law;
        let arm = law.rolling_friction * touch.effective_radius;
        if arm == 0.0 {
            return S::NO_SPIN;
        }
        let rate = S::without_twist(rate, touch.normal);
        let stiffness = rolling_stiffness::<S, N>(touch);
        let mut angle = S::without_twist(history.0 + rate * elapsed, touch.normal);
        let limit = arm * normal.for_cap;
        let squared = stiffness * stiffness * S::spin_dot(angle, angle);
        let yields = squared > limit * limit;
        if yields {
            angle = angle * (limit / squared.sqrt());
        }
        history.0 = angle;
        let moment = -(angle * stiffness);
        if yields { moment } else { moment - rate * (2.0 * law.rolling_damping * (inertia * stiffness).sqrt()) }
    }
    fn exchange(history: Angle<S>) -> Angle<S> {
        Angle(-history.0)
    }
    fn energy<N: Normal>(touch: &Touch<'_, S>, history: Angle<S>) -> f64 {
        0.5 * rolling_stiffness::<S, N>(touch) * S::spin_dot(history.0, history.0)
    }
}

/// k_r = 2.25 k_n μ_r² R_eff² (N m/rad), with the secant stiffness where it is not constant.
#[inline(always)]
fn rolling_stiffness<S: Space, N: Normal>(touch: &Touch<'_, S>) -> f64 {
    let arm = touch.law.rolling_friction * touch.effective_radius;
    2.25 * N::secant_stiffness(touch) * arm * arm
}
