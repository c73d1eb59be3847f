//! Evaluation of the middle of the layer in each snapshot. If a run records the stress averaged over the time between
//! snapshots, this average is used, because the instantaneous stress fluctuates by a third.

use grainbench_fields::contact_stress::{Stress, contact_stress, tells_interval};
use grainbench_fields::grid::Grid;
use grainbench_fields::packing::packing_fraction;
use grainbench_harness::prelude::*;

/// Evaluation of the bulk in each snapshot.
pub(super) const BULK: Reading = Reading { name: "bulk of a sheared layer", begin };

/// Columns: time, packing fraction, shear rate, normal and shear stress with their momentum flux, instantaneous shear
/// stress, and the instantaneous shear stress without tangential forces.
const COLUMNS: [&str; 7] = ["time", "packing", "rate", "normal", "shear", "instant", "frictionless"];

/// Limits of the bulk, as fractions of the initial height. Near the walls, the grains are ordered in layers.
const HEIGHTS: [f64; 2] = [0.25, 0.7];

fn begin(scene: &Scene) -> Box<dyn Reader> {
    let (mut low, mut high) =
        scene.domain.map_or((Vector3::zeros(), Vector3::repeat(1.0)), |domain| (domain.low, domain.high));
    let height = high.y - low.y;
    (low.y, high.y) = (low.y + HEIGHTS[0] * height, low.y + HEIGHTS[1] * height);
    let grid = Grid { low, cell: high - low, count: [1; 3] };
    Box::new(Bulk { scene: scene.clone(), grid, table: Table::new("bulk", &COLUMNS) })
}

struct Bulk {
    scene: Scene,
    grid: Grid,
    table: Table,
}

impl Reader for Bulk {
    fn see(&mut self, snapshot: Snapshot) {
        let packing = packing_fraction(&snapshot, self.scene.dimension, &self.grid)[0];
        let within = |grain: &&GrainState| self.grid.find(grain.position).is_some();
        let grains: Vec<&GrainState> = snapshot.grains.iter().filter(within).collect();
        let count = grains.len() as f64;
        let mean = |value: &dyn Fn(&GrainState) -> f64| grains.iter().map(|grain| value(grain)).sum::<f64>() / count;
        let (height, along, across) =
            (mean(&|grain| grain.position.y), mean(&|grain| grain.velocity.x), mean(&|grain| grain.velocity.y));
        let off = |grain: &GrainState| grain.position.y - height;
        let rate = mean(&|grain| off(grain) * (grain.velocity.x - along)) / mean(&|grain| off(grain).powi(2));
        let flux = |value: &dyn Fn(&GrainState) -> f64| {
            let each = grains.iter().map(|grain| grain.mass * (grain.velocity.y - across) * value(grain));
            each.sum::<f64>() / self.grid.volume()
        };
        let which = if tells_interval(&snapshot) { Stress::Interval } else { Stress::Instant };
        let stress = |snapshot: &Snapshot, which| Some(contact_stress(snapshot, 2, &self.grid, which)?[0]);
        let shear = |snapshot: &Snapshot, which| stress(snapshot, which).map(|stress| 0.5 * (stress.m12 + stress.m21));
        let normal = stress(&snapshot, which).map(|stress| flux(&|grain| grain.velocity.y - across) - stress.m22);
        let drift = flux(&|grain| grain.velocity.x - along - rate * off(grain));
        let with_flux = |shear: Option<f64>| shear.map(|shear| shear - drift);
        let (whole, instant) = (with_flux(shear(&snapshot, which)), with_flux(shear(&snapshot, Stress::Instant)));
        let mut bare = snapshot.clone();
        bare.contacts.iter_mut().flatten().for_each(|contact| contact.shear_force = Vector3::zeros());
        let frictionless = with_flux(shear(&bare, Stress::Instant));
        self.table.push(&[Some(snapshot.time), Some(packing), Some(rate), normal, whole, instant, frictionless]);
    }

    fn end(self: Box<Self>) -> Vec<Table> {
        vec![self.table]
    }
}
