//! Packing fraction: the fraction of each cell that grains fill, from their exact volumes in the cell.

use crate::grid::{Grid, image_shifts, inside};
use crate::overlap::{disc_in_box, sphere_in_box};
use grainbench_scene::dimension::Dimension;
use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;

/// Returns the packing fraction φ of every cell: the volume of grains and their periodic images within the cell,
/// divided by the volume V of the cell. The overlap of two grains counts twice.
///
/// For material points, φ = (1/V) Σ V_p with the volumes V_p of the points in the cell.
#[must_use]
pub fn packing_fraction(snapshot: &Snapshot, space: Dimension, grid: &Grid) -> Vec<f64> {
    let mut filled = vec![0.0; grid.cells()];
    if snapshot.points.is_empty() {
        let shifts = image_shifts(snapshot, 0..space.count());
        for (grain, shift) in snapshot.grains.iter().flat_map(|grain| shifts.iter().map(move |shift| (grain, shift))) {
            share_out(inside(snapshot, grain.position) + shift, grain.radius, space, grid, &mut filled);
        }
    } else {
        for point in &snapshot.points {
            if let Some(cell) = grid.find(inside(snapshot, point.position)) {
                filled[cell] += point.volume;
            }
        }
    }
    filled.iter_mut().for_each(|filled| *filled /= grid.volume());
    filled
}

/// Adds the volume of a grain or of a periodic image to the cells.
fn share_out(centre: Vector3<f64>, radius: f64, space: Dimension, grid: &Grid, filled: &mut [f64]) {
    let reach = |axis: usize| {
        if axis >= space.count() {
            return 0..1;
        }
        let cell = |place: f64| ((place - grid.low[axis]) / grid.cell[axis]).floor().max(0.0) as usize;
        cell(centre[axis] - radius)..(cell(centre[axis] + radius) + 1).min(grid.count[axis])
    };
    for k in reach(2) {
        for j in reach(1) {
            for i in reach(0) {
                let low = grid.corner([i, j, k]) - centre;
                let high = low + grid.cell;
                filled[grid.place([i, j, k])] += match space {
                    Dimension::Two => disc_in_box(radius, [low.x, low.y], [high.x, high.y]),
                    Dimension::Three => sphere_in_box(radius, low.into(), high.into()),
                };
            }
        }
    }
}
