//! Thread partitions. A partition consists of consecutive points and consecutive nodes that one thread handles.
//!
//! Each partition gathers velocities for its points. For each of its nodes, it sums over all batches that influence the
//! node, in the order of the batches. Results are therefore equal to the bit for any number of threads.

use crate::energy::ledger::Flow;
use crate::failure::Failure;
use crate::grid::basis::Basis;
use crate::grid::lattice::{Lattice, Window};
use crate::points::arrays::{Points, PointsMut};
use crate::points::body::Body;
use crate::points::runs::{self, LONGEST, ParticleBatch};
use grainbench_solver::space::Space;
use std::ops::Range;

/// Minimum number of points in a partition. With fewer points, threads mostly wait for each other.
pub(crate) const FEWEST: usize = 2000;

/// Points and nodes of one thread, with the batches of the points.
#[derive(Clone, Debug, Default)]
pub(crate) struct ThreadPartition<S: Space> {
    /// Range of points in the common point arrays.
    pub(crate) points: Range<usize>,
    /// Range of nodes in the common node array, in whole rows along x.
    pub(crate) nodes: Range<usize>,
    /// Slot of the first node of the partition for which this holds: no earlier partition influences this node or a
    /// later node.
    pub(crate) alone_from: usize,
    /// End of the range of nodes that the points of the partition influence.
    reach: usize,
    /// Batches of the partition's points in the current step.
    pub(crate) runs: Vec<ParticleBatch>,
    /// Batches of the previous step.
    pub(crate) before: Vec<ParticleBatch>,
    /// Ranges of batches by body.
    pub(crate) pieces: Vec<BodyBatches>,
    /// Velocity gradients of the current points (1/s).
    pub(crate) gradients: Vec<S::Matrix>,
    /// Energies of stresses for the budget, batch by batch, if requested.
    pub(crate) flows: Vec<Flow>,
    /// First failure of a point of the partition.
    pub(crate) failure: Option<Failure>,
}

/// Particle batches of one body in a partition.
#[derive(Clone, Debug)]
pub(crate) struct BodyBatches {
    pub(crate) body: usize,
    /// Range of the batches within the partition.
    pub(crate) runs: Range<usize>,
    /// Bounding box of the points after they have moved, lower and upper corner (m).
    pub(crate) bounds: [[f64; 3]; 2],
}

/// Empty bounding box.
pub(crate) const NO_BOX: [[f64; 3]; 2] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// Largest displacement of a point in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LargestDisplacement {
    /// Square of the displacement (m²).
    pub(crate) squared: f64,
    /// True if any displacement is NaN.
    pub(crate) is_lost: bool,
}

impl LargestDisplacement {
    /// Returns the larger of two displacements.
    pub(crate) fn farther(self, other: Self) -> Self {
        Self { squared: self.squared.max(other.squared), is_lost: self.is_lost || other.is_lost }
    }
}

impl<S: Space> ThreadPartition<S> {
    pub(crate) fn new() -> Self {
        Self { gradients: vec![S::NO_GRADIENT; LONGEST], ..Self::default() }
    }

    /// Iterates over the batches of the partition, body by body.
    pub(crate) fn parts<'a>(&'a self, bodies: &'a [Body]) -> impl Iterator<Item = (&'a Body, &'a [ParticleBatch])> {
        self.pieces.iter().map(|piece| (&bodies[piece.body], &self.runs[piece.runs.clone()]))
    }

    /// Moves the points of the partition to their next positions and computes the bounding boxes of bodies. Sets
    /// `is_known` of each batch: true if all its points influence the nodes of its stencil block at the new positions.
    ///
    /// `start` is the [`Basis::START`] of the basis. Returns the largest displacement.
    pub(crate) fn move_points(
        &mut self,
        points: &mut PointsMut<'_, S>,
        lattice: &Lattice,
        start: f64,
    ) -> LargestDisplacement {
        let mut way = LargestDisplacement::default();
        for piece in &mut self.pieces {
            piece.bounds = NO_BOX;
            for run in &mut self.runs[piece.runs.clone()] {
                let range = run.start - points.first..run.end - points.first;
                let mut around = NO_BOX;
                for (position, next) in points.position[range.clone()].iter_mut().zip(&points.next[range]) {
                    let along = *next - *position;
                    let squared = S::dot(along, along);
                    way.is_lost |= squared.is_nan();
                    way.squared = way.squared.max(squared);
                    *position = *next;
                    around = enclose::<S>(around, &[*next]);
                }
                run.is_known = run.holds::<S>(lattice, start, around);
                for axis in 0..S::DIMENSION {
                    let [low, high] = &mut piece.bounds;
                    low[axis] = low[axis].min(around[0][axis]);
                    high[axis] = high[axis].max(around[1][axis]);
                }
            }
        }
        way
    }

    /// Finds the batches of the partition's points.
    pub(crate) fn find_runs<B: Basis>(&mut self, lattice: &Lattice, bodies: &[Body], points: &Points<S>) {
        std::mem::swap(&mut self.runs, &mut self.before);
        self.runs.clear();
        self.pieces.clear();
        self.reach = 0;
        let mut before = &self.before[..];
        for (place, body) in bodies.iter().enumerate() {
            let all = &body.points;
            let range = all.start.max(self.points.start)..all.end.min(self.points.end);
            if !range.is_empty() {
                let runs = runs::find::<S, B>(lattice, range, points, &mut before, &mut self.runs);
                let ends = self.runs[runs.clone()].iter().map(|run| body.window.end_of::<S, B>(run.base));
                self.reach = ends.fold(self.reach, usize::max);
                self.pieces.push(BodyBatches { body: place, runs, bounds: NO_BOX });
            }
        }
    }
}

/// Splits the points of bodies into ranges of about equal length, one for each partition.
///
/// A body is split only between points in different cells. A batch ends between such points for any number of
/// partitions.
pub(crate) fn cut_points<S: Space, B: Basis>(
    shares: &mut [ThreadPartition<S>],
    lattice: &Lattice,
    bodies: &[Body],
    points: &Points<S>,
) {
    let (count, total) = (shares.len(), points.len());
    let mut start = 0;
    for (number, share) in shares.iter_mut().enumerate() {
        let mut end = start.max((number + 1) * total / count);
        if number + 1 < count {
            let body = bodies.iter().map(|body| body.points.clone()).find(|points| points.contains(&end));
            let cell = |at: usize| lattice.first::<S, B>(points.position[at]);
            while body.as_ref().is_some_and(|body| body.start < end && end < body.end) && cell(end - 1) == cell(end) {
                end += 1;
            }
        }
        share.points = start..end;
        start = end;
    }
}

/// Splits the nodes in use into ranges of whole rows, one for each partition.
///
/// The range of a partition starts at the first row that the points of the partition influence. If all bodies share one
/// velocity field, all ranges have nearly the same length.
pub(crate) fn cut_nodes<S: Space>(shares: &mut [ThreadPartition<S>], bodies: &[Body], used: usize, one_field: bool) {
    let count = shares.len();
    let first_of = |(number, share): (usize, &ThreadPartition<S>)| {
        if one_field {
            let row = bodies[0].window.size[0] as usize;
            return number * (used / row) / count * row;
        }
        let first = share.pieces.first().zip(share.runs.first());
        first.map_or(used, |(piece, run)| row_of(&bodies[piece.body].window, run.base))
    };
    let firsts: Vec<usize> = shares.iter().enumerate().map(first_of).collect();
    let mut end = used;
    for (share, first) in shares.iter_mut().zip(firsts).rev() {
        share.nodes = first.min(end)..end;
        end = share.nodes.start;
    }
    shares[0].nodes.start = 0;
    let mut reach = 0;
    for share in shares {
        share.alone_from = reach.clamp(share.nodes.start, share.nodes.end);
        reach = reach.max(share.reach);
    }
}

/// Returns the slot at the start of a node's row.
fn row_of(window: &Window, node: [i32; 3]) -> usize {
    let slot = window.slot(node);
    slot - window.along(0, node[0])
}

/// Returns the bounding box of a box and of positions (m).
#[inline(always)]
pub(crate) fn enclose<S: Space>([mut low, mut high]: [[f64; 3]; 2], positions: &[S::Vector]) -> [[f64; 3]; 2] {
    for &position in positions {
        for axis in 0..S::DIMENSION {
            let at = S::component(position, axis);
            low[axis] = if at < low[axis] { at } else { low[axis] };
            high[axis] = if at > high[axis] { at } else { high[axis] };
        }
    }
    [low, high]
}
