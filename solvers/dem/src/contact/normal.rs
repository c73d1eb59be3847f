//! First stage of a contact law. It computes the normal force, and the stiffness that the other stages need.

use super::ContactInput;
use super::options::Options;
use crate::geometry::{Geometry, Linear};
use crate::laws::Constants;
use grainbench_lanes::Number;

/// Normal force at a contact (N); positive if repulsive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NormalForce<X> {
    /// Force of spring and dashpot together.
    pub(crate) total: X,
    /// Normal force to which the Coulomb limit is proportional (N).
    pub(crate) for_cap: X,
}

/// Normal force law of a contact, as a stage of the chain.
pub(crate) trait Normal: Copy + Send + Sync + 'static {
    /// True if contacts have dashpots, normal or tangential.
    const DAMPED: bool;
    /// True if the law uses the effective radius. Its tangential stiffness then changes with the overlap.
    const CURVED: bool;

    fn force<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>, options: &Options) -> NormalForce<X>;
    /// Returns the stiffness k_s of the tangential spring (N/m).
    fn tangential_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X;
    /// Returns the secant stiffness F/δ of the normal spring (N/m).
    fn secant_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X;
    /// Returns the energy in the normal spring (J).
    fn energy<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X;
}

/// Returns the normal force for a spring force (N) and a dashpot constant (N s/m).
#[inline(always)]
fn damped<S: Geometry, X: Number>(
    touch: &ContactInput<'_, S, X>,
    options: &Options,
    spring: X,
    viscosity: X,
) -> NormalForce<X> {
    let dashpot = viscosity * touch.velocity.dot(touch.velocity_normal);
    let total = (spring + dashpot).at_least(spring.like(options.least_normal_force));
    let signed = spring + (total - spring) * options.dashpot_in_cap;
    NormalForce { total, for_cap: signed.at_least(-signed * options.pull_in_cap) }
}

/// Returns the viscosity 2ζ√(k m) (N s/m) with the damping ratio ζ. `stiff_mass` is the product k m of stiffness and
/// effective mass (N kg/m). If ζ is zero for all contacts, no square root is computed.
#[inline(always)]
fn restitution<X: Number>(law: &Constants<X>, stiff_mass: X) -> X {
    let zero = stiff_mass.like(0.0);
    if stiff_mass.anywhere(zero.below(law.damping_ratio)) { law.damping_ratio * 2.0 * stiff_mass.sqrt() } else { zero }
}

/// Linear spring, F_n = k_n δ, with stiffness k_n (N/m) and overlap δ (m).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring;

/// Stiffnesses and energy of both linear stages.
macro_rules! linear_stiffness {
    () => {
        #[inline(always)]
        fn tangential_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            touch.law.springs[1]
        }
        #[inline(always)]
        fn secant_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            touch.law.springs[0]
        }
        fn energy<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            touch.law.springs[0] * 0.5 * touch.overlap * touch.overlap
        }
    };
}

impl Normal for Spring {
    const DAMPED: bool = false;
    const CURVED: bool = false;

    #[inline(always)]
    fn force<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>, _options: &Options) -> NormalForce<X> {
        let spring = touch.law.springs[0] * touch.overlap;
        NormalForce { total: spring, for_cap: spring }
    }
    linear_stiffness!();
}

/// Linear spring and dashpots, F_n = k_n δ + c_n δ̇ with c_n = β k_n + γ_n m_eff + 2ζ√(k_n m_eff). Here δ is the
/// overlap and m_eff the effective mass; [`Constants`] explains k_n, β, γ_n and ζ.
///
/// The first term of c_n is the contact damping of Cundall & Strack (1979). LAMMPS and LIGGGHTS use the second. The third
/// term gives a coefficient of restitution e. If the contact ends when the overlap is zero, the damped half-oscillation
/// ends with e = exp(−πζ/√(1 − ζ²)), so ζ = −ln e/√(π² + ln² e). If it ends when the force is zero, as in `dem`, e =
/// exp(−2ζ acos ζ/√(1 − ζ²)), which [`damping_ratio`](crate::laws::damping_ratio) inverts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpringDashpot;

impl Normal for SpringDashpot {
    const DAMPED: bool = true;
    const CURVED: bool = false;

    #[inline(always)]
    fn force<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>, options: &Options) -> NormalForce<X> {
        let law = touch.law;
        let spring = law.springs[0] * touch.overlap;
        let viscosity = law.stiffness_damping * law.springs[0] + law.normal_damping * touch.effective_mass;
        damped(touch, options, spring, viscosity + restitution(law, law.springs[0] * touch.effective_mass))
    }
    linear_stiffness!();
}

/// Stiffnesses and energy of both Hertz stages: F_n = (4/3) E* √R* δ^{3/2}, Mindlin's k_s = 8 G* √(R* δ), energy (2/5)
/// F_n δ (Johnson, Contact Mechanics, 1985, eqs. 4.23 and 7.43).
macro_rules! hertz_stiffness {
    () => {
        #[inline(always)]
        fn tangential_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            touch.law.springs[1] * 8.0 * (touch.effective_radius * touch.overlap).sqrt()
        }
        #[inline(always)]
        fn secant_stiffness<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            touch.law.springs[0] * (4.0 / 3.0) * (touch.effective_radius * touch.overlap).sqrt()
        }
        fn energy<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>) -> X {
            Self::secant_stiffness(touch) * 0.4 * touch.overlap * touch.overlap
        }
    };
}

/// Hertz contact of elastic spheres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hertz;

impl Normal for Hertz {
    const DAMPED: bool = false;
    const CURVED: bool = true;

    #[inline(always)]
    fn force<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>, _options: &Options) -> NormalForce<X> {
        let spring = Self::secant_stiffness(touch) * touch.overlap;
        NormalForce { total: spring, for_cap: spring }
    }
    hertz_stiffness!();
}

/// Hertz contact with dashpots: c_n = γ_n m_eff + 2√(5/6) ζ √(S m_eff), S = dF/dδ = 2E*√(R*δ). The second term gives
/// exactly the coefficient of restitution e, with ζ as in a linear contact (Tsuji, Tanaka & Ishida 1992). Antypov &
/// Elliott (2011) map the contact to a damped harmonic oscillator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HertzDashpot;

impl Normal for HertzDashpot {
    const DAMPED: bool = true;
    const CURVED: bool = true;

    #[inline(always)]
    fn force<S: Geometry, X: Number>(touch: &ContactInput<'_, S, X>, options: &Options) -> NormalForce<X> {
        let law = touch.law;
        let secant = Self::secant_stiffness(touch);
        let tangent = secant * 1.5;
        let viscosity =
            law.normal_damping * touch.effective_mass + restitution(law, tangent * (5.0 / 6.0) * touch.effective_mass);
        damped(touch, options, secant * touch.overlap, viscosity)
    }
    hertz_stiffness!();
}
