//! Points that follow each other and reach the same nodes. Kept in the order of their cells most do, and loops over
//! points take them four by four, each four with one set of nodes.

use crate::basis::Basis;
use crate::grid::{Lattice, Stencil};
use crate::points::{Lent, Points};
use crate::transfer::Part;
use grainbench_lanes::{FourLanes, LANES, Number, Wide};
use grainbench_scene::space::Space;
use nalgebra::{Matrix3, Vector3};
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
    /// Whether all of its points, where they are now, are known to reach these nodes.
    pub(crate) is_known: bool,
}

impl Run {
    /// Whether it holds what is in a box (m), the lowest and the highest along each axis.
    pub(crate) fn holds<S: Space>(&self, lattice: &Lattice, start: f64, box_around: [[f64; 3]; 2]) -> bool {
        box_around.iter().all(|&[x, y, z]| self.reaches::<S>(lattice, start, S::restrict(Vector3::new(x, y, z))))
    }

    /// Whether a position (m) reaches the nodes of the run, of a basis that reaches from `start` on ([`Basis::START`]).
    #[inline(always)]
    fn reaches<S: Space>(&self, lattice: &Lattice, start: f64, position: S::Vector) -> bool {
        let beyond = |axis: usize| lattice.cells::<S>(position, axis) - (f64::from(self.base[axis]) + start);
        (0..S::DIMENSION).all(|axis| (0.0..1.0).contains(&beyond(axis)))
    }
}

/// Finds the runs of a range of points; which they are among all. Of a run that was found `before`, is known yet and starts where
/// one starts now, the points need not be looked at.
pub(crate) fn find<S: Space, B: Basis>(
    lattice: &Lattice,
    range: Range<usize>,
    points: &Points<S>,
    before: &mut &[Run],
    runs: &mut Vec<Run>,
) -> Range<usize> {
    let first = runs.len();
    let mut start = range.start;
    while start < range.end {
        *before = &before[before.iter().take_while(|run| run.start < start).count()..];
        let (same, next) = (before.first(), before.get(1));
        let mut run = match same.filter(|run| run.start == start && run.is_known && run.end <= range.end) {
            Some(same) => *same,
            None => {
                let base = lattice.first::<S, B>(points.position[start]);
                Run { start, end: start + 1, base, is_known: false }
            }
        };
        // Where the next run is known as well, to be elsewhere, none of its points have come.
        let is_whole =
            run.is_known && next.is_some_and(|next| next.start == run.end && next.is_known && next.base != run.base);
        let more = if is_whole { run.end..run.end } else { run.end..range.end.min(start + LONGEST) };
        let reach = |at: &usize| run.reaches::<S>(lattice, B::START, points.position[*at]);
        run.end += more.take_while(reach).count();
        run.is_known = true;
        start = run.end;
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
    /// Number of the first point of which the following are given.
    pub(crate) first: usize,
    pub(crate) deformation: &'a [S::Matrix],
    pub(crate) position: &'a [S::Vector],
}

impl<'a, S: Space> Ground<'a, S> {
    #[inline(always)]
    pub(crate) fn new(lattice: &'a Lattice, part: &'a Part, runs: &'a [Run], points: &'a Points<S>) -> Self {
        Self { lattice, part, runs, first: 0, deformation: &points.deformation, position: &points.position }
    }

    /// Of points that are lent.
    #[inline(always)]
    pub(crate) fn lent(lattice: &'a Lattice, part: &'a Part, runs: &'a [Run], points: &'a Lent<'_, S>) -> Self {
        Self { lattice, part, runs, first: points.first, deformation: points.deformation, position: points.position }
    }

    /// Of points that are lent, with their next positions (m).
    #[inline(always)]
    pub(crate) fn and_next(
        lattice: &'a Lattice,
        part: &'a Part,
        runs: &'a [Run],
        points: &'a mut Lent<'_, S>,
    ) -> (Self, &'a mut [S::Vector]) {
        let Lent { first, deformation, position, next, .. } = points;
        (Self { lattice, part, runs, first: *first, deformation, position }, next)
    }

    /// The nodes around a batch of a run.
    #[inline(always)]
    pub(crate) fn stencil<B: Basis, L: FourLanes>(&self, lanes: L, run: &Run, batch: Batch) -> Stencil<Wide<L>> {
        let batch = batch.counted_from(self.first);
        let position = batch.spread_vectors::<S, L>(lanes, self.position);
        let mut half = [Wide::splat(lanes, self.part.half); 3];
        if B::EXTENDED {
            let mut last = None;
            let four = batch.four(self.deformation, &mut last);
            let extents = [0, 1, 2, 3].map(|lane: usize| self.part.extent::<S, B>(four[lane]));
            for (axis, half) in half.iter_mut().enumerate().take(S::DIMENSION) {
                let [a, b, c, d] = &extents;
                *half = batch.spread(lanes, Wide::four(lanes, [a[axis], b[axis], c[axis], d[axis]]));
            }
        }
        Stencil::around::<S, B>(self.lattice, run.base, position, half)
    }
}

/// Up to four points of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch {
    pub(crate) start: usize,
    pub(crate) count: usize,
}

/// The first of some positions with those after it, up to four in all, that reach the same nodes; and the first of
/// these nodes.
#[inline(always)]
pub(crate) fn first_batch<S: Space, B: Basis>(
    lattice: &Lattice,
    range: Range<usize>,
    positions: &[S::Vector],
) -> (Batch, [i32; 3]) {
    let base = lattice.first::<S, B>(positions[range.start]);
    let mut same = true;
    let mut count = 1;
    for &position in positions[range.clone()].iter().take(LANES).skip(1) {
        same &= lattice.first::<S, B>(position) == base;
        count += usize::from(same);
    }
    (Batch { start: range.start, count }, base)
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

    /// What its points have. FourLanes without a point get that of another one.
    #[inline(always)]
    fn four<'a, T: Copy>(self, values: &'a [T], last: &'a mut Option<[T; LANES]>) -> &'a [T; LANES] {
        match values[self.start..].first_chunk() {
            Some(four) => four,
            None => last.insert(self.last(values)),
        }
    }

    /// Fewer than four are left.
    #[cold]
    fn last<T: Copy>(self, values: &[T]) -> [T; LANES] {
        from_fn(|lane| values[(self.start + lane).min(values.len() - 1)])
    }

    /// The positions of its points (m), by component, for a stencil: all of them are among the same nodes.
    #[inline(always)]
    pub(crate) fn spread_vectors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Vector]) -> [Wide<L>; 3] {
        let mut vectors = self.vectors::<S, L>(lanes, values);
        for vector in vectors.iter_mut().take(S::DIMENSION) {
            *vector = self.spread(lanes, *vector);
        }
        vectors
    }

    /// FourLanes without a point get what the first one has, so that all are among the nodes of the run.
    #[inline(always)]
    fn spread<L: FourLanes>(self, lanes: L, of: Wide<L>) -> Wide<L> {
        let [first, ..] = of.values();
        of.like(0.0).pick_below(Wide::four(lanes, OWN[self.count]), of, of.like(first))
    }

    /// A number of each point, such as a mass; zero in lanes without one.
    #[inline(always)]
    pub(crate) fn amounts<L: FourLanes>(self, lanes: L, values: &[f64]) -> Wide<L> {
        let mut last = None;
        Wide::four(lanes, *self.four(values, &mut last)) * Wide::four(lanes, OWN[self.count])
    }

    /// A vector of each point, by component.
    #[inline(always)]
    pub(crate) fn vectors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Vector]) -> [Wide<L>; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let mut vectors = [Wide::splat(lanes, 0.0); 3];
        for (axis, vector) in vectors.iter_mut().enumerate().take(S::DIMENSION) {
            let four = [S::component(a, axis), S::component(b, axis), S::component(c, axis), S::component(d, axis)];
            *vector = Wide::four(lanes, four);
        }
        vectors
    }

    /// A matrix of each point, row by row.
    #[inline(always)]
    pub(crate) fn matrices<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Matrix]) -> [[Wide<L>; 3]; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let four = [S::embed_gradient(a), S::embed_gradient(b), S::embed_gradient(c), S::embed_gradient(d)];
        side_by_side::<S, L>(lanes, &four)
    }

    /// What of a symmetric tensor of each point acts in this space, row by row.
    #[inline(always)]
    pub(crate) fn tensors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Symmetric]) -> [[Wide<L>; 3]; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let four = [S::embed_symmetric(a), S::embed_symmetric(b), S::embed_symmetric(c), S::embed_symmetric(d)];
        side_by_side::<S, L>(lanes, &four)
    }

    /// Writes a vector for each point.
    #[inline(always)]
    pub(crate) fn write_vectors<S: Space, L: FourLanes>(self, vectors: [Wide<L>; 3], to: &mut [S::Vector]) {
        let [x, y, z] = [vectors[0].values(), vectors[1].values(), vectors[2].values()];
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict(Vector3::new(x[lane], y[lane], z[lane]));
        }
    }

    /// Writes a matrix, given row by row, for each point.
    #[inline(always)]
    pub(crate) fn write_matrices<S: Space, L: FourLanes>(self, rows: [[Wide<L>; 3]; 3], to: &mut [S::Matrix]) {
        let mut values = [[[0.0; LANES]; 3]; 3];
        for (values, row) in values.iter_mut().zip(rows) {
            *values = [row[0].values(), row[1].values(), row[2].values()];
        }
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict_gradient(Matrix3::from_fn(|row, column| values[row][column][lane]));
        }
    }
}

/// What of four matrices acts in this space, row by row.
#[inline(always)]
fn side_by_side<S: Space, L: FourLanes>(lanes: L, [a, b, c, d]: &[Matrix3<f64>; LANES]) -> [[Wide<L>; 3]; 3] {
    let mut rows = [[Wide::splat(lanes, 0.0); 3]; 3];
    for (row, to) in rows.iter_mut().enumerate().take(S::DIMENSION) {
        for (column, to) in to.iter_mut().enumerate().take(S::DIMENSION) {
            let at = (row, column);
            *to = Wide::four(lanes, [a[at], b[at], c[at], d[at]]);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::{Linear, Quadratic};
    use crate::share::{NO_BOX, enclose};
    use grainbench_scene::space::Plane;
    use nalgebra::Vector2;

    const LATTICE: Lattice = Lattice { cell: [0.5; 3], inverse: [2.0; 3], origin: [0.1; 3], period: [None; 3] };

    /// Numbers between -1 and 1 in no order that matters.
    fn draw(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Points wander, a few of them into other cells in each step: the runs that are found where others are known are those
    /// of a search that knows none. There are cells with more points than the longest run has.
    fn found_as_by_whoever_knows_nothing<B: Basis>(spread: f64) {
        let mut state = 7;
        let mut points = Points::<Plane>::new();
        for _ in 0..900 {
            points.push(Vector2::new(spread * draw(&mut state), spread * draw(&mut state)), 1.0, 1.0);
        }
        let order = points.order(0..900, |position| {
            let [x, y, _] = LATTICE.first::<Plane, B>(position);
            (100 * (y + 50) + x + 50) as usize
        });
        points.put_in(&[order], &grainbench_lanes::Team::default());
        let (mut runs, mut known, mut unknown): (Vec<Run>, usize, usize) = Default::default();
        for step in 0..150 {
            let before = std::mem::take(&mut runs);
            known += before.iter().filter(|run| run.is_known).count();
            unknown += before.iter().filter(|run| !run.is_known).count();
            // Two bodies, and now and then other shares.
            let cut = if step % 10 == 0 { 450 } else { 300 };
            let (mut left, mut none) = (&before[..], &[][..]);
            let mut expected = Vec::new();
            for range in [0..cut, cut..900] {
                let found = find::<Plane, B>(&LATTICE, range.clone(), &points, &mut left, &mut runs);
                assert_eq!(find::<Plane, B>(&LATTICE, range, &points, &mut none, &mut expected), found);
            }
            assert_eq!(format!("{runs:?}"), format!("{expected:?}"), "step {step}");
            for at in 0..900 {
                points.position[at] += Vector2::new(draw(&mut state), draw(&mut state)) * 2e-3;
            }
            for run in &mut runs {
                let around = enclose::<Plane>(NO_BOX, &points.position[run.start..run.end]);
                run.is_known = run.holds::<Plane>(&LATTICE, B::START, around);
            }
        }
        assert!(known > 100 && unknown > 100, "{known} known, {unknown} not");
    }

    #[test]
    fn runs_are_those_of_a_search_that_knows_none() {
        for spread in [2.0, 0.6] {
            found_as_by_whoever_knows_nothing::<Quadratic>(spread);
            found_as_by_whoever_knows_nothing::<Linear>(spread);
        }
    }
}
