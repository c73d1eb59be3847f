//! Transfer of velocities between points and nodes.

use crate::grid::lattice::Stencil;
use grainbench_lanes::Number;
use grainbench_solver::space::Space;

/// Transfer of velocities between points and nodes.
pub(crate) trait Transfer: Copy + Send + 'static {
    /// True if points store the affine part of the velocity, or its spin.
    const AFFINE: bool;
    /// True if points use the node velocity, and not only its change.
    const AROUND: bool;
    /// Returns a component of a point's velocity after the step.
    ///
    /// `before` is the damped velocity before the step, `around` the interpolated node velocity, and `change` the
    /// interpolated change of the node velocity without damping.
    fn taken<N: Number>(&self, before: N, around: N, change: N) -> N;
    /// Selects the node values from which the affine part is computed: velocities or their changes.
    fn source<N>(velocity: N, change: N) -> N;
    /// Returns the affine part after the step, by rows, from the previous affine part and the one computed from the
    /// nodes.
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], made: [[N; 3]; 3], stencil: &Stencil<N>) -> [[N; 3]; 3];
}

/// FLIP transfer. Points keep their velocity and add the change of the node velocity (Brackbill & Ruppel 1986), blended
/// with the node velocity: v ← (1 − α)(v + Δv) + α v_node.
#[derive(Clone, Copy)]
pub(crate) struct Flip {
    /// Fraction α of the node velocity in the update.
    pub(crate) pic: f64,
}

impl Transfer for Flip {
    const AFFINE: bool = false;
    const AROUND: bool = true;

    #[inline(always)]
    fn taken<N: Number>(&self, before: N, around: N, change: N) -> N {
        (before + change) * (1.0 - self.pic) + around * self.pic
    }
    #[inline(always)]
    fn source<N>(velocity: N, _change: N) -> N {
        velocity
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], _made: [[N; 3]; 3], _stencil: &Stencil<N>) -> [[N; 3]; 3] {
        before
    }
}

/// APIC transfer. Points store the affine part of the velocity (Jiang et al. 2015). The method conserves angular
/// momentum and damps motion with wavelengths below a few cells.
#[derive(Clone, Copy)]
pub(crate) struct Apic;

impl Transfer for Apic {
    const AFFINE: bool = true;
    const AROUND: bool = true;

    #[inline(always)]
    fn taken<N: Number>(&self, _before: N, around: N, _change: N) -> N {
        around
    }
    #[inline(always)]
    fn source<N>(velocity: N, _change: N) -> N {
        velocity
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(_before: [[N; 3]; 3], made: [[N; 3]; 3], _stencil: &Stencil<N>) -> [[N; 3]; 3] {
        made
    }
}

/// FLIP transfer with spin. A point keeps its velocity and spin and adds the changes of both. Unlike FLIP, this
/// transfer does not lose the angular momentum of points of finite extent. Unlike APIC, it has no damping.
///
/// The velocity changes Δv of the nodes have an angular momentum about the point. The spin changes by the rigid
/// rotation with this angular momentum: Δω = Σ w r × Δv / Σ w |r|² about each axis. Here r is the vector from the point
/// to the node, perpendicular to the axis. A yielding point takes the spin of the velocity around it
/// ([`crate::material::stress`]).
#[derive(Clone, Copy)]
pub(crate) struct Spin;

impl Transfer for Spin {
    const AFFINE: bool = true;
    const AROUND: bool = false;

    #[inline(always)]
    fn taken<N: Number>(&self, before: N, _around: N, change: N) -> N {
        before + change
    }
    #[inline(always)]
    fn source<N>(_velocity: N, change: N) -> N {
        change
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], made: [[N; 3]; 3], stencil: &Stencil<N>) -> [[N; 3]; 3] {
        // The affine part is B D⁻¹ with B = Σ w Δv rᵀ and the diagonal matrix D = Σ w r rᵀ.
        let mut after = before;
        for a in 0..S::DIMENSION {
            for b in a + 1..S::DIMENSION {
                let [one, two] = [stencil.spread(a), stencil.spread(b)];
                let total = one + two;
                let turn = (made[b][a] * one - made[a][b] * two) / total;
                // A point exactly on a node of hat functions has a zero moment of inertia.
                let turn = total.like(0.0).pick_below(total, turn, total.like(0.0));
                after[b][a] = after[b][a] + turn;
                after[a][b] = after[a][b] - turn;
            }
        }
        after
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::basis::{Gimp, Quadratic};
    use crate::grid::lattice::Lattice;
    use crate::points::body::extent;
    use grainbench_solver::space::Plane;
    use nalgebra::{Matrix2, Vector2};

    /// In simple shear x = X + ¾Y, the material lines grow along x by the factor √b_xx = √(1 + ¾²) = 5/4, and not along
    /// y. A rotation before the shear changes neither.
    #[test]
    fn a_point_reaches_as_far_as_its_material_lines() {
        let shear = Matrix2::new(1.0, 0.75, 0.0, 1.0);
        for turn in [Matrix2::identity(), Matrix2::new(0.6, -0.8, 0.8, 0.6)] {
            let [x, y, _] = extent::<Plane, Gimp>(0.24, shear * turn);
            assert!((x - 0.3).abs() < 1e-15 && (y - 0.24).abs() < 1e-15, "{x} {y}");
        }
    }

    /// A point in cells of 1 m × 2 m has D = h²/4 along each axis. The change ∂v_y/∂x = g has the angular momentum Σ w
    /// x Δv_y = g D_x about the point, and the change ∂v_x/∂y = g has −g D_y. Division by D_x + D_y gives the spins g/5
    /// and −4g/5.
    #[test]
    fn a_spin_has_the_angular_momentum_of_the_nodes() {
        let (cell, inverse) = ([1.0, 2.0, 1.0], [1.0, 0.5, 1.0]);
        let lattice = Lattice { cell, inverse, origin: [0.0; 3], period: [None; 3] };
        let stencil = Stencil::new::<Plane, Quadratic>(&lattice, Vector2::new(3.3, 5.1), [0.25; 3]);
        for (row, column, spin) in [(1, 0, 0.2), (0, 1, -0.8)] {
            let mut made = [[0.0; 3]; 3];
            made[row][column] = 7.0;
            let carried = Spin::carried::<Plane, f64>([[0.0; 3]; 3], made, &stencil);
            assert!(
                (carried[1][0] - 7.0 * spin).abs() < 1e-14 && (carried[0][1] + 7.0 * spin).abs() < 1e-14,
                "{carried:?}"
            );
        }
    }
}
