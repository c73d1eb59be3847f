//! A mass on an isotropic spring whose anchor rotates about an axis.

use nalgebra::{Rotation3, Vector3};

/// Returns the position of the mass (m) at a time (s). The mass starts at the anchor with the velocity of the anchor.
///
/// r̈ = −ω²(r − r₀(t)), where r₀ rotates at Ω. With w = x + iy across the axis, w = r₀[a e^{iΩt} + b e^{iωt} + c
/// e^{−iωt}]. Here a = ω²/(ω² − Ω²), b + c = 1 − a and ω(b − c) = Ω(1 − a). The component along the axis is constant.
pub(crate) fn sprung(start: Vector3<f64>, spin: Vector3<f64>, frequency: f64, time: f64) -> Vector3<f64> {
    let rate = spin.norm();
    let axis = spin / rate;
    let along = axis * axis.dot(&start);
    let across = |angle: f64| Rotation3::from_scaled_axis(axis * angle) * (start - along);
    let forced = frequency.powi(2) / (frequency.powi(2) - rate.powi(2));
    let (sum, difference) = (1.0 - forced, rate * (1.0 - forced) / frequency);
    let phase = frequency * time;
    along
        + across(rate * time) * forced
        + across(phase) * (0.5 * (sum + difference))
        + across(-phase) * (0.5 * (sum - difference))
}

/// Returns the error (m) of a second-order scheme for a mass at a distance d (m) from the axis.
///
/// The rotation of the frame gives d (ΩΔt)² (1 + Ωt)². The oscillation on the spring, of amplitude 2 d (Ω/ω)², is
/// multiplied by its phase error ωt (ωΔt)²/24, at most 2.
pub(crate) fn second_order(distance: f64, rate: f64, frequency: f64, [time, step]: [f64; 2]) -> f64 {
    let phase = frequency * time * (frequency * step).powi(2) / 24.0;
    distance * ((rate * step * (1.0 + rate * time)).powi(2) + 2.0 * (rate / frequency).powi(2) * phase.min(2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sprung_mass_obeys_its_equation() {
        let (start, spin, frequency) = (Vector3::new(1.0, -0.4, 0.3), Vector3::new(2.0, 1.0, -2.0), 40.0);
        let (time, step) = (0.31, 1e-5);
        let at = |time: f64| sprung(start, spin, frequency, time);
        let acceleration = (at(time + step) - at(time) * 2.0 + at(time - step)) / (step * step);
        let rest = Rotation3::from_scaled_axis(spin * time) * start;
        assert!((acceleration - (rest - at(time)) * frequency.powi(2)).norm() < 1e-4 * acceleration.norm());
        let speed = (at(step) - at(-step)) / (2.0 * step);
        assert!((speed - spin.cross(&start)).norm() < 1e-6 && (at(0.0) - start).norm() < 1e-15);
    }
}
