//! Evaluation of a filled cylinder in slices, averaged over the snapshots of its steady descent.

use grainbench_fields::contact_stress::{Stress, contact_stress};
use grainbench_fields::grid::Grid;
use grainbench_harness::prelude::*;

/// Evaluation of each snapshot in horizontal slices of the silo.
pub(super) const COLUMN: Reading = Reading { name: "slices of a silo", begin };

/// Height of a slice (d).
const SLICE: f64 = 2.0;
/// Number of slices.
const SLICES: usize = 20;

/// Time from which the column descends steadily (τ). The floor has then moved down by a sixth of a diameter.
pub(super) const STEADY: f64 = 45.0;

/// Columns: height of the middle of a slice above the floor, vertical stress of the grains, normal stress and vertical
/// shear stress on the side wall, and weight per height. Compression and an upward force of the side wall are positive.
const COLUMNS: [&str; 5] = ["height", "vertical", "normal", "shear", "weight"];

/// Returns the index of the side wall, the first end of its axis and its radius (d).
pub(super) fn side(scene: &Scene) -> (usize, Vector3<f64>, f64) {
    let round = |(number, wall): (usize, &grainbench_scene::scene::Wall)| match wall.shape {
        WallShape::Round { axis, radii } => Some((number, axis[0], radii[0])),
        _ => None,
    };
    scene.walls.iter().enumerate().find_map(round).unwrap_or((usize::MAX, Vector3::zeros(), f64::NAN))
}

fn begin(scene: &Scene) -> Box<dyn Reader> {
    Box::new(Column { scene: scene.clone(), sums: [[0.0; 4]; SLICES], snapshots: 0 })
}

struct Column {
    scene: Scene,
    /// Sums over snapshots for each slice: Σ Δz F_z, normal and vertical force on the side wall, weight.
    sums: [[f64; 4]; SLICES],
    snapshots: usize,
}

impl Reader for Column {
    fn see(&mut self, snapshot: Snapshot) {
        if snapshot.time < STEADY || snapshot.contacts.is_none() {
            return;
        }
        let (side, _, radius) = side(&self.scene);
        let floor = snapshot.walls.iter().filter(|wall| wall.infinite).filter_map(|wall| wall.corners.first()).next();
        let bottom = floor.map_or(0.0, |point| point.z);
        let low = Vector3::new(-radius, -radius, bottom);
        let grid = Grid { low, cell: Vector3::new(2.0 * radius, 2.0 * radius, SLICE), count: [1, 1, SLICES] };
        let Some(stress) = contact_stress(&snapshot, 3, &grid, Stress::Instant) else { return };
        self.snapshots += 1;
        for (sums, stress) in self.sums.iter_mut().zip(stress) {
            sums[0] -= stress.m33 * grid.volume();
        }
        for contact in snapshot.told_contacts() {
            if contact.partner == Partner::Wall(side as u16)
                && let Some(slice) = grid.find(contact.point - contact.normal * 1e-6)
            {
                self.sums[slice][1] += contact.normal_force;
                self.sums[slice][2] += contact.shear_force.z;
            }
        }
        let gravity = self.scene.gravity.norm();
        for grain in &snapshot.grains {
            if let Some(slice) = grid.find(grain.position) {
                self.sums[slice][3] += grain.mass * gravity;
            }
        }
    }

    fn end(self: Box<Self>) -> Vec<Table> {
        let mut table = Table::new("slices", &COLUMNS);
        let (_, _, radius) = side(&self.scene);
        let (area, around) = (PI * radius * radius, std::f64::consts::TAU * radius);
        let count = self.snapshots as f64 * SLICE;
        for (slice, [virial, normal, shear, weight]) in self.sums.into_iter().enumerate() {
            let height = (slice as f64 + 0.5) * SLICE;
            let row =
                [height, virial / (area * count), normal / (around * count), shear / (around * count), weight / count];
            table.push(&row.map(Some));
        }
        vec![table]
    }
}
