//! Damping ratio of a contact that ends when its normal force returns to zero.

use std::f64::consts::PI;

/// Returns the damping ratio ζ of a contact that ends when F_n = 0. The argument `pulling` is the damping ratio of a
/// contact that has the same coefficient of restitution e but ends when the overlap is zero. For that contact, e =
/// exp(−π ζ/√(1 − ζ²)) with ζ = `pulling`.
///
/// In the contact that ends when F_n = 0, the damped oscillation x'' + 2ζ x' + x = 0 starts from x = 0, x' = 1. Its
/// force vanishes when x'' = 0, at t = 2φ/√(1 − ζ²) with cos φ = ζ. At this time, x' = −e with
///
/// ```text
/// e = exp(−2ζ acos ζ/√(1 − ζ²))   below critical damping, e⁻² at it, exp(−2ζ acosh ζ/√(ζ² − 1)) above it.
/// ```
///
/// Hertz contacts with the dashpot of Tsuji, Tanaka & Ishida (1992) have the same function e(ζ) in both cases. With y =
/// δ^{5/4} instead of δ, their motion v dv/dy is that of a linear oscillator (Antypov & Elliott, EPL 94 (2011) 50004).
/// The forces of the contact and of the oscillator vanish at the same point.
#[must_use]
pub fn no_tension_ratio(pulling: f64) -> f64 {
    if pulling <= 0.0 {
        return pulling;
    }
    let log = PI * pulling / (1.0 - pulling * pulling).sqrt();
    let (mut low, mut high) = (0.0, 1.0 + libm::exp(0.5 * log));
    // Bisection to the last bit.
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if log_of_restitution(middle) < log { low = middle } else { high = middle }
    }
}

/// Returns −ln e for a damping ratio ζ = `ratio` if the contact ends when F_n = 0.
fn log_of_restitution(ratio: f64) -> f64 {
    let beside = 1.0 - ratio;
    let arc = if beside.abs() < 1e-4 {
        // acos ζ/√(1 − ζ²) = 1 + (1 − ζ)/3 + 2 (1 − ζ)²/15 + … on both sides of ζ = 1.
        1.0 + beside / 3.0 + 2.0 / 15.0 * beside * beside
    } else if beside > 0.0 {
        libm::acos(ratio) / (1.0 - ratio * ratio).sqrt()
    } else {
        libm::acosh(ratio) / (ratio * ratio - 1.0).sqrt()
    };
    2.0 * ratio * arc
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest rebound speed after an impact with speed 1 equals e, for damping below, at and above the critical
    /// one. The fourth-order Runge-Kutta method integrates the oscillation.
    #[test]
    fn the_rebound_is_fastest_where_the_force_vanishes() {
        for ratio in [0.05, 0.2, 0.7, 0.99999, 1.0, 1.00001, 1.5, 4.0] {
            let step = 1e-4;
            let force = |[x, v]: [f64; 2]| [v, -x - 2.0 * ratio * v];
            let (mut state, mut fastest) = ([0.0, 1.0], 0.0_f64);
            for _ in 0..80_000 {
                let at = |slope: [f64; 2], part: f64| [state[0] + part * slope[0], state[1] + part * slope[1]];
                let one = force(state);
                let two = force(at(one, 0.5 * step));
                let three = force(at(two, 0.5 * step));
                let four = force(at(three, step));
                let mean = [0, 1].map(|axis| (one[axis] + 2.0 * (two[axis] + three[axis]) + four[axis]) / 6.0);
                state = at(mean, step);
                fastest = fastest.max(-state[1]);
            }
            let expected = libm::exp(-log_of_restitution(ratio));
            assert!((fastest - expected).abs() < 1e-8, "{ratio}: {fastest} and {expected}");
        }
    }

    #[test]
    fn both_releases_have_the_same_restitution() {
        for restitution in [0.999, 0.9, 0.5, 0.1353, 0.1, 0.01] {
            let log = -libm::log(restitution);
            let pulling = log / (PI * PI + log * log).sqrt();
            let found = libm::exp(-log_of_restitution(no_tension_ratio(pulling)));
            assert!((found - restitution).abs() < 1e-12, "{restitution}: {found}");
        }
        assert_eq!(no_tension_ratio(0.0), 0.0);
    }
}
