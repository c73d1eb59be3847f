//! A body as a point on its surface sees it: the nodes around that carry mass.
//!
//! Forces on a surface act on nodes and tracers follow nodes, weighted by the basis functions. Where flow has drawn a grain out to three
//! times its length its points stand a cell and a half apart, and a node may count half at a tracer and have a thousandth of the
//! mass of others: pushed as hard as they are it flies off, and takes along what it can. So no node counts for more than its
//! mass can bear.

use crate::basis::Basis;
use crate::grid::{Lattice, Node, Stencil};
use crate::transfer::Part;
use grainbench_scene::space::Space;

/// What w² of a node is at most, in its mass over that of a full cell. An impulse on a surface changes the velocity there by
/// Σ w²/m, which is 1 to 2 (per mass of a cell) in sum where a surface is well sampled. There only nodes that points hardly reach are
/// above it, which count for little anyway: rolling, impacts and presses differ in the fourth digit.
const MOST: f64 = 4.0;

/// Weight of a node of a given mass (kg) at a point where its function is `weight`: w = N, at most √(4 m/m_cell), so that it fades out with
/// its mass.
#[inline(always)]
pub(crate) fn borne(weight: f64, mass: f64, cell_mass: f64) -> f64 {
    if weight * weight * cell_mass > MOST * mass { (MOST * mass / cell_mass).sqrt() } else { weight }
}

/// A body held at a point on its surface.
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
    ) -> Option<Self> {
        Self::with::<B>(lattice, part, position, nodes, |slot, weight| {
            nodes[slot].velocity * (weight / nodes[slot].mass)
        })
    }

    /// The same, with `weighted` for the velocity of a node times its weight.
    #[inline(always)]
    pub(crate) fn with<B: Basis>(
        lattice: &Lattice,
        part: &Part,
        position: S::Vector,
        nodes: &[Node<S>],
        weighted: impl Fn(usize, f64) -> S::Vector,
    ) -> Option<Self> {
        let stencil = Stencil::new::<S, B>(lattice, position, [part.half; 3]);
        if !part.window.holds(S::DIMENSION, stencil.base(), B::WIDTH as i32) {
            return None;
        }
        let (mut total, mut velocity) = (0.0, S::ORIGIN);
        stencil.each::<S, B>(&part.window, |node| {
            let mass = nodes[node.slot].mass;
            if mass > 0.0 {
                let weight = borne(node.weight, mass, part.cell_mass);
                total += weight;
                velocity += weighted(node.slot, weight);
            }
        });
        (total > 1e-6).then(|| Self { stencil, total, velocity: velocity * (1.0 / total) })
    }

    /// A force (N) on the body there.
    #[inline(always)]
    pub(crate) fn push<B: Basis>(&self, part: &Part, force: S::Vector, nodes: &mut [Node<S>]) {
        let share = force * (1.0 / self.total);
        self.stencil.each::<S, B>(&part.window, |node| {
            let at = &mut nodes[node.slot];
            if at.mass > 0.0 {
                at.change += share * borne(node.weight, at.mass, part.cell_mass);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, borne};

    #[test]
    fn a_node_counts_by_its_function_until_it_has_hardly_any_mass() {
        let cell_mass = 3.0;
        // A plane half way between two nodes, and on a node: what is outside has a sixth of a cell's mass, and a fiftieth.
        for (weight, mass) in [(0.5, cell_mass / 6.0), (0.75, 0.5 * cell_mass), (0.125, cell_mass / 48.0)] {
            assert!((borne(weight, mass, cell_mass) - weight).abs() < f64::EPSILON);
        }
        // Then it fades out, without a jump, so that w²/m stays what it is at most.
        let limit = 0.25 * cell_mass / MOST;
        assert!((borne(0.5, limit * (1.0 - 1e-12), cell_mass) - 0.5).abs() < 1e-12);
        for mass in [0.1 * limit, 1e-6 * limit] {
            let weight = borne(0.5, mass, cell_mass);
            assert!((weight * weight / mass * cell_mass / MOST - 1.0).abs() < 1e-12);
        }
        assert!(borne(0.5, 0.0, cell_mass).abs() < f64::EPSILON);
    }
}
