//! Search for pairs of bodies that may be in contact.

use crate::grid::lattice::Lattice;
use crate::points::body::Body;
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Two bodies with bounding boxes close to each other. Tracers of the first are tested against the surface of the
/// second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<S: Space> {
    pub(crate) first: u32,
    pub(crate) second: u32,
    /// Translation of the second body, by whole periods, to its periodic image nearest to the first (m).
    pub(crate) shift: S::Vector,
}

/// Search for pairs with a coarse grid of cells. The work grows almost linearly with the number of bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs<S: Space> {
    /// Cell number and body index for every cell that a body intersects.
    reached: Vec<(u64, u32)>,
    /// Pairs that were found. Each pair appears once, with the lower body index first.
    pub(crate) found: Vec<Pair<S>>,
    /// Number of tests of two bounding boxes.
    pub(crate) tests: u64,
}

impl<S: Space> Pairs<S> {
    pub(crate) fn clear(&mut self) {
        self.found.clear();
        self.tests = 0;
    }

    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.reached) + size_of_val(&*self.found)
    }

    /// Finds all pairs whose bounding boxes are closer than `margin` (m).
    pub(crate) fn find(&mut self, bodies: &[Body], lattice: &Lattice, margin: f64) {
        self.clear();
        self.reach(bodies, lattice, margin);
        for group in self.reached.chunk_by(|a, b| a.0 == b.0) {
            for (at, &(_, a)) in group.iter().enumerate() {
                let bounds = &bodies[a as usize].bounds;
                for &(_, b) in &group[at + 1..] {
                    // Two driven bodies do not act on each other.
                    if bodies[a as usize].driven.is_some() && bodies[b as usize].driven.is_some() {
                        continue;
                    }
                    self.tests += 1;
                    let others = &bodies[b as usize].bounds;
                    let shift = shift(lattice, bounds, others);
                    let apart = (0..S::DIMENSION).any(|axis| {
                        others[0][axis] + shift[axis] > bounds[1][axis] + margin
                            || bounds[0][axis] > others[1][axis] + shift[axis] + margin
                    });
                    if !apart {
                        self.found.push(Pair { first: a, second: b, shift: S::restrict(shift) });
                    }
                }
            }
        }
        self.found.sort_unstable_by_key(|pair| (pair.first, pair.second));
        self.found.dedup_by_key(|pair| (pair.first, pair.second));
    }

    /// Finds the cells that each bounding box intersects. Boxes are enlarged by half of `margin` (m), and the result is
    /// sorted by cell and body.
    ///
    /// The cell size is the mean size of the bodies plus `margin`.
    fn reach(&mut self, bodies: &[Body], lattice: &Lattice, margin: f64) {
        self.reached.clear();
        let extent =
            |body: &Body| (0..S::DIMENSION).map(|axis| body.bounds[1][axis] - body.bounds[0][axis]).fold(0.0, f64::max);
        let sum: f64 = bodies.iter().map(extent).sum();
        let size = sum / bodies.len() as f64 + margin;
        // The number of cells in a period is whole.
        let periods = [0, 1, 2].map(|axis| {
            let length = f64::from(lattice.period[axis]?) * lattice.cell[axis];
            Some((length, (length / size).floor().max(1.0)))
        });
        for (number, body) in bodies.iter().enumerate() {
            let [mut low, mut high] = [[0_i64; 3]; 2];
            (0..S::DIMENSION).for_each(|axis| {
                let per_length = periods[axis].map_or(1.0 / size, |(length, count)| count / length);
                let cell = |at: f64| ((at - lattice.origin[axis]) * per_length).floor() as i64;
                low[axis] = cell(body.bounds[0][axis] - 0.5 * margin);
                high[axis] = cell(body.bounds[1][axis] + 0.5 * margin);
                if let Some((_, count)) = periods[axis] {
                    high[axis] = high[axis].min(low[axis] + count as i64 - 1);
                }
            });
            let number_of = |cell: [i64; 3]| {
                (0..3).fold(0, |number, axis| {
                    let at = periods[axis].map_or(cell[axis], |(_, count)| cell[axis].rem_euclid(count as i64));
                    number << 21 | (at as u64 & 0x1f_ffff)
                })
            };
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    self.reached.extend((low[0]..=high[0]).map(|x| (number_of([x, y, z]), number as u32)));
                }
            }
        }
        self.reached.sort_unstable();
    }
}

/// Returns the translation by whole periods (m) that moves the centre of the second box nearest to the centre of the
/// first.
fn shift(lattice: &Lattice, first: &[Vector3<f64>; 2], second: &[Vector3<f64>; 2]) -> Vector3<f64> {
    let mut shift = Vector3::zeros();
    for axis in 0..3 {
        if let Some(period) = lattice.period[axis] {
            let length = f64::from(period) * lattice.cell[axis];
            let between = 0.5 * (first[0][axis] + first[1][axis] - second[0][axis] - second[1][axis]);
            shift[axis] = length * (between / length).round();
        }
    }
    shift
}

impl<S: Space> Pair<S> {
    /// Returns the pair with first and second body exchanged.
    pub(crate) fn exchanged(&self) -> Self {
        Self { first: self.second, second: self.first, shift: -self.shift }
    }
}
