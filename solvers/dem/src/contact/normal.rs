//! First stage: the force along the normal, and the stiffness that the other stages build on.

use super::{Options, Touch};
use grainbench_scene::space::Space;

/// Normal force at a contact (N), positive when it pushes apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce {
    /// Of spring and dashpot.
    pub total: f64,
    /// What Coulomb's limit is proportional to.
    pub for_cap: f64,
}

/// The normal stage.
pub trait Normal: Copy + Send + 'static {
    /// Whether dashpots act at contacts, along the tangent too.
    const DAMPED: bool;
    /// Whether the stage reads the effective radius.
    const CURVED: bool;

    /// The normal force.
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce;
    /// Stiffness k_s of the tangential spring (N/m).
    fn tangential_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64;
    /// Secant stiffness F/δ of the normal spring (N/m).
    fn secant_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64;
    /// Energy in the normal spring (J).
    fn energy<S: Space>(touch: &Touch<'_, S>) -> f64;
}

/// Spring and dashpot together.
#[inline(always)]
fn damped<S: Space>(touch: &Touch<'_, S>, options: &Options, spring: f64, viscosity: f64) -> NormalForce {
    let dashpot = viscosity * S::dot(touch.velocity, touch.normal);
    let total = (spring + dashpot).max(options.least_normal_force);
    let signed = spring + options.dashpot_in_cap * (total - spring);
    NormalForce { total, for_cap: signed.max(-signed * options.pull_in_cap) }
}

/// A linear spring, F_n = k_n δ.
#[derive(Clone, Copy, Debug)]
pub struct Spring;

/// What every linear stage answers alike.
macro_rules! linear_stiffness {
    () => {
        #[inline(always)]
        fn tangential_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64 {
            touch.law.springs[1]
        }
        #[inline(always)]
        fn secant_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64 {
            touch.law.springs[0]
        }
        fn energy<S: Space>(touch: &Touch<'_, S>) -> f64 {
            0.5 * touch.law.springs[0] * touch.overlap * touch.overlap
        }
    };
}

impl Normal for Spring {
    const DAMPED: bool = false;
    const CURVED: bool = false;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, _options: &Options) -> NormalForce {
        let spring = touch.law.springs[0] * touch.overlap;
        NormalForce { total: spring, for_cap: spring }
    }
    linear_stiffness!();
}

/// A linear spring and a dashpot, F_n = k_n δ + c_n δ̇ with c_n = β k_n + γ_n m_eff (Cundall & Strack 1979, eqs. 26 and
/// 28; LAMMPS and LIGGGHTS write the second term).
#[derive(Clone, Copy, Debug)]
pub struct SpringDashpot;

impl Normal for SpringDashpot {
    const DAMPED: bool = true;
    const CURVED: bool = false;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce {
        let law = touch.law;
        let spring = law.springs[0] * touch.overlap;
        let viscosity = law.stiffness_damping * law.springs[0] + law.normal_damping * touch.effective_mass;
        damped(touch, options, spring, viscosity)
    }
    linear_stiffness!();
}

/// The same with a dashpot that gives a coefficient of restitution e beside the others: c_n = 2ζ√(k_n m_eff) with
/// ζ = −ln e/√(π² + ln² e). Exact when contact ends with the overlap: the damped half-oscillation ends at
/// e = exp(−πζ/√(1 − ζ²)).
#[derive(Clone, Copy, Debug)]
pub struct SpringRestitution;

impl Normal for SpringRestitution {
    const DAMPED: bool = true;
    const CURVED: bool = false;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce {
        let law = touch.law;
        let spring = law.springs[0] * touch.overlap;
        let viscosity = law.stiffness_damping * law.springs[0]
            + law.normal_damping * touch.effective_mass
            + 2.0 * law.damping_ratio * (law.springs[0] * touch.effective_mass).sqrt();
        damped(touch, options, spring, viscosity)
    }
    linear_stiffness!();
}

/// What both Hertz stages answer alike: F_n = (4/3) E* √R* δ^{3/2}, Mindlin's k_s = 8 G* √(R* δ), energy (2/5) F_n δ
/// (Johnson, Contact Mechanics, 1985, eqs. 4.23 and 7.43).
macro_rules! hertz_stiffness {
    () => {
        #[inline(always)]
        fn tangential_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64 {
            8.0 * touch.law.springs[1] * (touch.effective_radius * touch.overlap).sqrt()
        }
        #[inline(always)]
        fn secant_stiffness<S: Space>(touch: &Touch<'_, S>) -> f64 {
            4.0 / 3.0 * touch.law.springs[0] * (touch.effective_radius * touch.overlap).sqrt()
        }
        fn energy<S: Space>(touch: &Touch<'_, S>) -> f64 {
            0.4 * Self::secant_stiffness(touch) * touch.overlap * touch.overlap
        }
    };
}

/// Hertz contact of elastic spheres.
#[derive(Clone, Copy, Debug)]
pub struct Hertz;

impl Normal for Hertz {
    const DAMPED: bool = false;
    const CURVED: bool = true;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, _options: &Options) -> NormalForce {
        let spring = Self::secant_stiffness(touch) * touch.overlap;
        NormalForce { total: spring, for_cap: spring }
    }
    hertz_stiffness!();
}

/// Hertz contact with dashpots: c_n = γ_n m_eff + 2√(5/6) ζ √(S m_eff), S = dF/dδ = 2E*√(R*δ), whose second term gives
/// the coefficient of restitution e exactly when contact ends with the overlap (Tsuji, Tanaka & Ishida 1992; Antypov &
/// Elliott 2011 show that it maps onto a damped harmonic oscillator).
#[derive(Clone, Copy, Debug)]
pub struct HertzDashpot;

impl Normal for HertzDashpot {
    const DAMPED: bool = true;
    const CURVED: bool = true;

    #[inline(always)]
    fn force<S: Space>(touch: &Touch<'_, S>, options: &Options) -> NormalForce {
        let law = touch.law;
        let secant = Self::secant_stiffness(touch);
        let tangent = 1.5 * secant;
        let viscosity = law.normal_damping * touch.effective_mass
            + 2.0 * law.damping_ratio * (5.0 / 6.0 * tangent * touch.effective_mass).sqrt();
        damped(touch, options, secant * touch.overlap, viscosity)
    }
    hertz_stiffness!();
}
