//! Particle batches. A batch consists of consecutive points that influence the same nodes. Points are sorted by cell,
//! so most batches are long. Loops process the points of a batch four at a time with one set of nodes.

use crate::grid::basis::Basis;
use crate::grid::lattice::{Lattice, Stencil};
use crate::points::arrays::{Points, PointsMut};
use crate::points::body::{Body, extent};
use grainbench_lanes::{FourLanes, LANES, Number, SimdPack};
use grainbench_solver::space::Space;
use nalgebra::{Matrix3, Vector3};
use std::array::from_fn;
use std::ops::Range;

/// Maximum number of points in a batch. It keeps their velocity gradients in the cache.
pub(crate) const LONGEST: usize = 256;

/// Particle batch: consecutive points that influence the same nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ParticleBatch {
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// First node of the stencil block.
    pub(crate) base: [i32; 3],
    /// True if all points are known to influence these nodes at their current positions.
    pub(crate) is_known: bool,
}

impl ParticleBatch {
    /// Returns true if all positions in a box (m), given by its lower and upper corner, influence the nodes of the
    /// batch.
    pub(crate) fn holds<S: Space>(&self, lattice: &Lattice, start: f64, box_around: [[f64; 3]; 2]) -> bool {
        box_around.iter().all(|&[x, y, z]| self.reaches::<S>(lattice, start, S::restrict(Vector3::new(x, y, z))))
    }

    /// Returns true if a position (m) influences the nodes of the batch. `start` is the [`Basis::START`] of the basis.
    #[inline(always)]
    fn reaches<S: Space>(&self, lattice: &Lattice, start: f64, position: S::Vector) -> bool {
        let beyond = |axis: usize| lattice.cells::<S>(position, axis) - (f64::from(self.base[axis]) + start);
        (0..S::DIMENSION).all(|axis| (0.0..1.0).contains(&beyond(axis)))
    }

    /// Iterates over the points of the batch, four at a time.
    #[inline(always)]
    pub(crate) fn batches(&self) -> impl Iterator<Item = Batch> + use<> {
        let Self { start, end, .. } = *self;
        (start..end).step_by(LANES).map(move |at| Batch { start: at, count: (end - at).min(LANES) })
    }
}

/// Finds the batches of a range of points, appends them to `runs`, and returns their index range in `runs`.
///
/// `before` contains the batches of the previous step. If such a batch is still known and starts at the same point, its
/// points are not checked again.
pub(crate) fn find<S: Space, B: Basis>(
    lattice: &Lattice,
    range: Range<usize>,
    points: &Points<S>,
    before: &mut &[ParticleBatch],
    runs: &mut Vec<ParticleBatch>,
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
                ParticleBatch { start, end: start + 1, base, is_known: false }
            }
        };
        // If the next batch is also known and has other nodes, none of its points can belong to this batch.
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

/// Groups consecutive batches. A group has at most [`LONGEST`] points.
pub(crate) fn in_groups(mut runs: &[ParticleBatch]) -> impl Iterator<Item = &[ParticleBatch]> {
    std::iter::from_fn(move || {
        let start = runs.first()?.start;
        let count = runs.iter().take_while(|run| run.end - start <= LONGEST).count();
        let (group, rest) = runs.split_at(count);
        runs = rest;
        Some(group)
    })
}

/// Batches of a body's points, with the arrays that stencils need.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a, S: Space> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) body: &'a Body,
    pub(crate) runs: &'a [ParticleBatch],
    /// Index of the first point in the following arrays.
    pub(crate) first: usize,
    pub(crate) deformation: &'a [S::Matrix],
    pub(crate) position: &'a [S::Vector],
}

impl<'a, S: Space> Ground<'a, S> {
    #[inline(always)]
    pub(crate) fn new(lattice: &'a Lattice, body: &'a Body, runs: &'a [ParticleBatch], points: &'a Points<S>) -> Self {
        Self { lattice, body, runs, first: 0, deformation: &points.deformation, position: &points.position }
    }

    /// Creates the view from a mutable view of points, and also returns the next positions of the points (m).
    #[inline(always)]
    pub(crate) fn lent(
        lattice: &'a Lattice,
        body: &'a Body,
        runs: &'a [ParticleBatch],
        points: &'a mut PointsMut<'_, S>,
    ) -> (Self, &'a mut [S::Vector]) {
        let PointsMut { first, deformation, position, next, .. } = points;
        (Self { lattice, body, runs, first: *first, deformation, position }, next)
    }

    /// Computes the stencil of up to four points with the same nodes, one point per lane of a SIMD register.
    #[inline(always)]
    pub(crate) fn stencil<B: Basis, L: FourLanes>(
        &self,
        lanes: L,
        run: &ParticleBatch,
        batch: Batch,
    ) -> Stencil<SimdPack<L>> {
        let batch = batch.counted_from(self.first);
        let position = batch.spread_vectors::<S, L>(lanes, self.position);
        let mut half = [SimdPack::splat(lanes, self.body.half); 3];
        if B::EXTENDED {
            let mut last = None;
            let four = batch.four(self.deformation, &mut last);
            let extents = [0, 1, 2, 3].map(|lane: usize| extent::<S, B>(self.body.half, four[lane]));
            for (axis, half) in half.iter_mut().enumerate().take(S::DIMENSION) {
                let [a, b, c, d] = &extents;
                *half = batch.spread(lanes, SimdPack::four(lanes, [a[axis], b[axis], c[axis], d[axis]]));
            }
        }
        Stencil::around::<S, B>(self.lattice, run.base, position, half)
    }
}

/// Up to four consecutive points with the same nodes. Each point fills one lane of a SIMD register.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch {
    pub(crate) start: usize,
    pub(crate) count: usize,
}

/// Returns the first positions, at most four, that influence the same nodes, and the first of these nodes.
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

/// Lane masks by the number of points: one in lanes with a point, zero in the other lanes.
const OWN: [[f64; LANES]; LANES + 1] =
    [[0.0; 4], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; 4]];

impl Batch {
    /// Returns the same points with indices relative to `first`.
    #[inline(always)]
    pub(crate) const fn counted_from(self, first: usize) -> Self {
        Self { start: self.start - first, ..self }
    }

    /// Returns the values of the points. Lanes without a point get the value of another point.
    #[inline(always)]
    fn four<'a, T: Copy>(self, values: &'a [T], last: &'a mut Option<[T; LANES]>) -> &'a [T; LANES] {
        match values[self.start..].first_chunk() {
            Some(four) => four,
            None => last.insert(self.last(values)),
        }
    }

    /// Returns the last values of an array that has fewer than four left. The last value is repeated.
    #[cold]
    fn last<T: Copy>(self, values: &[T]) -> [T; LANES] {
        from_fn(|lane| values[(self.start + lane).min(values.len() - 1)])
    }

    /// Returns the positions of the points (m) by component, for a stencil. Lanes without a point use the same nodes.
    #[inline(always)]
    pub(crate) fn spread_vectors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Vector]) -> [SimdPack<L>; 3] {
        let mut vectors = self.vectors::<S, L>(lanes, values);
        for vector in vectors.iter_mut().take(S::DIMENSION) {
            *vector = self.spread(lanes, *vector);
        }
        vectors
    }

    /// Sets lanes without a point to the value of the first point, so that all lanes use the nodes of the batch.
    #[inline(always)]
    fn spread<L: FourLanes>(self, lanes: L, values: SimdPack<L>) -> SimdPack<L> {
        let [first, ..] = values.values();
        values.like(0.0).pick_below(SimdPack::four(lanes, OWN[self.count]), values, values.like(first))
    }

    /// Returns an extensive quantity of each point, such as mass, with zero in lanes without a point.
    #[inline(always)]
    pub(crate) fn amounts<L: FourLanes>(self, lanes: L, values: &[f64]) -> SimdPack<L> {
        let mut last = None;
        SimdPack::four(lanes, *self.four(values, &mut last)) * SimdPack::four(lanes, OWN[self.count])
    }

    /// Returns a vector of each point, by component.
    #[inline(always)]
    pub(crate) fn vectors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Vector]) -> [SimdPack<L>; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let mut vectors = [SimdPack::splat(lanes, 0.0); 3];
        for (axis, vector) in vectors.iter_mut().enumerate().take(S::DIMENSION) {
            let four = [S::component(a, axis), S::component(b, axis), S::component(c, axis), S::component(d, axis)];
            *vector = SimdPack::four(lanes, four);
        }
        vectors
    }

    /// Returns a matrix of each point, by rows.
    #[inline(always)]
    pub(crate) fn matrices<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Matrix]) -> [[SimdPack<L>; 3]; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let four = [S::embed_gradient(a), S::embed_gradient(b), S::embed_gradient(c), S::embed_gradient(d)];
        side_by_side::<S, L>(lanes, &four)
    }

    /// Returns a symmetric tensor of each point, by rows, with the components along the axes of this space.
    #[inline(always)]
    pub(crate) fn tensors<S: Space, L: FourLanes>(self, lanes: L, values: &[S::Symmetric]) -> [[SimdPack<L>; 3]; 3] {
        let mut last = None;
        let [a, b, c, d] = *self.four(values, &mut last);
        let four = [S::embed_symmetric(a), S::embed_symmetric(b), S::embed_symmetric(c), S::embed_symmetric(d)];
        side_by_side::<S, L>(lanes, &four)
    }

    /// Writes a vector for each point.
    #[inline(always)]
    pub(crate) fn write_vectors<S: Space, L: FourLanes>(self, vectors: [SimdPack<L>; 3], to: &mut [S::Vector]) {
        let [x, y, z] = [vectors[0].values(), vectors[1].values(), vectors[2].values()];
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict(Vector3::new(x[lane], y[lane], z[lane]));
        }
    }

    /// Writes a matrix, given by rows, for each point.
    #[inline(always)]
    pub(crate) fn write_matrices<S: Space, L: FourLanes>(self, rows: [[SimdPack<L>; 3]; 3], to: &mut [S::Matrix]) {
        let mut values = [[[0.0; LANES]; 3]; 3];
        for (values, row) in values.iter_mut().zip(rows) {
            *values = [row[0].values(), row[1].values(), row[2].values()];
        }
        for (lane, to) in to[self.start..self.start + self.count].iter_mut().enumerate() {
            *to = S::restrict_gradient(Matrix3::from_fn(|row, column| values[row][column][lane]));
        }
    }
}

/// Packs four matrices by rows, with the components along the axes of this space.
#[inline(always)]
fn side_by_side<S: Space, L: FourLanes>(lanes: L, [a, b, c, d]: &[Matrix3<f64>; LANES]) -> [[SimdPack<L>; 3]; 3] {
    let mut rows = [[SimdPack::splat(lanes, 0.0); 3]; 3];
    for (row, to) in rows.iter_mut().enumerate().take(S::DIMENSION) {
        for (column, to) in to.iter_mut().enumerate().take(S::DIMENSION) {
            let at = (row, column);
            *to = SimdPack::four(lanes, [a[at], b[at], c[at], d[at]]);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::basis::{Linear, Quadratic};
    use crate::points::share::{NO_BOX, enclose};
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;

    const LATTICE: Lattice = Lattice { cell: [0.5; 3], inverse: [2.0; 3], origin: [0.1; 3], period: [None; 3] };

    /// Returns a pseudo-random number between -1 and 1.
    fn draw(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Checks the search for batches with points that move at random. A few points change cells in each step. A search
    /// that reuses known batches must find the same batches as a search without them. Some cells have more points than
    /// the longest batch.
    fn found_as_by_whoever_knows_nothing<B: Basis>(spread: f64) {
        let mut state = 7;
        let mut points = Points::<Plane>::default();
        for _ in 0..900 {
            points.push(Vector2::new(spread * draw(&mut state), spread * draw(&mut state)), 1.0, 1.0);
        }
        let order = points.order(0..900, |position| {
            let [x, y, _] = LATTICE.first::<Plane, B>(position);
            (100 * (y + 50) + x + 50) as usize
        });
        points.put_in(&[order], &grainbench_lanes::Team::default());
        let (mut runs, mut known, mut unknown): (Vec<ParticleBatch>, usize, usize) = Default::default();
        for step in 0..150 {
            let before = std::mem::take(&mut runs);
            known += before.iter().filter(|run| run.is_known).count();
            unknown += before.iter().filter(|run| !run.is_known).count();
            // Two ranges of points. The boundary between them changes in some steps, as between thread partitions.
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
