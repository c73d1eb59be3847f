//! Counting of the small spheres in the lower quarters of the drum.

use grainbench_harness::prelude::*;

/// Evaluation of each snapshot: counts of M1 spheres in two zones.
pub(super) const ZONES: Reading = Reading { name: "zones of the drum", begin };
/// Name of the table with the counts of M1 spheres.
pub(super) const NAME: &str = "zones";
/// Column with the number of M1 spheres in zone 2: x < 0 and z < 0.
pub(super) const COUNTED: &str = "zone_2";
/// Columns of the table. `beside` is the number of M1 spheres with x ≥ 0 and z < 0.
const COLUMNS: [&str; 3] = ["time", COUNTED, "beside"];

struct Zones {
    m1: Option<u16>,
    counts: Table,
}

fn begin(scene: &Scene) -> Box<dyn Reader> {
    let m1 = scene.materials.iter().position(|name| name == "m1").map(|place| place as u16);
    Box::new(Zones { m1, counts: Table::new(NAME, &COLUMNS) })
}

impl Reader for Zones {
    fn see(&mut self, snapshot: Snapshot) {
        let mut counts = [0_u32; 2];
        let below = snapshot.grains.iter().filter(|grain| Some(grain.material) == self.m1 && grain.position.z < 0.0);
        for grain in below {
            counts[usize::from(grain.position.x >= 0.0)] += 1;
        }
        self.counts.push(&[Some(snapshot.time), Some(f64::from(counts[0])), Some(f64::from(counts[1]))]);
    }

    fn end(self: Box<Self>) -> Vec<Table> {
        vec![self.counts]
    }
}

/// Swaps the counts of zone 2 and of the other lower quarter, for a negative control.
pub(super) fn on_the_other_side(tables: &mut [Table]) {
    for table in tables.iter_mut().filter(|table| table.name == NAME) {
        table.values.swap(1, 2);
    }
}
