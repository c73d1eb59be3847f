//! Surface shape functions, which interpolate between a point on a body's surface and the nodes with mass around it.
//!
//! Basis functions are the weights with which surface forces act on nodes and tracers follow nodes. In strong plastic
//! flow a grain may be stretched to three times its length, and its points are then a cell and a half apart. A node can
//! have half of the weight at a tracer but a thousandth of the mass of other nodes. An unlimited force would accelerate
//! this node without bound, and the node would drag the surface along. The weight of a node is therefore limited by its
//! mass.

use crate::grid::basis::Basis;
use crate::grid::lattice::{Lattice, Node, Stencil};
use crate::points::body::Body;
use grainbench_solver::space::Space;

/// Upper limit of w² m_cell/m for a node, with weight w, mass m and the mass m_cell of a full cell.
///
/// A unit impulse on a surface changes the velocity there by Σ w²/m. If the surface is well sampled, this sum is
/// 1/m_cell to 2/m_cell. The limit then affects only nodes with hardly any mass, which have small weights anyway. It
/// changes results for rolling, impact and compression in the fourth digit.
const MOST: f64 = 4.0;

/// Computes the weight limit of every node of a window from its mass (kg): √(4 m/m_cell).
///
/// A node with vanishing mass therefore has no influence.
pub(crate) fn bear<S: Space>(nodes: &[Node<S>], cell_mass: f64, most: &mut [f64]) {
    let factor = MOST / cell_mass;
    for (most, node) in most.iter_mut().zip(nodes) {
        *most = (factor * node.mass).sqrt();
    }
}

/// Interpolation at a point on the surface of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceShapeFunction<S: Space> {
    stencil: Stencil<f64>,
    /// Sum of the weights.
    total: f64,
    /// Interpolated velocity (m/s).
    pub(crate) velocity: S::Vector,
}

impl<S: Space> SurfaceShapeFunction<S> {
    /// Creates the interpolation at `position`, or returns `None` if there is no mass nearby. The nodes must contain
    /// momenta instead of velocities.
    #[inline(always)]
    pub(crate) fn new<B: Basis>(
        lattice: &Lattice,
        body: &Body,
        position: S::Vector,
        nodes: &[Node<S>],
        most: &[f64],
    ) -> Option<Self> {
        let stencil = Stencil::new::<S, B>(lattice, position, [body.half; 3]);
        if !body.window.holds(S::DIMENSION, stencil.base, B::WIDTH as i32) {
            return None;
        }
        let (mut total, mut velocity) = (0.0, S::ORIGIN);
        stencil.each::<S, B>(&body.window, |node| {
            let weight = node.weight.min(most[node.slot]);
            if weight > 0.0 {
                total += weight;
                let Node { mass, velocity: momentum, .. } = nodes[node.slot];
                velocity += momentum * (weight / mass);
            }
        });
        (total > 1e-6).then(|| Self { stencil, total, velocity: velocity * (1.0 / total) })
    }

    /// Applies a force (N) to the body at this point.
    #[inline(always)]
    pub(crate) fn push<B: Basis>(&self, body: &Body, force: S::Vector, nodes: &mut [Node<S>], most: &[f64]) {
        let share = force * (1.0 / self.total);
        self.stencil.each::<S, B>(&body.window, |node| {
            nodes[node.slot].change += share * node.weight.min(most[node.slot]);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, bear};
    use crate::grid::lattice::Node;
    use grainbench_solver::space::Plane;

    /// Returns the weight limit of a node with the given mass, in a body with 3 kg per cell.
    fn most(mass: f64) -> f64 {
        let mut most = [f64::NAN];
        bear::<Plane>(&[Node { mass, ..Node::EMPTY }], CELL, &mut most);
        most[0]
    }

    const CELL: f64 = 3.0;

    #[test]
    fn a_node_counts_by_its_function_until_it_has_hardly_any_mass() {
        // Weights of quadratic functions at a surface halfway between two nodes, and at a surface on a node. In these
        // cases, the outer nodes have a sixth and a forty-eighth of the mass of a cell.
        for (weight, mass) in [(0.5, CELL / 6.0), (0.75, 0.5 * CELL), (0.125, CELL / 48.0)] {
            assert!(weight < most(mass));
        }
        // For smaller masses the limit acts, and w² m_cell/m equals its upper limit.
        for mass in [0.1, 1e-6] {
            assert!((most(mass) * most(mass) / mass * CELL / MOST - 1.0).abs() < 1e-12);
        }
        assert!(most(0.0).abs() < f64::EPSILON);
    }
}
