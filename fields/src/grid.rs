//! A regular grid of cells.

use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;
use std::ops::Range;

/// Equal cells that fill a box. In two dimensions the grid is one cell deep, from z = −½ to z = ½.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Lower corner (m).
    pub low: Vector3<f64>,
    /// Size of a cell (m).
    pub cell: Vector3<f64>,
    /// Number of cells along each axis.
    pub count: [usize; 3],
}

impl Grid {
    /// Returns cells of about `size` (m) that fill the box from `low` to `high` (m).
    #[must_use]
    pub fn filling((low, high): (Vector3<f64>, Vector3<f64>), size: Vector3<f64>) -> Self {
        let count = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / size[axis]).round().max(1.0) as usize);
        let cell = Vector3::from_fn(|axis, _| (high[axis] - low[axis]) / count[axis] as f64);
        Self { low, cell, count }
    }

    /// Returns the number of cells.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.count.iter().product()
    }

    /// Returns the volume of a cell (m³; m² in two dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.cell.product()
    }

    /// Returns the lower corner (m) of the cell with the given index along each axis.
    #[must_use]
    pub fn corner(&self, at: [usize; 3]) -> Vector3<f64> {
        self.low + Vector3::from_fn(|axis, _| at[axis] as f64 * self.cell[axis])
    }

    /// Returns the centre of a cell (m).
    #[must_use]
    pub fn middle(&self, place: usize) -> Vector3<f64> {
        self.corner(self.at(place)) + self.cell * 0.5
    }

    /// Returns the index of a cell in the list of all cells; x varies fastest.
    #[must_use]
    pub const fn place(&self, at: [usize; 3]) -> usize {
        at[0] + self.count[0] * (at[1] + self.count[1] * at[2])
    }

    /// Returns the index of a cell along each axis, from its index in the list of all cells.
    #[must_use]
    pub const fn at(&self, place: usize) -> [usize; 3] {
        let [across, deep, _] = self.count;
        [place % across, place / across % deep, place / (across * deep)]
    }

    /// Returns the index of the cell that contains a point (m), or `None` if the point is outside the grid.
    #[must_use]
    pub fn find(&self, point: Vector3<f64>) -> Option<usize> {
        let along = |axis: usize| {
            let cell = ((point[axis] - self.low[axis]) / self.cell[axis]).floor();
            (0.0..self.count[axis] as f64).contains(&cell).then_some(cell as usize)
        };
        Some(self.place([along(0)?, along(1)?, along(2)?]))
    }
}

/// Wraps a position (m) into the domain along periodic axes. A position inside the domain stays the same to the bit.
pub(crate) fn inside(snapshot: &Snapshot, mut place: Vector3<f64>) -> Vector3<f64> {
    let (low, high) = snapshot.bounds;
    for axis in (0..3).filter(|&axis| snapshot.periodic[axis]) {
        if (low[axis]..high[axis]).contains(&place[axis]) {
            continue;
        }
        let wrapped = low[axis] + (place[axis] - low[axis]).rem_euclid(high[axis] - low[axis]);
        // The sum can round up to the upper side, which belongs to the first cell.
        place[axis] = if wrapped >= high[axis] { low[axis] } else { wrapped };
    }
    place
}

/// Returns the shortest vector (m) between the periodic images of two positions. `between` is their difference (m).
pub(crate) fn nearest_image(snapshot: &Snapshot, mut between: Vector3<f64>) -> Vector3<f64> {
    let length = snapshot.bounds.1 - snapshot.bounds.0;
    for axis in (0..3).filter(|&axis| snapshot.periodic[axis]) {
        between[axis] -= (between[axis] / length[axis]).round() * length[axis];
    }
    between
}

/// Returns the shifts (m) from a position to itself and to its images across the periodic sides of the given axes.
pub(crate) fn image_shifts(snapshot: &Snapshot, axes: Range<usize>) -> Vec<Vector3<f64>> {
    let length = snapshot.bounds.1 - snapshot.bounds.0;
    let along = |axis: usize| -> &[f64] {
        if axes.contains(&axis) && snapshot.periodic[axis] { &[-1.0, 0.0, 1.0] } else { &[0.0] }
    };
    let plane = along(0).iter().flat_map(|&i| along(1).iter().map(move |&j| (i, j)));
    plane.flat_map(|(i, j)| along(2).iter().map(move |&k| Vector3::new(i, j, k).component_mul(&length))).collect()
}
