//! Third stage of a contact law. It computes the moment of rolling resistance and updates its contact history.

use super::ContactInput;
use super::normal::{Normal, NormalForce};
use super::tangential::Tangential;
use crate::geometry::{Geometry, Linear};
use grainbench_lanes::Number;

/// Rolling resistance of a contact, as a stage of the chain. The provided functions are those of a stage without moment.
pub(crate) trait Rolling<S: Geometry>: Copy + Send + Sync + 'static {
    /// Number of history values. They change sign when the first and the second grain are exchanged.
    const NUMBERS: usize;
    /// True if the stage exerts a moment.
    const ACTIVE: bool = Self::NUMBERS > 0;

    /// Returns the moment on the first body (N m), and updates the contact history. `rate` is the angular velocity
    /// relative to the second body (rad/s), `elapsed` the time since the last evaluation (s), and `inertia` the moment of
    /// inertia of the pair about the contact (kg m²).
    #[inline(always)]
    fn moment<N: Normal, T: Tangential<S>, X: Number>(
        touch: &ContactInput<'_, S, X>,
        _normal: NormalForce<X>,
        _rate: S::Spins<X>,
        _elapsed: f64,
        _inertia: X,
        _memory: &mut [X],
    ) -> S::Spins<X> {
        S::spin([touch.overlap.like(0.0); 4])
    }
    /// Returns the energy in the rolling spring (J).
    fn energy<N: Normal, X: Number>(touch: &ContactInput<'_, S, X>, _memory: &[X]) -> X {
        touch.overlap.like(0.0)
    }
}

/// Stage without rolling resistance. It has no history and no moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeRolling;

impl<S: Geometry> Rolling<S> for FreeRolling {
    const NUMBERS: usize = 0;
}

/// Elastic-plastic spring and dashpot against rolling (Ai, Chen, Rotter & Ooi 2011, model C; LIGGGHTS `epsd`):
///
/// ```text
/// M = −k_r θ − C ω      |k_r θ| ≤ μ_r R_eff F_n      k_r = 2.25 k_n μ_r² R_eff²      C = 2η_r √(I_r k_r)
/// ```
///
/// M is the moment, θ the rolling angle, ω the rolling velocity, and I_r the moment of inertia of the pair about the
/// contact. F_n is the normal force of the Coulomb limit. The angle is reduced when the spring yields, and the dashpot
/// does not act while the spring yields. The normal part of the relative spin is twisting, not rolling, and causes no
/// moment. The factor 2.25 holds for spheres. Ai et al. give 3 for discs; like LIGGGHTS, this stage uses 2.25 for both.
///
/// Ai et al. and LIGGGHTS sum the increments −k_r ω Δt of the moment, so that the moment does not change with k_r. In a
/// Hertz contact, this can yield work in a closed cycle. For [`History::Turned`](crate::convention::History::Turned), the
/// spring keeps its moment only while k_r grows, and its angle while k_r decreases.
///
/// The history is the rolling angle θ (rad).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElasticPlastic;

impl<S: Geometry> Rolling<S> for ElasticPlastic {
    const NUMBERS: usize = <S::Spins<f64> as Linear<f64>>::COUNT;

    #[inline(always)]
    fn moment<N: Normal, T: Tangential<S>, X: Number>(
        touch: &ContactInput<'_, S, X>,
        normal: NormalForce<X>,
        rate: S::Spins<X>,
        elapsed: f64,
        inertia: X,
        memory: &mut [X],
    ) -> S::Spins<X> {
        let law = touch.law;
        let arm = law.rolling_friction * touch.effective_radius;
        let zero = arm.like(0.0);
        let rate = S::rolled(rate, touch.normal);
        let stiffness = rolling_stiffness::<S, N, X>(touch);
        let mut angle = S::Spins::<X>::read(memory);
        if let Some(turn) = touch.turn {
            angle = S::turned_spin(angle, turn.middle, touch.normal, turn.half_twist);
        }
        if N::CURVED {
            angle = angle * if T::TURNED { touch.force_keeping_ratio() } else { touch.stiffness_ratio };
        }
        angle = S::rolled(angle + rate * arm.like(elapsed), touch.normal);
        let limit = arm * normal.for_cap;
        let squared = stiffness * stiffness * angle.dot(angle);
        let yields = (limit * limit).below(squared);
        if arm.anywhere(yields) {
            angle = S::Spins::<X>::choose(yields, angle * (limit / squared.sqrt()), angle);
        }
        let spring = -(angle * stiffness);
        let dashpot = rate * (law.rolling_damping * 2.0 * (inertia * stiffness).sqrt());
        // A contact without rolling resistance stores zero, even if other contacts in the register have resistance.
        let (resists, none) = (zero.below(arm), S::spin([zero; 4]));
        S::Spins::<X>::choose(resists, angle, none).write(memory);
        S::Spins::<X>::choose(resists, S::Spins::<X>::choose(yields, spring, spring - dashpot), none)
    }
    fn energy<N: Normal, X: Number>(touch: &ContactInput<'_, S, X>, memory: &[X]) -> X {
        let angle = S::Spins::<X>::read(memory);
        rolling_stiffness::<S, N, X>(touch) * 0.5 * angle.dot(angle)
    }
}

/// Returns k_r = 2.25 k_n μ_r² R_eff² (N m/rad), with the secant stiffness if k_n is not constant.
#[inline(always)]
fn rolling_stiffness<S: Geometry, N: Normal, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
    let arm = touch.law.rolling_friction * touch.effective_radius;
    N::secant_stiffness(touch) * 2.25 * arm * arm
}
