//! Reduction of snapshots to the columns and digits that a scene chooses.

use crate::record::{GrainState, Snapshot};
use crate::virial;
use grainbench_scene::columns::{Chosen, Columns};
use nalgebra::Vector3;

/// Reduces a snapshot to the chosen columns, adds virials computed from its contacts, and rounds its numbers. An
/// omitted spin is NaN, and other omitted columns are absent.
pub fn reduce(snapshot: &mut Snapshot, columns: &Columns) {
    if *columns == Columns::default() {
        return;
    }
    if columns.has(Chosen::Virial)
        && let Some(virials) = virial::virials(snapshot)
    {
        snapshot.grains.iter_mut().zip(virials).for_each(|(grain, virial)| grain.virial = Some(Box::new(virial)));
    }
    if !columns.has(Chosen::Contacts) {
        snapshot.contacts = None;
    }
    let keep_bits = columns.digits.map(bits);
    for grain in &mut snapshot.grains {
        omit(grain, columns);
        if let Some(bits) = keep_bits {
            round_grain(grain, bits);
        }
    }
    if let Some(bits) = keep_bits {
        for contact in snapshot.contacts.iter_mut().flatten() {
            let vectors = [&mut contact.point, &mut contact.normal, &mut contact.shear_force];
            let numbers = vectors.into_iter().flatten().chain([&mut contact.overlap, &mut contact.normal_force]);
            numbers.for_each(|number| *number = rounded(*number, bits));
        }
    }
}

fn omit(grain: &mut GrainState, columns: &Columns) {
    if !columns.has(Chosen::Spin) {
        (grain.spin, grain.angle) = (Vector3::repeat(f64::NAN), None);
    }
    if !columns.has(Chosen::Force) {
        (grain.force, grain.torque) = (None, None);
    }
}

fn round_grain(grain: &mut GrainState, bits: u32) {
    let GrainState { position, velocity, spin, angle, force, torque, virial, mean_virial, .. } = grain;
    let vectors = [Some(position), Some(velocity), Some(spin), force.as_mut(), torque.as_mut()];
    let tensors = [virial, mean_virial].map(|tensor| tensor.as_deref_mut());
    let numbers = vectors.into_iter().flatten().flatten().chain(tensors.into_iter().flatten().flatten()).chain(angle);
    numbers.for_each(|number| *number = rounded(*number, bits));
}

/// Returns the number of bits after the leading bit that d = `digits` significant digits need. With this number of
/// bits, the relative rounding error is at most 10⁻ᵈ/2.
fn bits(digits: u8) -> u32 {
    (f64::from(digits) * std::f64::consts::LOG2_10).ceil() as u32
}

/// Rounds a number to the nearest one with `bits` bits after the leading bit. The trailing zeros compress well in a
/// file.
fn rounded(number: f64, bits: u32) -> f64 {
    if bits >= 52 || !number.is_finite() {
        return number;
    }
    let dropped = 52 - bits;
    // A carry into the exponent is right: the next number up is a power of two.
    let half = 1_u64 << (dropped - 1);
    let found = f64::from_bits((number.to_bits() + half) >> dropped << dropped);
    if found.is_finite() { found } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_kept_and_no_more() {
        for digits in 1..=15 {
            let bits = bits(digits);
            let allowed = 0.5 * 10_f64.powi(-i32::from(digits));
            let mut worst = 0.0_f64;
            for at in 1..2000 {
                let number =
                    (f64::from(at) * 0.7).exp2() * (1.0 + 1.0 / f64::from(at)) * if at % 2 == 0 { -1.0 } else { 1.0 };
                if !number.is_finite() {
                    break;
                }
                worst = worst.max((rounded(number, bits) / number - 1.0).abs());
            }
            assert!(worst <= allowed && worst > 0.01 * allowed, "{digits} digits: {worst}");
        }
        assert_eq!(
            [0.0, -0.0, 1.0, -2.5].map(|number: f64| rounded(number, 10).to_bits()),
            [0.0, -0.0, 1.0, -2.5].map(f64::to_bits)
        );
        assert!(rounded(f64::NAN, 10).is_nan() && rounded(f64::MAX, 10).is_finite());
        assert_eq!(rounded(2.0 - f64::EPSILON, 10), 2.0);
    }
}
