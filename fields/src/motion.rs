//! Motion of a cell: mean velocity v⁰, velocity gradient L and residual velocity |v′| of the n grains in it, with their
//! mean position x̄.
//!
//! ```text
//! v = v⁰ + L (x − x̄)      least squares over the centres of grains in the cell; material points are weighted by volume
//! |v′|² = (1/n) Σ |v_i − v⁰ − L (x_i − x̄)|²
//! ```

use crate::grid::{Grid, inside, nearest_image};
use grainbench_solver::record::{GrainState, Snapshot};
use nalgebra::{Matrix3, Vector3};

/// Position, velocity and weight of a grain or material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Position (m).
    pub position: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Weight: one for a grain, the volume for a material point.
    pub weight: f64,
}

/// Motion of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Number of grains or material points whose centre is in the cell.
    pub members: usize,
    /// Mean velocity v⁰ (m/s); `None` for an empty cell.
    pub velocity: Option<Vector3<f64>>,
    /// Velocity gradient L (1/s), L_ij = ∂v_i/∂x_j. `None` if the cell has too few centres, if they are collinear or
    /// coplanar, or if velocities are unknown.
    pub gradient: Option<Matrix3<f64>>,
    /// Residual |v′| (m/s), the root mean square deviation from the linear fit; `None` without L.
    pub residual: Option<f64>,
}

/// Returns the grains, or the material points if there are any, with their instantaneous velocities.
#[must_use]
pub fn movers(snapshot: &Snapshot) -> Vec<Mover> {
    if snapshot.points.is_empty() {
        let position = |grain: &GrainState| inside(snapshot, grain.position);
        let mover = |grain| Mover { position: position(grain), velocity: grain.velocity, weight: 1.0 };
        snapshot.grains.iter().map(mover).collect()
    } else {
        let of_points = snapshot.points.iter().map(|point| Mover {
            position: inside(snapshot, point.position),
            velocity: point.velocity,
            weight: point.volume,
        });
        of_points.collect()
    }
}

/// Returns the grains of the later of two snapshots, with the mean velocity (x − x′)/Δt since the earlier snapshot.
///
/// The displacement x − x′ is the shortest across periodic sides, so no grain may move by more than half the domain
/// between snapshots. Grains that are in only one of the snapshots are skipped.
#[must_use]
pub fn movers_between(before: &Snapshot, after: &Snapshot) -> Vec<Mover> {
    let elapsed = after.time - before.time;
    let mover = |grain: &GrainState| {
        let step = nearest_image(after, grain.position - before.grain(grain.id)?.position);
        Some(Mover { position: inside(after, grain.position), velocity: step / elapsed, weight: 1.0 })
    };
    after.grains.iter().filter_map(mover).collect()
}

/// Sums over the members of a cell, with positions relative to the cell centre.
#[derive(Clone, Copy, Default)]
struct Sums {
    members: usize,
    weight: f64,
    place: Vector3<f64>,
    velocity: Vector3<f64>,
    /// Second moments Σ w x⊗x of the positions x with weights w.
    spread: Matrix3<f64>,
    /// Sum Σ w v⊗x with velocities v, positions x and weights w.
    carried: Matrix3<f64>,
}

impl Sums {
    fn add(&mut self, weight: f64, place: Vector3<f64>, velocity: Vector3<f64>) {
        self.members += 1;
        self.weight += weight;
        self.place += place * weight;
        self.velocity += velocity * weight;
        self.spread += place * place.transpose() * weight;
        self.carried += velocity * place.transpose() * weight;
    }

    fn gradient(&self, dimension: usize, cell: Vector3<f64>) -> Option<Matrix3<f64>> {
        if self.members <= dimension {
            return None;
        }
        let mut spread = self.spread - self.place * self.place.transpose() / self.weight;
        let carried = self.carried - self.velocity * self.place.transpose() / self.weight;
        if dimension == 2 {
            spread.m33 = self.weight;
        }
        // If the centres are collinear or coplanar, the gradient is undetermined along one direction. Without this
        // check, rounding errors would determine it.
        let size: f64 = (0..dimension).map(|axis| self.weight * cell[axis] * cell[axis]).product();
        let size = if dimension == 2 { size * self.weight } else { size };
        if spread.determinant() < 1e-12 * size {
            return None;
        }
        spread.try_inverse().map(|inverse| carried * inverse)
    }
}

/// Computes the motion of every cell.
#[must_use]
pub fn motion(movers: &[Mover], dimension: usize, grid: &Grid) -> Vec<Motion> {
    let mut sums = vec![Sums::default(); grid.cells()];
    let homes: Vec<Option<usize>> = movers.iter().map(|mover| grid.find(mover.position)).collect();
    for (mover, home) in movers.iter().zip(&homes) {
        if let Some(cell) = *home {
            sums[cell].add(mover.weight, mover.position - grid.middle(cell), mover.velocity);
        }
    }
    // Unknown velocities are NaN, and so are gradients computed from them.
    let is_finite = |gradient: &Matrix3<f64>| gradient.iter().all(|number| number.is_finite());
    let gradients: Vec<_> = sums.iter().map(|sums| sums.gradient(dimension, grid.cell).filter(is_finite)).collect();
    let mut left = vec![0.0; grid.cells()];
    for (mover, home) in movers.iter().zip(&homes) {
        if let Some(cell) = *home
            && let Some(gradient) = gradients[cell]
        {
            let Sums { weight, place, velocity, .. } = sums[cell];
            let arm = mover.position - grid.middle(cell) - place / weight;
            left[cell] += mover.weight * (mover.velocity - velocity / weight - gradient * arm).norm_squared();
        }
    }
    let mean = |sums: &Sums| Some(sums.velocity / sums.weight).filter(|mean| mean.iter().all(|part| part.is_finite()));
    let cell_motion = |cell: usize| Motion {
        members: sums[cell].members,
        velocity: mean(&sums[cell]),
        gradient: gradients[cell],
        residual: gradients[cell].map(|_| (left[cell] / sums[cell].weight).sqrt()),
    };
    (0..grid.cells()).map(cell_motion).collect()
}
