//! Packing fraction: the fraction of each cell that grains fill, from their exact volumes in the cell.

use crate::grid::{Grid, inside};
use crate::overlap::{disc_in_box, sphere_in_box};
use grainbench_scene::dimension::Dimension;
use grainbench_solver::record::{GrainState, Snapshot};
use nalgebra::Vector3;

/// Returns the packing fraction φ of every cell: the volume of grains and their periodic images within the cell,
/// divided by the volume V of the cell. The overlap of two grains counts twice.
///
/// For material points, φ = (1/V) Σ V_p with the volumes V_p of the points in the cell.
#[must_use]
pub fn packing_fraction(snapshot: &Snapshot, space: Dimension, grid: &Grid) -> Vec<f64> {
    let mut filled = vec![0.0; grid.cells()];
    if snapshot.points.is_empty() {
        snapshot.grains.iter().for_each(|grain| of_grain(snapshot, grain, space, grid, &mut filled));
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

/// Adds the volumes of a grain and its periodic images to the cells.
fn of_grain(snapshot: &Snapshot, grain: &GrainState, space: Dimension, grid: &Grid, filled: &mut [f64]) {
    let (low, high) = snapshot.bounds;
    let shifts = |axis: usize| -> &[f64] {
        if axis < space.count() && snapshot.periodic[axis] { &[-1.0, 0.0, 1.0] } else { &[0.0] }
    };
    for &i in shifts(0) {
        for &j in shifts(1) {
            for &k in shifts(2) {
                let centre = grain.position + Vector3::new(i, j, k).component_mul(&(high - low));
                share_out(centre, grain.radius, space, grid, filled);
            }
        }
    }
}

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
