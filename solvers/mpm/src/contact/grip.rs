//! A body as a point on its surface sees it: the nodes around that carry mass.
//!
//! Forces on a surface act on nodes and tracers follow nodes, weighted by the basis functions. Where flow has drawn a
//! grain out to three times its length its points stand a cell and a half apart, and a node may count half at a tracer
//! and have a thousandth of the mass of others: pushed as hard as they are it flies off, and takes along what it can.
//! So no node counts for more than its mass can bear.

use crate::basis::Basis;
use crate::grid::{Lattice, Node, Stencil};
use crate::transfer::Part;
use grainbench_scene::space::Space;

/// What w² of a node is at most, in its mass over that of a full cell. An impulse on a surface changes the velocity
/// there by Σ w²/m, which is 1 to 2 (per mass of a cell) in sum where a surface is well sampled. There only nodes that
/// points hardly reach are above it, which count for little anyway: rolling, impacts and presses differ in the fourth
/// digit.
const MOST: f64 = 4.0;

/// What every node of a body's window, of given masses (kg), counts for at most at its surface: √(4 m/m_cell), so that
/// a node fades out with its mass.
pub(crate) fn bear<S: Space>(nodes: &[Node<S>], cell_mass: f64, most: &mut [f64]) {
    let factor = MOST / cell_mass;
    for (most, node) in most.iter_mut().zip(nodes) {
        *most = (factor * node.mass).sqrt();
    }
}

/// A body held at a point on its surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip<S: Space> {
    stencil: Stencil<f64>,
    /// Sum of the weights.
    total: f64,
    /// Velocity there (m/s).
    pub(crate) velocity: S::Vector,
}

impl<S: Space> Grip<S> {
    /// The body at `position`; none where it has no mass around. Nodes hold momenta.
    #[inline(always)]
    pub(crate) fn new<B: Basis>(
        lattice: &Lattice,
        part: &Part,
        position: S::Vector,
        nodes: &[Node<S>],
        most: &[f64],
    ) -> Option<Self> {
        let stencil = Stencil::new::<S, B>(lattice, position, [part.half; 3]);
        if !part.window.holds(S::DIMENSION, stencil.base(), B::WIDTH as i32) {
            return None;
        }
        let (mut total, mut velocity) = (0.0, S::ORIGIN);
        stencil.each::<S, B>(&part.window, |node| {
            let weight = node.weight.min(most[node.slot]);
            if weight > 0.0 {
                total += weight;
                let Node { mass, velocity: momentum, .. } = nodes[node.slot];
                velocity += momentum * (weight / mass);
            }
        });
        (total > 1e-6).then(|| Self { stencil, total, velocity: velocity * (1.0 / total) })
    }

    /// A force (N) on the body there.
    #[inline(always)]
    pub(crate) fn push<B: Basis>(&self, part: &Part, force: S::Vector, nodes: &mut [Node<S>], most: &[f64]) {
        let share = force * (1.0 / self.total);
        self.stencil.each::<S, B>(&part.window, |node| {
            nodes[node.slot].change += share * node.weight.min(most[node.slot]);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, bear};
    use crate::grid::Node;
    use grainbench_scene::space::Plane;

    /// What a node of a mass counts for at most, in a body with 3 kg a cell.
    fn most(mass: f64) -> f64 {
        let mut most = [f64::NAN];
        bear::<Plane>(&[Node { mass, ..Node::EMPTY }], CELL, &mut most);
        most[0]
    }

    const CELL: f64 = 3.0;

    #[test]
    fn a_node_counts_by_its_function_until_it_has_hardly_any_mass() {
        // A plane half way between two nodes, and on a node: what is outside has a sixth of a cell's mass, and a
        // fiftieth.
        for (weight, mass) in [(0.5, CELL / 6.0), (0.75, 0.5 * CELL), (0.125, CELL / 48.0)] {
            assert!(weight < most(mass));
        }
        // Then it fades out, so that w²/m stays what it is at most.
        for mass in [0.1, 1e-6] {
            assert!((most(mass) * most(mass) / mass * CELL / MOST - 1.0).abs() < 1e-12);
        }
        assert!(most(0.0).abs() < f64::EPSILON);
    }
}
