//! Coefficient of restitution of a contact with a dashpot, and its error due to the time step.

use super::bisection;
use std::f64::consts::PI;

/// Returns the relative decrease of the restitution coefficient e per phase of a step, (Δe/e)/(ωΔt), if the dashpot
/// uses the velocity half a step earlier. The velocity v − ½Δt dv/dt makes spring and dashpot stiffer by the factor 1 +
/// ζωΔt each. The damping ratio ζ is then larger by the factor 1 + ζωΔt/2. With e = exp(−πζ/√(1 − ζ²)), dln e/dζ =
/// −π/(1 − ζ²)^{3/2}. Source: the damped oscillator.
pub(crate) fn lag(damping_ratio: f64) -> f64 {
    0.5 * PI * damping_ratio * damping_ratio / (1.0 - damping_ratio * damping_ratio).powf(1.5)
}

/// Returns the coefficient of restitution of a contact that ends when its force is zero. The oscillator x″ + 2ζ x′ +
/// x = 0 starts with x = 0 and x′ = 1. At t = 2φ/√(1 − ζ²), cos φ = ζ, it has x″ = 0 and −x′ = exp(−ζ t). Above
/// critical damping, acosh ζ and √(ζ² − 1) replace acos ζ and √(1 − ζ²). Source: the damped oscillator (Schwager &
/// Pöschel 2007; Hertz contacts obey it in δ^{5/4}).
pub(crate) fn no_tension_restitution(damping_ratio: f64) -> f64 {
    (-2.0 * damping_ratio * arc(damping_ratio)).exp()
}

/// Returns acos ζ/√(1 − ζ²), or acosh ζ/√(ζ² − 1) above critical damping.
fn arc(damping_ratio: f64) -> f64 {
    let root = (1.0 - damping_ratio * damping_ratio).abs().sqrt();
    if damping_ratio < 1.0 { damping_ratio.acos() / root } else { damping_ratio.acosh() / root }
}

/// Returns the damping ratio that gives a restitution with a release at zero force, by bisection.
pub(crate) fn no_tension_ratio(restitution: f64) -> f64 {
    bisection([0.0, 1.0 / restitution], 80, |ratio| no_tension_restitution(ratio) > restitution)[0]
}

/// Returns [`lag`] for a contact that ends when its force is zero: dln e/dζ = −2 [acos ζ/(1 − ζ²)^{3/2} − ζ/(1 − ζ²)].
pub(crate) fn no_tension_lag(damping_ratio: f64) -> f64 {
    damping_ratio * damping_ratio * (arc(damping_ratio) - damping_ratio) / (1.0 - damping_ratio * damping_ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lag_without_tension_is_what_a_larger_damping_ratio_makes() {
        for zeta in [0.3, 1.4] {
            let phase = 1e-6;
            let larger = no_tension_restitution(zeta * (1.0 + 0.5 * zeta * phase));
            let lost = (no_tension_restitution(zeta) - larger) / no_tension_restitution(zeta) / phase;
            assert!((lost / no_tension_lag(zeta) - 1.0).abs() < 1e-3, "{lost} of {}", no_tension_lag(zeta));
        }
        for restitution in [0.05, 0.5, 0.98] {
            assert!((no_tension_restitution(no_tension_ratio(restitution)) / restitution - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_lag_is_what_a_larger_damping_ratio_makes() {
        let restitution = |zeta: f64| (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        let (zeta, phase) = (0.3, 1e-6);
        let larger = restitution(zeta * (1.0 + 0.5 * zeta * phase));
        let lost = (restitution(zeta) - larger) / restitution(zeta) / phase;
        assert!((lost / lag(zeta) - 1.0).abs() < 1e-3, "{lost} of {}", lag(zeta));
    }
}
