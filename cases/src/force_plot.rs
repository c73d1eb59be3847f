//! A snapshot of a plane scene as Cundall and Strack's force plot.

use crate::figure::{ForceBar, ForcePlot};
use grainbench_scene::record::{Partner, Snapshot};
use nalgebra::Vector3;

/// Draws every contact as a bar from centre to centre, or from centre to wall.
#[must_use]
pub fn force_plot(snapshot: &Snapshot) -> ForcePlot {
    let flat = |point: Vector3<f64>| [point.x, point.y];
    let bars = snapshot
        .contacts
        .iter()
        .map(|contact| {
            let grain = &snapshot.grains[contact.grain as usize - 1];
            let from = grain.position;
            let reach = match contact.partner {
                Partner::Grain(other) => grain.radius + snapshot.grains[other as usize - 1].radius,
                Partner::Wall(_) => grain.radius,
            };
            let force = (contact.shear_force - contact.normal * contact.normal_force).norm();
            let to = from + contact.normal * (reach - contact.overlap);
            ForceBar { from: flat(from), to: flat(to), force, slipping: contact.slipping }
        })
        .collect();
    let (low, high) = snapshot.bounds;
    let across = (high - low).norm();
    let walls = snapshot
        .walls
        .iter()
        .map(|wall| {
            let (a, b) = (wall.corners[0], wall.corners[1]);
            if !wall.infinite {
                return (flat(a), flat(b));
            }
            // An infinite wall is drawn as long as the grains' box is wide there.
            let along = Vector3::new(-b.y, b.x, 0.0);
            let half = 0.5 * ((high - low).dot(&along.abs())).min(across);
            let middle = a + along * (0.5 * (low + high) - a).dot(&along);
            (flat(middle - along * half), flat(middle + along * half))
        })
        .collect();
    ForcePlot {
        discs: snapshot.grains.iter().map(|grain| (flat(grain.position), grain.radius, grain.angle)).collect(),
        walls,
        bars,
    }
}
