//! Grid of cells over the grains, and the order of the grains by cell.

use crate::geometry::Geometry;
use grainbench_lanes::Quad;
use nalgebra::Vector3;

/// Grid of cells over the bounding box of the grains. Only the few grains that are much larger than the mean have no
/// cell. Cells are at least `reach` (m) wide, so grains within this distance of each other are in the same or in adjacent
/// cells. The grid has at most 4 N + 64 cells for N grains.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    /// Lowest and highest coordinates of the centres of the grains that have a cell (m).
    pub(crate) bounds: [Vector3<f64>; 2],
    width: Vector3<f64>,
    /// Distance between the centres below which two grains with cells can be neighbours (m).
    pub(crate) reach: f64,
    pub(crate) count: [usize; 3],
    /// First slot of every cell, then the number of grains. Grains without a cell have the slots before the first cell.
    pub(crate) start: Vec<u32>,
}

impl Cells {
    /// Creates the grid, and returns it with the order that sorts the grains by cell (a stable sort). Grains with radii
    /// above `limit` (m) have no cell. They come first, so that their partners come after them.
    pub(crate) fn sort<S: Geometry>(place: &[Quad], reach: f64, limit: f64) -> (Self, Vec<u32>) {
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = Vector3::repeat(f64::NEG_INFINITY);
        let has_cell = |grain: &&Quad| grain.0[3] <= limit;
        for grain in place.iter().filter(has_cell) {
            let position = S::vector_in_space(grain);
            low = low.inf(&position);
            high = high.sup(&position);
        }
        let extent = high - low;
        let most = (4 * place.len() + 64) as f64;
        let mut count = [1_usize; 3];
        let mut cell = reach;
        loop {
            let along = [0, 1, 2].map(|axis| (extent[axis] / cell).floor().max(1.0));
            if along.iter().product::<f64>() <= most {
                for axis in 0..S::DIMENSION {
                    count[axis] = along[axis] as usize;
                }
                break;
            }
            cell *= 1.3;
        }
        let width = Vector3::from_fn(|axis, _| (extent[axis] / count[axis] as f64).max(reach));
        let mut cells = Self { bounds: [low, high], width, reach, count, start: Vec::new() };
        // Grains without a cell are sorted as if they had one additional cell before all other cells.
        let last = count.iter().product::<usize>();
        let cell = |grain: &Quad| if has_cell(&grain) { 1 + cells.index(S::vector_in_space(grain)) } else { 0 };
        let cell_of: Vec<u32> = place.iter().map(|grain| cell(grain) as u32).collect();
        let mut start = vec![0_u32; last + 2];
        cell_of.iter().for_each(|&cell| start[cell as usize + 1] += 1);
        for cell in 1..start.len() {
            start[cell] += start[cell - 1];
        }
        let mut next = start.clone();
        let mut order = vec![0_u32; place.len()];
        for (slot, &cell) in cell_of.iter().enumerate() {
            order[next[cell as usize] as usize] = slot as u32;
            next[cell as usize] += 1;
        }
        start.remove(0);
        cells.start = start;
        (cells, order)
    }

    /// Returns the cell coordinates of a point (m). A point outside the grid has the coordinates of the nearest cell.
    pub(crate) fn coordinates(&self, position: Vector3<f64>) -> [usize; 3] {
        let (mut coordinates, low) = ([0; 3], self.bounds[0]);
        for (axis, coordinate) in coordinates.iter_mut().enumerate() {
            // The conversion to an integer truncates, and gives zero for negative values.
            let along = (position[axis] - low[axis]) / self.width[axis];
            *coordinate = (along as usize).min(self.count[axis] - 1);
        }
        coordinates
    }

    /// Returns the index of the cell that contains the grain in a slot.
    pub(crate) fn cell(&self, slot: usize) -> usize {
        self.start.partition_point(|&start| start as usize <= slot) - 1
    }

    /// Returns the cell coordinates of a cell index.
    pub(crate) fn place(&self, cell: usize) -> [usize; 3] {
        let [along, across, _] = self.count;
        [cell % along, cell / along % across, cell / (along * across)]
    }

    /// Returns the number of grains without a cell. They have the first slots.
    pub(crate) fn without(&self) -> usize {
        self.start.first().map_or(0, |&first| first as usize)
    }

    fn index(&self, position: Vector3<f64>) -> usize {
        let [i, j, k] = self.coordinates(position);
        (k * self.count[1] + j) * self.count[0] + i
    }

    /// Returns the slots of the grains in cells `from` to `to` (inclusive) of the row with cell coordinates `j` and `k`.
    pub(crate) fn row(&self, from: usize, to: usize, j: usize, k: usize) -> std::ops::Range<usize> {
        let row = (k * self.count[1] + j) * self.count[0];
        self.start[row + from] as usize..self.start[row + to + 1] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::space::Plane;

    /// In a lattice whose spacing is nearly the width of a cell, each cell has one grain, wherever the lattice lies. Only
    /// the last cells of a row or column also contain the grains on the border of the grid. The number of candidate pairs
    /// per grain thus does not grow with the number of grains.
    #[test]
    fn a_lattice_has_one_grain_a_cell() {
        for origin in [-100.0, 0.0, 100.0] {
            let at = |number: u32| {
                let along = |part: u32| origin + 1.01 * f64::from(part);
                Quad([along(number % 8), along(number / 8), 0.0, 0.4])
            };
            let (cells, order) = Cells::sort::<Plane>(&(0..64).map(at).collect::<Vec<_>>(), 1.0, f64::MAX);
            // The last grain of a row lies on the border of the grid and belongs to the cell of the previous grain.
            assert_eq!(cells.count, [7, 7, 1]);
            let most = (0..7).flat_map(|j| (0..7).map(move |i| (i, j))).map(|(i, j)| cells.row(i, i, j, 0).len()).max();
            assert_eq!((most, order.len()), (Some(4), 64), "from {origin}");
            let lengths = [(0, 0), (3, 5), (6, 5)].map(|(i, j)| cells.row(i, i, j, 0).len());
            assert_eq!(lengths, [1, 1, 2]);
        }
    }
}
