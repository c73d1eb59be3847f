//! Invariants of stress and strain rate: friction, pressure, shear, and the angles between their principal axes.
//!
//! In two dimensions the components along z are ignored.

use nalgebra::{DMatrix, Matrix3, SymmetricEigen, Vector3};

/// Principal values in ascending order, with their axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Principal {
    /// Principal values, smallest first.
    pub values: Vec<f64>,
    /// Unit vectors in the order of the values.
    pub axes: Vec<Vector3<f64>>,
}

/// Computes principal values and axes of the symmetric part of a tensor along the first `dimension` axes.
#[must_use]
pub fn principal(tensor: &Matrix3<f64>, dimension: usize) -> Principal {
    let symmetric = tensor.symmetric_part();
    let eigen = SymmetricEigen::new(DMatrix::from_fn(dimension, dimension, |row, column| symmetric[(row, column)]));
    let mut order: Vec<usize> = (0..dimension).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let axis = |number: usize| {
        let eigenvector = eigen.eigenvectors.column(number);
        Vector3::from_fn(|row, _| eigenvector.get(row).copied().unwrap_or(0.0))
    };
    Principal {
        values: order.iter().map(|&number| eigen.eigenvalues[number]).collect(),
        axes: order.iter().map(|&number| axis(number)).collect(),
    }
}

/// Returns the pressure p = −tr T/d (Pa) of a stress T in d dimensions. T is negative in compression.
#[must_use]
pub fn pressure(stress: &Matrix3<f64>, dimension: usize) -> f64 {
    -(0..dimension).map(|axis| stress[(axis, axis)]).sum::<f64>() / dimension as f64
}

/// Returns the deviator A − (tr A/d) 1 of a tensor A in d dimensions.
///
/// For a stress T with pressure p the deviator is T + p 1. Rycroft, Kamrin and Bazant 2009 print p/3 instead of p,
/// which does not remove the trace.
#[must_use]
pub fn deviator(tensor: &Matrix3<f64>, dimension: usize) -> Matrix3<f64> {
    let mut deviator = *tensor;
    let mean = (0..dimension).map(|axis| tensor[(axis, axis)]).sum::<f64>() / dimension as f64;
    (0..dimension).for_each(|axis| deviator[(axis, axis)] -= mean);
    deviator
}

/// Returns the Mohr–Coulomb sin φ = |(λ_max − λ_min)/(λ_max + λ_min)| with the principal stresses λ.
///
/// tan φ is the largest ratio of shear to normal stress on any plane.
#[must_use]
pub fn sine_of_friction(stress: &Matrix3<f64>, dimension: usize) -> f64 {
    let values = principal(stress, dimension).values;
    let (low, high) = (values[0], values[dimension - 1]);
    ((high - low) / (high + low)).abs()
}

/// Returns the Drucker–Prager ratio |T₀|/(√2 p) of a stress with deviator T₀.
#[must_use]
pub fn drucker_prager(stress: &Matrix3<f64>, dimension: usize) -> f64 {
    deviator(stress, dimension).norm() / (2.0_f64.sqrt() * pressure(stress, dimension))
}

/// Angles between the principal axes of a stress and of a strain rate (degrees).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coaxiality {
    /// Angle between the axes of the largest principal values, 0° to 90°.
    pub largest: f64,
    /// Angle between the axes of the smallest principal values, 0° to 90°.
    pub smallest: f64,
    /// Angle in a plane of two axes, from the major principal axis of the stress to that of the strain rate, −90° to
    /// 90°. `None` if one of the two tensors is isotropic in this plane.
    pub in_plane: Option<f64>,
}

/// Returns the angles between the axes of a stress and of a strain rate. `plane` contains the two axes (0 is x) of the
/// plane for the angle `in_plane`.
///
/// Returns `None` if one of the tensors has two equal principal values, because their axes are then undefined.
#[must_use]
pub fn coaxiality(
    stress: &Matrix3<f64>,
    rate: &Matrix3<f64>,
    dimension: usize,
    plane: [usize; 2],
) -> Option<Coaxiality> {
    let [of_stress, of_rate] = [stress, rate].map(|tensor| principal(tensor, dimension));
    for Principal { values, .. } in [&of_stress, &of_rate] {
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        if !values.windows(2).all(|pair| pair[1] - pair[0] > DISTINCT * size) {
            return None;
        }
    }
    let angle = |number: usize| {
        let (a, b) = (of_stress.axes[number], of_rate.axes[number]);
        // An axis has no sign, so the angle is at most 90°. It is computed from the tangent, because a cosine near one
        // is inaccurate.
        a.cross(&b).norm().atan2(a.dot(&b).abs()).to_degrees()
    };
    let in_plane = direction(stress, plane).zip(direction(rate, plane)).map(|(from, to)| {
        let turn = (to - from).to_degrees();
        turn - 180.0 * (turn / 180.0).round()
    });
    Some(Coaxiality { largest: angle(dimension - 1), smallest: angle(0), in_plane })
}

/// Relative difference below which principal values count as equal.
const DISTINCT: f64 = 1e-9;

/// Returns the direction of the major principal axis in the plane of two axes, as the angle from the first axis towards
/// the second (rad). Returns `None` if the tensor is isotropic in this plane.
fn direction(tensor: &Matrix3<f64>, [i, j]: [usize; 2]) -> Option<f64> {
    let (difference, twice) = (tensor[(i, i)] - tensor[(j, j)], tensor[(i, j)] + tensor[(j, i)]);
    let size = tensor[(i, i)].abs().max(tensor[(j, j)].abs()).max(twice.abs());
    (difference.hypot(twice) > DISTINCT * size).then(|| 0.5 * twice.atan2(difference))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(angle: f64, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        let turn = nalgebra::Rotation3::from_axis_angle(&-Vector3::y_axis(), angle).into_inner();
        turn * tensor * turn.transpose()
    }

    fn stress() -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(-1.6, -1.0, -0.4))
    }

    #[test]
    fn friction_by_two_definitions() {
        // sin φ = (1.6 − .4)/(1.6 + .4). The Drucker–Prager ratio is √((.6² + .6²)/2)/1, because the middle stress is
        // the mean.
        assert!((sine_of_friction(&stress(), 3) - 0.6).abs() < 1e-15);
        assert!((drucker_prager(&stress(), 3) - 0.6).abs() < 1e-15);
        for (middle, ratio) in [(-0.7, 0.693_889), (-1.3, 0.567_727)] {
            let stress = Matrix3::from_diagonal(&Vector3::new(-1.6, middle, -0.4));
            assert!((sine_of_friction(&stress, 3) - 0.6).abs() < 1e-15);
            assert!((drucker_prager(&stress, 3) - ratio).abs() < 5e-7);
        }
        // With p/3 instead of p, as printed by Rycroft and others, the deviator would have a trace.
        let stress = Matrix3::from_diagonal(&Vector3::new(-1.6, -0.9, -0.4));
        assert!((drucker_prager(&stress, 3) - 0.624).abs() < 5e-4);
        assert!(deviator(&stress, 3).trace().abs() < 1e-15);
        // In two dimensions sin φ = (3 − 1)/(3 + 1), whatever the stress along z.
        let stress = Matrix3::from_diagonal(&Vector3::new(-3.0, -1.0, 7.0));
        assert_eq!((sine_of_friction(&stress, 2), pressure(&stress, 2)), (0.5, 2.0));
    }

    #[test]
    fn a_turn_from_stress_to_rate_is_told_with_its_sign() {
        for angle in [0.0, 1e-6, 0.3, -0.3, 0.7, -0.7] {
            let rate = turned(angle, &stress());
            let found = coaxiality(&stress(), &rate, 3, [0, 2]).unwrap();
            let degrees = f64::to_degrees(angle);
            assert!((found.largest - degrees.abs()).abs() < 1e-10, "{angle}: {found:?}");
            assert!((found.smallest - degrees.abs()).abs() < 1e-10, "{angle}: {found:?}");
            assert!((found.in_plane.unwrap() - degrees).abs() < 1e-10, "{angle}: {found:?}");
            // An axis rotated by π is the same axis.
            let other = coaxiality(&stress(), &turned(angle + std::f64::consts::PI, &stress()), 3, [0, 2]).unwrap();
            assert!((other.in_plane.unwrap() - degrees).abs() < 1e-9);
        }
        // The axes of the largest values of T and −T are perpendicular to each other.
        let against = coaxiality(&stress(), &-stress(), 3, [0, 2]).unwrap();
        assert!((against.largest - 90.0).abs() < 1e-9 && (against.smallest - 90.0).abs() < 1e-9);
    }

    #[test]
    fn equal_principal_values_have_no_axes() {
        let round = Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, -0.4));
        assert_eq!(coaxiality(&round, &stress(), 3, [0, 2]), None);
        assert_eq!(coaxiality(&stress(), &Matrix3::zeros(), 3, [0, 2]), None);
        assert_eq!(direction(&round, [0, 1]), None);
    }
}
