//! Tests of products of vectors and tensors in two and three dimensions. The numbers are chosen so that any exchange of
//! components changes a result.

use grainbench_solver::space::{Plane, Solid, Space};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Symmetric tensor in two dimensions, with the components xx, yy, zz, xy.
const FLAT: [f64; 4] = [2.0, 3.0, 5.0, 7.0];
/// Symmetric tensor in three dimensions, with the components xx, yy, zz, xy, yz, zx.
const FULL: [f64; 6] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0];

#[test]
fn a_stress_acts_on_a_direction() {
    assert_eq!(Plane::apply(FLAT, Vector2::new(11.0, 13.0)), Vector2::new(113.0, 116.0));
    assert_eq!(Solid::apply(FULL, Vector3::new(17.0, 19.0, 23.0)), Vector3::new(466.0, 429.0, 545.0));
}

#[test]
fn vectors_make_a_dyad() {
    assert_eq!(Plane::outer(Vector2::new(2.0, 3.0), Vector2::new(5.0, 7.0)), Matrix2::new(10.0, 14.0, 15.0, 21.0));
    assert_eq!(
        Solid::outer(Vector3::new(2.0, 3.0, 5.0), Vector3::new(7.0, 11.0, 13.0)),
        Matrix3::new(14.0, 22.0, 26.0, 21.0, 33.0, 39.0, 35.0, 55.0, 65.0)
    );
}

/// In products of two symmetric tensors, shear components count twice.
#[test]
fn invariants_and_works() {
    assert_eq!((Plane::trace(FLAT), Solid::trace(FULL)), (10.0, 10.0));
    assert_eq!(Plane::norm_squared(FLAT), 4.0 + 9.0 + 25.0 + 2.0 * 49.0);
    assert_eq!(Solid::norm_squared(FULL), 38.0 + 2.0 * (49.0 + 121.0 + 169.0));
    assert_eq!(Plane::double_dot(FLAT, [1.0, 10.0, 100.0, 1000.0]), 2.0 + 30.0 + 500.0 + 14_000.0);
    let other = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5];
    assert_eq!(Solid::double_dot(FULL, other), 2.0 + 30.0 + 500.0 + 14e3 + 22e4 + 26e5);
    assert_eq!(Plane::determinant(Matrix2::new(2.0, 3.0, 5.0, 11.0)), 7.0);
    // F = ((2, 3), (5, 7)) gives F Fᵀ = ((13, 31), (31, 74)), and 1 out of the plane.
    assert_eq!(Plane::finger(Matrix2::new(2.0, 3.0, 5.0, 7.0)), [13.0, 74.0, 1.0, 31.0]);
    assert_eq!(Plane::symmetric_part(Matrix2::new(2.0, 3.0, 6.0, 5.0)), [2.0, 5.0, 0.0, 4.5]);
}

/// The rotation angle θ of an increment with spin w = (L₂₁ − L₁₂)/2 satisfies tan(θ/2) = w/2. For w = 2 it is a quarter
/// turn, which exchanges the axial stresses and changes the sign of the shear stress.
#[test]
fn a_quarter_turn_exchanges_the_axes() {
    let turned = Plane::turned(FLAT, Matrix2::new(0.0, -2.0, 2.0, 0.0));
    for (found, expected) in turned.into_iter().zip([3.0, 2.0, 5.0, -7.0]) {
        assert!((found - expected).abs() < 1e-14, "{turned:?}");
    }
}
