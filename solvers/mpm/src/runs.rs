//! Points that follow each other and reach the same nodes. Kept in the order of their cells most do, and loops over points take them
//! four by four, each four with one set of nodes.

use crate::basis::Basis;
use crate::grid::{Lattice, Stencil};
use crate::lanes::{Four, LANES, Lanes, Number};
use crate::points::Points;
use crate::transfer::Part;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::array::from_fn;
use std::ops::Range;

/// Points of a run at most: few enough for their velocity gradients to stay in the cache.
pub(crate) const LONGEST: usize = 256;

/// Points that follow each other and reach the same nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// The first of the nodes.
    pub(crate) base: [i32; 3],
}

/// Finds the runs of a range of points; which they are among all.
pub(crate) fn find<S: Space, B: Basis>(
    lattice: &Lattice,
    range: Range<usize>,
    points: &Points<S>,
    runs: &mut Vec<Run>,
) -> Range<usize> {
    let first = runs.len();
    let mut run = Run { start: range.start, end: range.start, base: [0; 3] };
    for (at, &position) in range.clone().zip(&points.position[range]) {
        let base = lattice.first::<S, B>(position);
        if base != run.base || at - run.start == LONGEST {
            if run.start < at {
                runs.push(run);
            }
            run = Run { start: at, end: at, base };
        }
        run.end = at + 1;
    }
    if run.start < run.end {
        runs.push(run);
    }
    first..runs.len()
}

/// Runs one after another that have no more points in all than the longest can have.
pub(crate) fn in_groups(mut runs: &[Run]) -> impl Iterator<Item = &[Run]> {
    std::iter::from_fn(move || {
        let start = runs.first()?.start;
        let count = runs.iter().take_while(|run| run.end - start <= LONGEST).count();
        let (group, rest) = runs.split_at(count);
        runs = rest;
        Some(group)
    })
}

/// Runs of a part, or some of them, on their grid.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a, S: Space> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) part: &'a Part,
    pub(crate) runs: &'a [Run],
    pub(crate) deformation: &'a [S::Matrix],
    pub(crate) position: &'a [S::Vector],
}

impl<'a, S: Space> Ground<'a, S> {
    #[inline(always)]
    pub(crate) fn new(lattice: &'a Lattice, part: &'a Part, runs: &'a [Run], points: &'a Points<S>) -> Self {
        Self { lattice, part, runs, deformation: &points.deformation, position: &points.position }
    }

    /// The nodes around a batch of a run.
    #[inline(always)]
    pub(crate) fn stencil<B: Basis, L: Lanes>(&self, lanes: L, run: &Run, batch: Batch) -> Stencil<Four<L>> {
        let position = batch.vectors::<S, L>(lanes, self.position).map(|at| batch.spread(lanes, at));
        let half = if B::EXTENDED {
            let extents = batch.read(self.deformation, |four| four.map(|at| self.part.extent::<S, B>(at)));
            from_fn(|axis| batch.spread(lanes, Four::new(lanes, extents.map(|extent| extent[axis]))))
        } else {
            [Four::splat(lanes, self.part.half); 3]
        };
        Stencil::around::<S, B>(self.lattice, run.base, position, half)
    }
}

/// Up to four points of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch {
    start: usize,
    count: usize,
}

/// One for each lane that has a point, zero for the others.
const OWN: [[f64; LANES]; LANES + 1] =
    [[0.0; 4], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; 4]];

impl Run {
    /// Its points, four by four.
    #[inline(always)]
    pub(crate) fn batches(&self) -> impl Iterator<Item = Batch> + use<> {
        let Self { start, end, .. } = *self;
        (start..end).step_by(LANES).map(move |at| Batch { start: at, count: (end - at).min(LANES) })
    }
}

impl Batch {
    /// The same points in a list that starts at another point.
    #[inline(always)]
    pub(crate) const fn counted_from(self, first: usize) -> Self {
        Self { start: self.start - first, ..self }
    }

    /// What is read from its points. Lanes without a point get that of another one.
    #[inline(always)]
    fn read<T: Copy, R>(self, values: &[T], read: impl Fn(&[T; LANES]) -> R) -> R {
        let last;
        let four = match values[self.start..].first_chunk() {
            Some(four) => four,
            None => {
                last = self.last(values);
                &last
            }
        };
        read(four)
    }

    /// Fewer than four are left.
    #[cold]
    fn last<T: Copy>(self, values: &[T]) -> [T; LANES] {
        from_fn(|lane| values[(self.start + lane).min(values.len() - 1)])
    }

    /// Lanes without a point get what the first one has, so that all are among the nodes of the run.
    #[inline(always)]
    fn spread<L: Lanes>(self, lanes: L, of: Four<L>) -> Four<L> {
        let [first, ..] = of.values();
        of.like(0.0).pick_below(Four::new(lanes, OWN[self.count]), of, of.like(first))
    }

    /// A number of each point, such as a mass; zero in lanes without one.
    #[inline(always)]
    pub(crate) fn amounts<L: Lanes>(self, lanes: L, values: &[f64]) -> Four<L> {
        self.read(values, |four| Four::new(lanes, *four)) * Four::new(lanes, OWN[self.count])
    }

    /// A vector of each point, by component.
    #[inline(always)]
    pub(crate) fn vectors<S: Space, L: Lanes>(self, lanes: L, values: &[S::Vector]) -> [Four<L>; 3] {
        let zero = Four::splat(lanes, 0.0);
        self.read(values, |four| {
            let of = |axis| Four::new(lanes, four.map(|vector| S::component(vector, axis)));
            from_fn(|axis| if axis < S::DIMENSION { of(axis) } else { zero })
        })
    }

    /// A matrix of each point, row by row.
    #[inline(always)]
    pub(crate) fn matrices<S: Space, L: Lanes>(self, lanes: L, values: &[S::Matrix]) -> [[Four<L>; 3]; 3] {
        let zero = Four::splat(lanes, 0.0);
        self.read(values, |four| {
            let of = |at| Four::new(lanes, four.map(|matrix| S::embed_gradient(matrix)[at]));
            let inside = |row, column| row < S::DIMENSION && column < S::DIMENSION;
            from_fn(|row| from_fn(|column| if inside(row, column) { of((row, column)) } else { zero }))
        })
    }

    /// What of a symmetric tensor of each point acts in this space, row by row.
    #[inline(always)]
    pub(crate) fn tensors<S: Space, L: Lanes>(self, lanes: L, values: &[S::Symmetric]) -> [[Four<L>; 3]; 3] {
        let zero = Four::splat(lanes, 0.0);
        self.read(values, |four| {
            let of = |at| Four::new(lanes, four.map(|tensor| S::embed_symmetric(tensor)[at]));
            let inside = |row, column| row < S::DIMENSION && column < S::DIMENSION;
            from_fn(|row| from_fn(|column| if inside(row, column) { of((row, column)) } else { zero }))
        })
    }

    /// Writes a vector for each point.
    #[inline(always)]
    pub(crate) fn write_vectors<S: Space, L: Lanes>(self, vectors: [Four<L>; 3], to: &mut [S::Vector]) {
        let [x, y, z] = vectors.map(Four::values);
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict(Vector3::new(x[lane], y[lane], z[lane]));
        }
    }

    /// Writes a matrix, given row by row, for each point.
    #[inline(always)]
    pub(crate) fn write_matrices<S: Space, L: Lanes>(self, rows: [[Four<L>; 3]; 3], to: &mut [S::Matrix]) {
        let rows = rows.map(|row| row.map(Four::values));
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict_gradient(nalgebra::Matrix3::from_fn(|row, column| rows[row][column][lane]));
        }
    }
}
