//! Vectors and spins for contact laws, in two and three dimensions. Each component is one number, or one number per lane of
//! a SIMD register.

use grainbench_lanes::{Number, Quad};
use grainbench_solver::space::{Plane, Solid, Space};
use nalgebra::Vector3;
use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

/// Components of a vector, a spin or a tangential displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Components<X, const D: usize>(pub(crate) [X; D]);

/// Operations that contact laws need for a vector, a spin or a tangential displacement.
pub(crate) trait Linear<X: Number>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<X, Output = Self> + Neg<Output = Self>
{
    /// Number of components.
    const COUNT: usize;
    /// Returns the scalar product.
    fn dot(self, other: Self) -> X;
    /// Returns `yes` where the mask is set, otherwise `no`.
    #[must_use]
    fn choose(mask: X::Mask, yes: Self, no: Self) -> Self;
    /// Reads the components from the first `COUNT` values of `row`.
    fn read(row: &[X]) -> Self;
    /// Writes the components to the first `COUNT` values of `row`.
    fn write(self, row: &mut [X]);
}

/// Implements an operator component by component.
macro_rules! operator {
    ($Operator:ident, $operator:ident) => {
        impl<X: Number, const D: usize> $Operator for Components<X, D> {
            type Output = Self;
            #[inline(always)]
            fn $operator(mut self, other: Self) -> Self {
                for axis in 0..D {
                    self.0[axis] = self.0[axis].$operator(other.0[axis]);
                }
                self
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);

impl<X: Number, const D: usize> Mul<X> for Components<X, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, by: X) -> Self {
        for axis in 0..D {
            self.0[axis] = self.0[axis] * by;
        }
        self
    }
}

impl<X: Number, const D: usize> Neg for Components<X, D> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for axis in 0..D {
            self.0[axis] = -self.0[axis];
        }
        self
    }
}

impl<X: Number, const D: usize> Linear<X> for Components<X, D> {
    const COUNT: usize = D;

    #[inline(always)]
    fn dot(self, other: Self) -> X {
        let mut sum = self.0[0] * other.0[0];
        for axis in 1..D {
            sum = sum + self.0[axis] * other.0[axis];
        }
        sum
    }
    #[inline(always)]
    fn choose(mask: X::Mask, mut yes: Self, no: Self) -> Self {
        for axis in 0..D {
            yes.0[axis] = X::choose(mask, yes.0[axis], no.0[axis]);
        }
        yes
    }
    #[inline(always)]
    fn read(row: &[X]) -> Self {
        let mut components = [row[0]; D];
        components.copy_from_slice(&row[..D]);
        Self(components)
    }
    #[inline(always)]
    fn write(self, row: &mut [X]) {
        row[..D].copy_from_slice(&self.0);
    }
}

/// Two- or three-dimensional space (`Plane` or `Solid`), with vectors of any number type and the memory layout of a grain.
///
/// The unit normal `e` of a contact points from the first grain to the second. In two dimensions, the tangential
/// direction is `t = (e₂, −e₁)`, the clockwise perpendicular (Cundall & Strack 1979, eq. 10). A tangential quantity is
/// then a scalar along `t`, and thus rotates with the contact. In three dimensions, a tangential quantity is a vector
/// perpendicular to `e`.
///
/// A grain has five quads (four numbers each): position (x, y, z, radius), velocity (v, inverse mass), spin (ω), and the
/// sums of forces and of torques. In two dimensions, the angle replaces z, the spin replaces v_z, and the torque replaces
/// F_z. There are then no quads for spin and torque.
pub(crate) trait Geometry: Space {
    /// Vector of this space.
    type Vectors<X: Number>: Linear<X>;
    /// Spin: a scalar about z, or a vector.
    type Spins<X: Number>: Linear<X>;
    /// Tangential quantity: a scalar along `t`, or a vector.
    type Tangents<X: Number>: Linear<X>;

    /// Returns the vector in a quad.
    fn vector<X: Number>(quad: [X; 4]) -> Self::Vectors<X>;
    /// Returns the spin in a quad: the third number in two dimensions, and the first three numbers in three dimensions.
    fn spin<X: Number>(quad: [X; 4]) -> Self::Spins<X>;
    /// Returns the quads of a force and a torque, with `zero` in unused components.
    fn load<X: Number>(force: Self::Vectors<X>, torque: Self::Spins<X>, zero: X) -> [[X; 4]; 2];
    /// Returns a vector with three components; in two dimensions, the third component is `zero`.
    fn whole<X: Number>(vector: Self::Vectors<X>, zero: X) -> [X; 3];
    /// Returns the torque of a force at a lever arm.
    fn torque_of<X: Number>(arm: Self::Vectors<X>, force: Self::Vectors<X>) -> Self::Spins<X>;
    /// Returns the tangential slip velocity of two surfaces in contact. `velocity` is that of the first centre relative
    /// to the second. `rolling` is ω₁a₁ + ω₂a₂ with lever arms a and angular velocities ω.
    fn slip<X: Number>(
        velocity: Self::Vectors<X>,
        rolling: Self::Spins<X>,
        normal: Self::Vectors<X>,
    ) -> Self::Tangents<X>;
    /// Returns the part of a vector perpendicular to the normal.
    fn tangential<X: Number>(vector: Self::Vectors<X>, normal: Self::Vectors<X>) -> Self::Tangents<X>;
    /// Returns a tangential quantity as a vector.
    fn along<X: Number>(tangent: Self::Tangents<X>, normal: Self::Vectors<X>) -> Self::Vectors<X>;
    /// Returns the rolling part of a relative spin. In three dimensions, the part along the normal is twisting and is
    /// removed. In two dimensions, the whole spin is rolling.
    fn rolled<X: Number>(spin: Self::Spins<X>, normal: Self::Vectors<X>) -> Self::Spins<X>;

    /// Returns the part of a spin along the normal; zero in two dimensions.
    fn twist<X: Number>(spin: Self::Spins<X>, normal: Self::Vectors<X>) -> X;
    /// Returns a stored tangential quantity after the rotation of its contact. `middle` is the normal in the middle of
    /// the step. The contact rotates about `normal` by an angle whose half has the tangent `half_twist`. In two
    /// dimensions, the scalar does not change, which is the provided function.
    #[inline(always)]
    fn turned_tangent<X: Number>(
        tangent: Self::Tangents<X>,
        _middle: Self::Vectors<X>,
        _normal: Self::Vectors<X>,
        _half_twist: X,
    ) -> Self::Tangents<X> {
        tangent
    }
    /// Returns a stored rolling angle after the rotation of its contact. The arguments are those of `turned_tangent`.
    #[inline(always)]
    fn turned_spin<X: Number>(
        spin: Self::Spins<X>,
        _middle: Self::Vectors<X>,
        _normal: Self::Vectors<X>,
        _half_twist: X,
    ) -> Self::Spins<X> {
        spin
    }

    /// Returns the vector in a quad as three components. In two dimensions, the third component is zero.
    #[inline(always)]
    fn vector_in_space(quad: &Quad) -> Vector3<f64> {
        let [x, y, z, _] = quad.0;
        Vector3::new(x, y, if Self::DIMENSION == 3 { z } else { 0.0 })
    }
    /// Writes the components of a vector in this space to the first numbers of a quad.
    #[inline(always)]
    fn put(vector: Vector3<f64>, quad: &mut Quad) {
        quad.0[..Self::DIMENSION].copy_from_slice(&vector.as_slice()[..Self::DIMENSION]);
    }
    /// Converts a vector with three components to a vector of this space.
    #[inline(always)]
    fn vector_of(vector: Vector3<f64>) -> Self::Vectors<f64> {
        Self::vector([vector.x, vector.y, vector.z, 0.0])
    }
    /// Converts a spin with three components to this space. In two dimensions, only the z component is kept.
    #[inline(always)]
    fn spin_of(spin: Vector3<f64>) -> Self::Spins<f64> {
        Self::spin([spin.x, spin.y, spin.z, 0.0])
    }
}

impl Geometry for Plane {
    type Vectors<X: Number> = Components<X, 2>;
    type Spins<X: Number> = Components<X, 1>;
    type Tangents<X: Number> = Components<X, 1>;

    #[inline(always)]
    fn vector<X: Number>([x, y, _, _]: [X; 4]) -> Components<X, 2> {
        Components([x, y])
    }
    #[inline(always)]
    fn spin<X: Number>([_, _, z, _]: [X; 4]) -> Components<X, 1> {
        Components([z])
    }
    #[inline(always)]
    fn load<X: Number>(
        Components([x, y]): Components<X, 2>,
        Components([torque]): Components<X, 1>,
        zero: X,
    ) -> [[X; 4]; 2] {
        [[x, y, torque, zero], [zero; 4]]
    }
    #[inline(always)]
    fn whole<X: Number>(Components([x, y]): Components<X, 2>, zero: X) -> [X; 3] {
        [x, y, zero]
    }
    #[inline(always)]
    fn torque_of<X: Number>(
        Components(arm): Components<X, 2>,
        Components(force): Components<X, 2>,
    ) -> Components<X, 1> {
        Components([arm[0] * force[1] - arm[1] * force[0]])
    }
    #[inline(always)]
    fn slip<X: Number>(
        velocity: Components<X, 2>,
        Components([rolling]): Components<X, 1>,
        normal: Components<X, 2>,
    ) -> Components<X, 1> {
        let Components([slip]) = Self::tangential(velocity, normal);
        Components([slip - rolling])
    }
    #[inline(always)]
    fn tangential<X: Number>(
        Components(vector): Components<X, 2>,
        Components(normal): Components<X, 2>,
    ) -> Components<X, 1> {
        Components([vector[0] * normal[1] - vector[1] * normal[0]])
    }
    #[inline(always)]
    fn along<X: Number>(
        Components([tangent]): Components<X, 1>,
        Components([x, y]): Components<X, 2>,
    ) -> Components<X, 2> {
        Components([tangent * y, -(tangent * x)])
    }
    #[inline(always)]
    fn rolled<X: Number>(spin: Components<X, 1>, _normal: Components<X, 2>) -> Components<X, 1> {
        spin
    }
    #[inline(always)]
    fn twist<X: Number>(Components([spin]): Components<X, 1>, _normal: Components<X, 2>) -> X {
        spin.like(0.0)
    }
}

/// Returns a × b.
#[inline(always)]
fn cross<X: Number>(Components(a): Components<X, 3>, Components(b): Components<X, 3>) -> Components<X, 3> {
    Components([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

/// Transports a vector ξ that is perpendicular to the normal e at the start of a step to the normal e' at the end of
/// the step. First, ξ is reflected in the plane perpendicular to the middle normal m, which maps e to −e': ξ' = ξ − 2
/// (ξ·m) m. Then ξ' is rotated about e' by an angle φ with t = tan φ/2: ξ'' = [(1 − t²) ξ' + 2t e'×ξ']/(1 + t²). Both
/// operations conserve the length. The factor 1/(1 + t²) is (1 − t²)(1 + t⁴) with an error of t⁸, less than rounding
/// for φ < .02.
#[inline(always)]
fn turned<X: Number>(
    vector: Components<X, 3>,
    middle: Components<X, 3>,
    normal: Components<X, 3>,
    half_twist: X,
) -> Components<X, 3> {
    let square = half_twist * half_twist;
    let inverse = (-square + 1.0) * (square * square + 1.0);
    let tilted = vector - middle * (vector.dot(middle) * 2.0);
    tilted * ((-square + 1.0) * inverse) + cross(normal, tilted) * (half_twist * 2.0 * inverse)
}

impl Geometry for Solid {
    type Vectors<X: Number> = Components<X, 3>;
    type Spins<X: Number> = Components<X, 3>;
    type Tangents<X: Number> = Components<X, 3>;

    #[inline(always)]
    fn vector<X: Number>([x, y, z, _]: [X; 4]) -> Components<X, 3> {
        Components([x, y, z])
    }
    #[inline(always)]
    fn spin<X: Number>([x, y, z, _]: [X; 4]) -> Components<X, 3> {
        Components([x, y, z])
    }
    #[inline(always)]
    fn load<X: Number>(
        Components([x, y, z]): Components<X, 3>,
        Components([a, b, c]): Components<X, 3>,
        zero: X,
    ) -> [[X; 4]; 2] {
        [[x, y, z, zero], [a, b, c, zero]]
    }
    #[inline(always)]
    fn whole<X: Number>(Components(vector): Components<X, 3>, _zero: X) -> [X; 3] {
        vector
    }
    #[inline(always)]
    fn torque_of<X: Number>(arm: Components<X, 3>, force: Components<X, 3>) -> Components<X, 3> {
        cross(arm, force)
    }
    #[inline(always)]
    fn slip<X: Number>(
        velocity: Components<X, 3>,
        rolling: Components<X, 3>,
        normal: Components<X, 3>,
    ) -> Components<X, 3> {
        Self::tangential(velocity, normal) + cross(rolling, normal)
    }
    #[inline(always)]
    fn tangential<X: Number>(vector: Components<X, 3>, normal: Components<X, 3>) -> Components<X, 3> {
        vector - normal * vector.dot(normal)
    }
    #[inline(always)]
    fn along<X: Number>(tangent: Components<X, 3>, _normal: Components<X, 3>) -> Components<X, 3> {
        tangent
    }
    #[inline(always)]
    fn rolled<X: Number>(spin: Components<X, 3>, normal: Components<X, 3>) -> Components<X, 3> {
        Self::tangential(spin, normal)
    }
    #[inline(always)]
    fn twist<X: Number>(spin: Components<X, 3>, normal: Components<X, 3>) -> X {
        spin.dot(normal)
    }
    #[inline(always)]
    fn turned_tangent<X: Number>(
        tangent: Components<X, 3>,
        middle: Components<X, 3>,
        normal: Components<X, 3>,
        half_twist: X,
    ) -> Components<X, 3> {
        turned(tangent, middle, normal, half_twist)
    }
    #[inline(always)]
    fn turned_spin<X: Number>(
        spin: Components<X, 3>,
        middle: Components<X, 3>,
        normal: Components<X, 3>,
        half_twist: X,
    ) -> Components<X, 3> {
        turned(spin, middle, normal, half_twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a planar contact, the formulas in two and three dimensions give the same slip, force and torque.
    #[test]
    fn plane_agrees_with_solid() {
        let (angle, velocity, rolling, tangent) = (0.7_f64, [0.3, -1.1], 2.5, -0.4);
        let [x, y] = [angle.cos(), angle.sin()];
        let flat = |vector: [f64; 2]| Components([vector[0], vector[1], 0.0]);
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);

        let slip = Plane::slip(Components(velocity), Components([rolling]), Components([x, y]));
        let full = Solid::slip(flat(velocity), Components([0.0, 0.0, rolling]), flat([x, y]));
        assert!(near(Plane::whole(Plane::along(slip, Components([x, y])), 0.0), full.0));

        let force = Plane::along(Components([tangent]), Components([x, y]));
        let Components([torque]) = Plane::torque_of(Components([x, y]), force);
        assert!(near([0.0, 0.0, torque], Solid::torque_of(flat([x, y]), flat(force.0)).0));
        assert!(near(Solid::rolled(flat([x, y]), flat([x, y])).0, [0.0; 3]));
    }
}
