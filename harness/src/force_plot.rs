//! Force plot of Cundall and Strack for a snapshot in two dimensions.

use crate::figure::{ForceBar, ForcePlot};
use grainbench_solver::record::{GrainState, Partner, Snapshot};
use nalgebra::Vector3;

/// Returns a force plot of a snapshot. Contacts with grains that are not in the snapshot are left out.
///
/// The bar of a contact passes through the contact point in the direction of the force. Its length is the sum of the
/// radii; at a wall, it is the radius of the grain.
#[must_use]
pub fn force_plot(snapshot: &Snapshot) -> ForcePlot {
    let flat = |point: Vector3<f64>| [point.x, point.y];
    let bars = snapshot
        .told_contacts()
        .iter()
        .filter_map(|contact| {
            let radius = |id: u32| Some(snapshot.grain(id)?.radius);
            let beyond = match contact.partner {
                Partner::Grain(other) => radius(other)?,
                Partner::Body(_) | Partner::Wall(_) => 0.0,
            };
            let force = contact.shear_force - contact.normal * contact.normal_force;
            let magnitude = force.norm();
            // Without force, the bar has the direction of the contact normal.
            let along = if magnitude > 0.0 { -force / magnitude } else { contact.normal };
            Some(ForceBar {
                from: flat(contact.point - along * radius(contact.grain)?),
                to: flat(contact.point + along * beyond),
                force: magnitude,
                slipping: contact.slipping,
            })
        })
        .collect();
    let (low, high) = snapshot.bounds;
    let across = (high - low).norm();
    let walls = snapshot
        .walls
        .iter()
        .filter_map(|wall| {
            let &[a, b, ..] = wall.corners.as_slice() else { return None };
            if !wall.infinite {
                return Some((flat(a), flat(b)));
            }
            // An infinite wall is drawn over the length of the snapshot's bounds along the wall.
            let along = Vector3::new(-b.y, b.x, 0.0);
            let half = 0.5 * ((high - low).dot(&along.abs())).min(across);
            let middle = a + along * (0.5 * (low + high) - a).dot(&along);
            Some((flat(middle - along * half), flat(middle + along * half)))
        })
        .collect();
    let disc = |grain: &GrainState| (flat(grain.position), grain.radius, grain.angle.unwrap_or(f64::NAN));
    ForcePlot { discs: snapshot.grains.iter().map(disc).collect(), walls, bars }
}
