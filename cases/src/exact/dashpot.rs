//! What a time step makes of a dashpot.

use std::f64::consts::PI;

/// How much smaller a restitution is, Δe/e over ωΔt, when the dashpot takes the velocity half a step back: v − ½Δt dv/dt is a
/// spring and a dashpot stiffer by the factor 1 + ζωΔt each, a damping ratio ζ larger by the factor 1 + ζωΔt/2, and
/// dln e/dζ = −π/(1 − ζ²)^{3/2} of e = exp(−πζ/√(1 − ζ²)). Source: the damped oscillator.
#[must_use]
pub fn lag(damping_ratio: f64) -> f64 {
    0.5 * PI * damping_ratio * damping_ratio / (1.0 - damping_ratio * damping_ratio).powf(1.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lag_is_what_a_larger_damping_ratio_makes() {
        let restitution = |zeta: f64| (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        let (zeta, phase) = (0.3, 1e-6);
        let larger = restitution(zeta * (1.0 + 0.5 * zeta * phase));
        let lost = (restitution(zeta) - larger) / restitution(zeta) / phase;
        assert!((lost / lag(zeta) - 1.0).abs() < 1e-3, "{lost} of {}", lag(zeta));
    }
}
