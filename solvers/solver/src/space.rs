//! Vectors and tensors in two and three dimensions, for solvers that are generic over the dimension.
//!
//! All operations that differ between two and three dimensions are methods of [`Space`]. A generic solver therefore
//! needs only one source.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Index, Mul, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Plane {}
    impl Sealed for super::Solid {}
}

/// Vector operations that solvers need.
pub trait Linear:
    Copy
    + Debug
    + PartialEq
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Serialize
    + DeserializeOwned
    + Send
    + Sync
    + 'static
{
}

impl Linear for Vector2<f64> {}
impl Linear for Vector3<f64> {}
impl Linear for Matrix2<f64> {}
impl Linear for Matrix3<f64> {}

/// Space of two or three dimensions.
pub trait Space: sealed::Sealed + Copy + Debug + Default + Send + Sync + 'static {
    /// Number of dimensions.
    const DIMENSION: usize;
    /// Vector, such as a position, velocity or force.
    type Vector: Linear + Index<usize, Output = f64>;
    /// Gradient of a vector.
    type Matrix: Linear + Mul<Output = Self::Matrix> + Mul<Self::Vector, Output = Self::Vector>;
    /// Symmetric tensor, with the components xx, yy, zz, xy, and in three dimensions also yz, zx. In two dimensions, zz
    /// is the out-of-plane component (plane strain).
    type Symmetric: Copy
        + Debug
        + PartialEq
        + Default
        + Index<usize, Output = f64>
        + Serialize
        + DeserializeOwned
        + Send
        + Sync
        + 'static;
    /// Zero vector.
    const ORIGIN: Self::Vector;
    /// Zero gradient.
    const NO_GRADIENT: Self::Matrix;

    /// Returns the scalar product.
    fn dot(a: Self::Vector, b: Self::Vector) -> f64;
    /// Returns the vector in three dimensions. In two dimensions, z = 0 is added.
    fn embed(vector: Self::Vector) -> Vector3<f64>;
    /// Returns the components of a three-dimensional vector that exist in this space.
    fn restrict(vector: Vector3<f64>) -> Self::Vector;
    /// Returns `a bᵀ`.
    fn outer(a: Self::Vector, b: Self::Vector) -> Self::Matrix;
    /// Returns the gradient in three dimensions, with zero out-of-plane components.
    fn embed_gradient(gradient: Self::Matrix) -> Matrix3<f64>;
    /// Returns the components of a three-dimensional gradient that exist in this space.
    fn restrict_gradient(gradient: Matrix3<f64>) -> Self::Matrix;
    /// Returns a symmetric tensor as a matrix.
    fn embed_symmetric(tensor: Self::Symmetric) -> Matrix3<f64>;
    /// Returns the components of a symmetric matrix that this space stores.
    fn restrict_symmetric(tensor: Matrix3<f64>) -> Self::Symmetric;
    /// Returns the determinant of a gradient.
    fn determinant(gradient: Self::Matrix) -> f64;
    /// Returns `F Fᵀ` of a deformation gradient F. In two dimensions, zz is 1 (no out-of-plane stretch).
    fn finger(deformation: Self::Matrix) -> Self::Symmetric;
    /// Returns ½ (G + Gᵀ) of a gradient G.
    fn symmetric_part(gradient: Self::Matrix) -> Self::Symmetric;
    /// Returns the displacement gradient H of a step with respect to the midpoint configuration, from the gradient G
    /// with respect to the initial configuration: H = G (1 + G/2)⁻¹ (Hughes & Winget 1980). Both are dimensionless.
    ///
    /// A rotation by θ, 1 + G = R, gives H = 2 (R − 1)(R + 1)⁻¹. This H is skew with entries ±2 tan(θ/2), so it
    /// contains no strain. The symmetric part of the corresponding G is (cos θ − 1) 1, so G contains strain.
    fn at_midpoint(gradient: Self::Matrix) -> Self::Matrix;
    /// Returns `R σ Rᵀ` with the rotation of the midpoint rule, R = (1 − W/2)⁻¹(1 + W/2). W is the skew part of
    /// `increment`, the displacement gradient with respect to the midpoint configuration (Hughes & Winget 1980).
    fn turned(tensor: Self::Symmetric, increment: Self::Matrix) -> Self::Symmetric;
    /// Returns `a f + b`.
    fn scaled_sum(a: Self::Symmetric, factor: f64, b: Self::Symmetric) -> Self::Symmetric;
    /// Returns the unit tensor of three dimensions, multiplied by `value`.
    fn isotropic(value: f64) -> Self::Symmetric;
    /// Returns the trace in three dimensions.
    #[inline(always)]
    fn trace(tensor: Self::Symmetric) -> f64 {
        tensor[0] + tensor[1] + tensor[2]
    }
    /// Returns `σ : σ` in three dimensions.
    #[inline(always)]
    fn norm_squared(tensor: Self::Symmetric) -> f64 {
        Self::double_dot(tensor, tensor)
    }
    /// Returns `σ : ε` in three dimensions.
    fn double_dot(one: Self::Symmetric, other: Self::Symmetric) -> f64;
    /// Returns the product of a symmetric tensor and a vector of this space.
    fn apply(tensor: Self::Symmetric, vector: Self::Vector) -> Self::Vector;
    /// Returns a component of a vector.
    #[inline(always)]
    fn component(vector: Self::Vector, axis: usize) -> f64 {
        vector[axis]
    }
}

/// Two dimensions: vectors (x, y), spin about z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Plane;

/// Three dimensions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Solid;

impl Space for Plane {
    const DIMENSION: usize = 2;
    type Vector = Vector2<f64>;
    type Matrix = Matrix2<f64>;
    type Symmetric = [f64; 4];
    const NO_GRADIENT: Matrix2<f64> = Matrix2::new(0.0, 0.0, 0.0, 0.0);
    const ORIGIN: Vector2<f64> = Vector2::new(0.0, 0.0);

    #[inline(always)]
    fn dot(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
        a.x * b.x + a.y * b.y
    }
    #[inline(always)]
    fn embed(vector: Vector2<f64>) -> Vector3<f64> {
        Vector3::new(vector.x, vector.y, 0.0)
    }
    #[inline(always)]
    fn restrict(vector: Vector3<f64>) -> Vector2<f64> {
        vector.xy()
    }
    #[inline(always)]
    fn outer(a: Vector2<f64>, b: Vector2<f64>) -> Matrix2<f64> {
        Matrix2::new(a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y)
    }
    #[inline(always)]
    fn embed_gradient(g: Matrix2<f64>) -> Matrix3<f64> {
        Matrix3::new(g.m11, g.m12, 0.0, g.m21, g.m22, 0.0, 0.0, 0.0, 0.0)
    }
    #[inline(always)]
    fn restrict_gradient(g: Matrix3<f64>) -> Matrix2<f64> {
        Matrix2::new(g.m11, g.m12, g.m21, g.m22)
    }
    #[inline(always)]
    fn embed_symmetric([xx, yy, zz, xy]: [f64; 4]) -> Matrix3<f64> {
        Matrix3::new(xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, zz)
    }
    #[inline(always)]
    fn restrict_symmetric(t: Matrix3<f64>) -> [f64; 4] {
        [t.m11, t.m22, t.m33, t.m12]
    }
    #[inline(always)]
    fn determinant(g: Matrix2<f64>) -> f64 {
        g.m11 * g.m22 - g.m12 * g.m21
    }
    #[inline(always)]
    fn finger(f: Matrix2<f64>) -> [f64; 4] {
        [f.m11 * f.m11 + f.m12 * f.m12, f.m21 * f.m21 + f.m22 * f.m22, 1.0, f.m11 * f.m21 + f.m12 * f.m22]
    }
    #[inline(always)]
    fn symmetric_part(g: Matrix2<f64>) -> [f64; 4] {
        [g.m11, g.m22, 0.0, 0.5 * (g.m12 + g.m21)]
    }
    #[inline(always)]
    fn at_midpoint(g: Matrix2<f64>) -> Matrix2<f64> {
        // By the Cayley–Hamilton theorem, H = (G + ½ det G 1)/det(1 + G/2).
        let minor = 0.5 * (g.m11 * g.m22 - g.m12 * g.m21);
        let inverse = 1.0 / (1.0 + 0.5 * (g.m11 + g.m22 + minor));
        Matrix2::new((g.m11 + minor) * inverse, g.m12 * inverse, g.m21 * inverse, (g.m22 + minor) * inverse)
    }
    #[inline(always)]
    fn turned([xx, yy, zz, xy]: [f64; 4], increment: Matrix2<f64>) -> [f64; 4] {
        let w = 0.5 * (increment.m21 - increment.m12);
        let quarter = 0.25 * w * w;
        let inverse = 1.0 / (1.0 + quarter);
        let (c, s) = ((1.0 - quarter) * inverse, w * inverse);
        let (cc, cs, ss) = (c * c, c * s, s * s);
        let mixed = 2.0 * cs * xy;
        [cc * xx - mixed + ss * yy, ss * xx + mixed + cc * yy, zz, cs * (xx - yy) + (cc - ss) * xy]
    }
    #[inline(always)]
    fn scaled_sum(a: [f64; 4], factor: f64, b: [f64; 4]) -> [f64; 4] {
        [a[0] * factor + b[0], a[1] * factor + b[1], a[2] * factor + b[2], a[3] * factor + b[3]]
    }
    #[inline(always)]
    fn isotropic(value: f64) -> [f64; 4] {
        [value, value, value, 0.0]
    }
    #[inline(always)]
    fn double_dot(a: [f64; 4], b: [f64; 4]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * a[3] * b[3]
    }
    #[inline(always)]
    fn apply([xx, yy, _, xy]: [f64; 4], v: Vector2<f64>) -> Vector2<f64> {
        Vector2::new(xx * v.x + xy * v.y, xy * v.x + yy * v.y)
    }
}

impl Space for Solid {
    const DIMENSION: usize = 3;
    type Vector = Vector3<f64>;
    type Matrix = Matrix3<f64>;
    type Symmetric = [f64; 6];
    const NO_GRADIENT: Matrix3<f64> = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    const ORIGIN: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);

    #[inline(always)]
    fn dot(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
        a.x * b.x + a.y * b.y + a.z * b.z
    }
    #[inline(always)]
    fn embed(vector: Vector3<f64>) -> Vector3<f64> {
        vector
    }
    #[inline(always)]
    fn restrict(vector: Vector3<f64>) -> Vector3<f64> {
        vector
    }
    #[inline(always)]
    fn outer(a: Vector3<f64>, b: Vector3<f64>) -> Matrix3<f64> {
        let column = |scale: f64| a * scale;
        Matrix3::from_columns(&[column(b.x), column(b.y), column(b.z)])
    }
    #[inline(always)]
    fn embed_gradient(gradient: Matrix3<f64>) -> Matrix3<f64> {
        gradient
    }
    #[inline(always)]
    fn restrict_gradient(gradient: Matrix3<f64>) -> Matrix3<f64> {
        gradient
    }
    #[inline(always)]
    fn embed_symmetric([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
        Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
    }
    #[inline(always)]
    fn restrict_symmetric(t: Matrix3<f64>) -> [f64; 6] {
        [t.m11, t.m22, t.m33, t.m12, t.m23, t.m31]
    }
    #[inline(always)]
    fn determinant(g: Matrix3<f64>) -> f64 {
        g.determinant()
    }
    #[inline(always)]
    fn finger(f: Matrix3<f64>) -> [f64; 6] {
        Self::restrict_symmetric(f * f.transpose())
    }
    #[inline(always)]
    fn symmetric_part(g: Matrix3<f64>) -> [f64; 6] {
        Self::restrict_symmetric((g + g.transpose()) * 0.5)
    }
    #[inline(always)]
    fn at_midpoint(gradient: Matrix3<f64>) -> Matrix3<f64> {
        // By the Cayley–Hamilton theorem, H = (G − ½ adj G + (½ tr adj G + ¼ det G) 1)/det(1 + G/2). The columns of adj
        // G are cross products of the rows of G.
        let [x, y, z] = [0, 1, 2].map(|row| gradient.row(row).transpose());
        let adjugate = Matrix3::from_columns(&[y.cross(&z), z.cross(&x), x.cross(&y)]);
        let (minors, quarter) = (0.5 * adjugate.trace(), 0.25 * x.dot(&y.cross(&z)));
        let inverse = 1.0 / (1.0 + 0.5 * (gradient.trace() + minors + quarter));
        (gradient - adjugate * 0.5 + Matrix3::from_diagonal_element(minors + quarter)) * inverse
    }
    #[inline(always)]
    fn turned(tensor: [f64; 6], increment: Matrix3<f64>) -> [f64; 6] {
        // R = 1 + (W + W²/2)/(1 + |w|²/4) with the axial vector w of W.
        let skew = (increment - increment.transpose()) * 0.5;
        let axial = skew.m12 * skew.m12 + skew.m23 * skew.m23 + skew.m31 * skew.m31;
        let rotation = Matrix3::identity() + (skew + skew * skew * 0.5) / (1.0 + 0.25 * axial);
        Self::restrict_symmetric(rotation * Self::embed_symmetric(tensor) * rotation.transpose())
    }
    #[inline(always)]
    fn scaled_sum(a: [f64; 6], factor: f64, b: [f64; 6]) -> [f64; 6] {
        let at = |at: usize| a[at] * factor + b[at];
        [at(0), at(1), at(2), at(3), at(4), at(5)]
    }
    #[inline(always)]
    fn isotropic(value: f64) -> [f64; 6] {
        [value, value, value, 0.0, 0.0, 0.0]
    }
    #[inline(always)]
    fn double_dot(a: [f64; 6], b: [f64; 6]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
    }
    #[inline(always)]
    fn apply([xx, yy, zz, xy, yz, zx]: [f64; 6], v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(xx * v.x + xy * v.y + zx * v.z, xy * v.x + yy * v.y + yz * v.z, zx * v.x + yz * v.y + zz * v.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formulas in two and three dimensions give the same results for plane tensors.
    #[test]
    fn plane_agrees_with_solid() {
        let (tensor, gradient) = ([1.0, -2.0, 0.5, 0.7], Matrix2::new(0.01, 0.2, -0.1, 0.03));
        let unit = gradient + Matrix2::identity();
        let mut solid_unit = Plane::embed_gradient(unit);
        solid_unit.m33 = 1.0;
        let same = |flat: [f64; 4], full: [f64; 6]| {
            (Plane::embed_symmetric(flat) - Solid::embed_symmetric(full)).norm() < 1e-14
        };
        let embedded = Solid::restrict_symmetric(Plane::embed_symmetric(tensor));
        assert!(same(Plane::turned(tensor, gradient), Solid::turned(embedded, Plane::embed_gradient(gradient))));
        let middle = Plane::embed_gradient(Plane::at_midpoint(gradient));
        assert!((middle - Solid::at_midpoint(Plane::embed_gradient(gradient))).norm() < 1e-15);
        assert!(same(Plane::finger(unit), Solid::finger(solid_unit)));
        assert!((Plane::determinant(unit) - Solid::determinant(solid_unit)).abs() < 1e-15);
    }

    /// Checks H (1 + G/2) = G for any displacement gradient G, and that H of a rotation about any axis is skew.
    #[test]
    fn a_rotation_has_no_strain_at_the_midpoint() {
        let gradient = Matrix3::new(0.11, 0.2, -0.3, -0.17, 0.03, 0.25, 0.07, -0.4, -0.2);
        let middle = Solid::at_midpoint(gradient);
        assert!((middle * (Matrix3::identity() + gradient * 0.5) - gradient).norm() < 1e-15, "{middle}");
        for axis in [Vector3::z(), Vector3::new(0.6, -0.48, 0.64)] {
            let angle = 0.8_f64;
            let rotation = nalgebra::Rotation3::new(axis * angle).into_inner();
            let middle = Solid::at_midpoint(rotation - Matrix3::identity());
            // 2 tan(θ/2) times the cross-product matrix of the axis.
            let expected = axis.cross_matrix() * (2.0 * (0.5 * angle).tan());
            assert!((middle - expected).norm() < 1e-15 * 10.0, "{middle}");
        }
    }

    // The numbers are chosen so that any exchange of components changes a result.

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
}
