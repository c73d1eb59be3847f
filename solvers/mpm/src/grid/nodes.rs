//! Lattice, windows and node values of the grid.

use crate::grid::lattice::{Lattice, Node, Window};
use crate::points::body::Body;
use crate::points::share::ThreadPartition;
use crate::points::state::State;
use crate::scheme::Surroundings;
use grainbench_lanes::take_off;
use grainbench_solver::failure::Cause;
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Maximum number of nodes. A grid with more nodes is an error.
const MOST_NODES: f64 = 5e7;

/// Lattice and nodes. The nodes of all windows are stored one window after another.
#[derive(Clone, Debug)]
pub(crate) struct Grid<S: Space> {
    pub(crate) lattice: Lattice,
    pub(crate) nodes: Vec<Node<S>>,
    /// Momenta (kg m/s) that points scatter to the nodes again, later velocities (m/s) of the stress update and of tracers.
    /// If points do not scatter again, a copy of the node velocities.
    pub(crate) projected: Vec<S::Vector>,
    /// Weight limit of each node at a surface.
    pub(crate) most: Vec<f64>,
    /// Number of nodes in use.
    pub(crate) used: usize,
}

/// Consecutive nodes of a thread partition.
pub(crate) struct NodePartition<'a, S: Space> {
    pub(crate) nodes: &'a mut [Node<S>],
    pub(crate) projected: &'a mut [S::Vector],
    pub(crate) most: &'a mut [f64],
}

impl<S: Space> Grid<S> {
    /// Splits the nodes by thread partitions.
    pub(crate) fn parts(&mut self, shares: &[ThreadPartition<S>]) -> impl Iterator<Item = NodePartition<'_, S>> {
        let Self { nodes, projected, most, .. } = self;
        let (mut nodes, mut projected, mut most) = (&mut nodes[..], &mut projected[..], &mut most[..]);
        shares.iter().map(move |share| {
            let count = share.nodes.len();
            NodePartition {
                nodes: take_off(&mut nodes, count),
                projected: take_off(&mut projected, count),
                most: take_off(&mut most, count),
            }
        })
    }

    pub(crate) const fn new(lattice: Lattice) -> Self {
        Self { lattice, nodes: Vec::new(), projected: Vec::new(), most: Vec::new(), used: 0 }
    }

    /// Returns the memory in use (bytes).
    pub(crate) const fn bytes(&self) -> usize {
        self.used * (size_of::<Node<S>>() + size_of::<S::Vector>() + size_of::<f64>())
    }

    /// Assigns a window to every field.
    ///
    /// # Errors
    /// Returns the index of the body with which the number of nodes exceeds the limit or is not finite, and the cause.
    pub(crate) fn place_windows(&mut self, bodies: &mut [Body], one_field: bool) -> Result<(), (usize, Cause)> {
        let (mut start, mut count) = (0, 0.0);
        let mut all: Option<[Vector3<f64>; 2]> = None;
        if one_field {
            all = bodies.iter().map(|body| body.bounds).reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])]);
        }
        for place in 0..bodies.len() {
            if one_field && place > 0 {
                bodies[place].window = bodies[0].window;
                continue;
            }
            let [low, high] = all.unwrap_or(bodies[place].bounds);
            let wanted: f64 =
                (0..S::DIMENSION).map(|axis| (high[axis] - low[axis]) / self.lattice.cell[axis] + 3.0).product();
            count += wanted;
            if count >= MOST_NODES || count.is_nan() {
                let cause = if count.is_finite() { Cause::LeftGrid { cells: count } } else { Cause::NotFinite };
                return Err((place, cause));
            }
            let mut window: Window = self.lattice.window::<S>(S::restrict(low), S::restrict(high));
            window.start = start;
            start += window.len();
            bodies[place].window = window;
        }
        self.used = start;
        if self.nodes.len() < start {
            self.nodes.resize(start + start / 4, Node::EMPTY);
            self.projected.resize(start + start / 4, S::ORIGIN);
            self.most.resize(start + start / 4, 0.0);
        }
        Ok(())
    }

    /// Computes node velocities after the step, v ← keep v + gain (f/m + g), from momenta and forces. Stores the
    /// velocities before the step in `change`. Returns the number of nodes with mass. See [`Surroundings`] for keep
    /// and gain.
    pub(crate) fn step(&mut self, state: &State<S>, &Surroundings { gravity, keep, gain }: &Surroundings<S>) -> u64 {
        let step = |_, own: NodePartition<'_, S>| {
            let mut stepped = 0;
            for node in own.nodes {
                if node.mass > 0.0 {
                    stepped += 1;
                    let inverse = 1.0 / node.mass;
                    let before = node.velocity * inverse;
                    node.velocity = before * keep + (node.change * inverse + gravity) * gain;
                    node.change = before;
                } else {
                    (node.velocity, node.change) = (S::ORIGIN, S::ORIGIN);
                }
            }
            stepped
        };
        state.team.fold(self.parts(&state.shares), step, 0, |sum, stepped| sum + stepped)
    }

    /// Computes the velocity changes in the step without damping, v − keep v_before. Node velocities must be final.
    pub(crate) fn find_changes(&mut self, state: &State<S>, keep: f64) {
        state.team.each(self.parts(&state.shares), |_, own| {
            own.nodes.iter_mut().for_each(|node| node.change = node.velocity - node.change * keep);
        });
    }

    /// Copies the momenta or velocities of the nodes.
    pub(crate) fn project(&mut self, state: &State<S>) {
        state.team.each(self.parts(&state.shares), |_, own| {
            own.projected.iter_mut().zip(own.nodes).for_each(|(projected, node)| *projected = node.velocity);
        });
    }

    /// Divides projected momenta by mass.
    pub(crate) fn divide_projected(&mut self, state: &State<S>) {
        state.team.each(self.parts(&state.shares), |_, own| {
            for (projected, node) in own.projected.iter_mut().zip(own.nodes) {
                *projected = if node.mass > 0.0 { *projected * (1.0 / node.mass) } else { S::ORIGIN };
            }
        });
    }
}
