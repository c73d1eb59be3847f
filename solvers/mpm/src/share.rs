//! A thread's share: points that follow each other, and nodes that follow each other.
//!
//! What a point takes from nodes is found by the share that has the point; what points bring to a node is added up by the share
//! that has the node, over all runs that reach it and in their order. So the bits do not depend on how many share the work.

use crate::basis::Basis;
use crate::bodies::Body;
use crate::failure::Failure;
use crate::grid::{Lattice, Window};
use crate::ledger::Flow;
use crate::points::{Lent, Points};
use crate::runs::{self, LONGEST, Run};
use grainbench_scene::space::Space;
use std::ops::Range;

/// Fewest points in a share: with fewer threads wait for one another longer than they work.
pub(crate) const FEWEST: usize = 2000;

/// A share of points and nodes.
#[derive(Clone, Debug)]
pub(crate) struct Share<S: Space> {
    /// Its points.
    pub(crate) points: Range<usize>,
    /// Its nodes, in whole rows along x.
    pub(crate) nodes: Range<usize>,
    /// The first of its nodes that no share before reaches, nor any after that one.
    pub(crate) alone_from: usize,
    /// Where the nodes end that its points reach.
    reach: usize,
    /// The runs of its points in the step under way.
    pub(crate) runs: Vec<Run>,
    /// Those that were found before.
    pub(crate) before: Vec<Run>,
    /// Which of them are of which body.
    pub(crate) pieces: Vec<Piece>,
    /// Velocity gradients of the points at hand (1/s).
    pub(crate) gradients: Vec<S::Matrix>,
    /// What stresses tell the budget, run by run, where it is kept.
    pub(crate) flows: Vec<Flow>,
    /// The first of its points that broke.
    pub(crate) failure: Option<Failure>,
}

/// Runs of a body in a share.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Place of the body.
    pub(crate) body: usize,
    /// Its runs, among those of the share.
    pub(crate) runs: Range<usize>,
    /// The box around its points, lowest and highest along each axis (m), once they have moved.
    pub(crate) bounds: [[f64; 3]; 2],
}

/// A box with nothing in it.
pub(crate) const NO_BOX: [[f64; 3]; 2] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// The farthest way that a point goes in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Way {
    /// Its square (m²).
    pub(crate) squared: f64,
    /// Whether one goes where there is no number.
    pub(crate) is_lost: bool,
}

impl Way {
    /// The farther of two.
    pub(crate) fn farther(self, other: Self) -> Self {
        Self { squared: self.squared.max(other.squared), is_lost: self.is_lost || other.is_lost }
    }
}

impl<S: Space> Share<S> {
    /// A share with nothing in it.
    pub(crate) fn new() -> Self {
        Self {
            points: 0..0,
            nodes: 0..0,
            alone_from: 0,
            reach: 0,
            runs: Vec::new(),
            before: Vec::new(),
            pieces: Vec::new(),
            gradients: vec![S::NO_GRADIENT; LONGEST],
            flows: Vec::new(),
            failure: None,
        }
    }

    /// Its runs with their bodies.
    pub(crate) fn parts<'a>(&'a self, bodies: &'a [Body]) -> impl Iterator<Item = (&'a Body, &'a [Run])> {
        self.pieces.iter().map(|piece| (&bodies[piece.body], &self.runs[piece.runs.clone()]))
    }

    /// Puts its points where they are next, and boxes around those of each body; and which runs are known yet, for a basis
    /// that reaches from `start` on ([`Basis::START`]).
    pub(crate) fn move_points(&mut self, points: &mut Lent<'_, S>, lattice: &Lattice, start: f64) -> Way {
        let mut way = Way::default();
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

    /// Finds the runs of its points.
    pub(crate) fn find_runs<B: Basis>(&mut self, lattice: &Lattice, bodies: &[Body], points: &Points<S>) {
        std::mem::swap(&mut self.runs, &mut self.before);
        self.runs.clear();
        self.pieces.clear();
        self.reach = 0;
        let mut before = &self.before[..];
        for (body, of) in bodies.iter().enumerate() {
            let all = &of.part.points;
            let range = all.start.max(self.points.start)..all.end.min(self.points.end);
            if !range.is_empty() {
                let runs = runs::find::<S, B>(lattice, range, points, &mut before, &mut self.runs);
                let ends = self.runs[runs.clone()].iter().map(|run| of.part.window.end_of::<S, B>(run.base));
                self.reach = ends.fold(self.reach, usize::max);
                self.pieces.push(Piece { body, runs, bounds: NO_BOX });
            }
        }
    }
}

/// Cuts the points of bodies into as many ranges as there are shares, about as long as each other. Where a body is cut, the
/// points on both sides are in different cells: there every run ends, however many shares there are.
pub(crate) fn cut_points<S: Space, B: Basis>(
    shares: &mut [Share<S>],
    lattice: &Lattice,
    bodies: &[Body],
    points: &Points<S>,
) {
    let (count, total) = (shares.len(), points.len());
    let mut start = 0;
    for (number, share) in shares.iter_mut().enumerate() {
        let mut end = start.max((number + 1) * total / count);
        if number + 1 < count {
            let body = bodies.iter().map(|body| body.part.points.clone()).find(|points| points.contains(&end));
            let cell = |at: usize| lattice.first::<S, B>(points.position[at]);
            while body.as_ref().is_some_and(|body| body.start < end && end < body.end) && cell(end - 1) == cell(end) {
                end += 1;
            }
        }
        share.points = start..end;
        start = end;
    }
}

/// Cuts the nodes in use into as many ranges as there are shares, of whole rows: each share has those that its own points reach
/// first; but as many as another where all bodies are on the same.
pub(crate) fn cut_nodes<S: Space>(shares: &mut [Share<S>], bodies: &[Body], used: usize, one_field: bool) {
    let count = shares.len();
    let first_of = |(number, share): (usize, &Share<S>)| {
        if one_field {
            let row = bodies[0].part.window.size[0] as usize;
            return number * (used / row) / count * row;
        }
        let first = share.pieces.first().zip(share.runs.first());
        first.map_or(used, |(piece, run)| row_of(&bodies[piece.body].part.window, run.base))
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

/// Where the row of a node begins.
fn row_of(window: &Window, node: [i32; 3]) -> usize {
    let slot = window.slot(node);
    slot - window.along(0, node[0])
}

/// The box around positions and another box.
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
