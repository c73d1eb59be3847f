//! Wall forces, overlaps and distance from equilibrium of a packing between walls, at one moment.

use grainbench_solver::record::{ContactState, Partner, Snapshot, WallState};
use nalgebra::Vector3;

/// Largest deviation of F_H/F_V at stage A in the search for the wall motion of `photoelastic-packing`.
pub const NEAR_IN_RATIO: f64 = 0.004;
/// Largest deviation of mean overlap / mean radius at stage A in this search.
pub const NEAR_IN_OVERLAP: f64 = 8e-6;
/// Largest deviation of F_V at stage B / F_V at stage A in this search.
pub const NEAR_IN_GROWTH: f64 = 1e-4;

/// Sums over walls and contacts of one snapshot. The walls are planes normal to the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// F_H: half of the sum of the normal forces on the walls across x (N; N/m for discs).
    pub horizontal: f64,
    /// F_V: half of the sum of the normal forces on the walls across y (N; N/m for discs).
    pub vertical: f64,
    /// Mean approach divided by the mean radius. The mean is over all contacts, including contacts at walls. The
    /// approach is the distance of centres in undeformed contact minus the present distance of centres. It is the
    /// overlap of rigid grains on springs, and the flattening of deformable grains.
    pub overlap: f64,
    /// Largest resultant force on a grain, divided by the largest contact force.
    pub unbalanced: f64,
    /// Largest component of the total force on all walls, including friction, divided by the largest force on one wall.
    pub residual: f64,
}

impl Stage {
    /// Computes the sums of a snapshot. A sum is NaN if the solver reports no forces.
    #[must_use]
    pub fn from_snapshot(snapshot: &Snapshot) -> Self {
        let (grains, contacts, walls) = (&snapshot.grains, snapshot.told_contacts(), &snapshot.walls);
        let unknown = Vector3::repeat(f64::NAN);
        let on_wall = |wall: &WallState| wall.force.unwrap_or(unknown);
        let largest = |forces: &mut dyn Iterator<Item = f64>| forces.fold(0.0, f64::max);
        // The second corner of a plane is its normal, which points into the packing.
        let carried = |axis: usize| -> f64 {
            walls.iter().filter_map(|wall| Some(-0.5 * on_wall(wall)[axis] * wall.corners.get(1)?[axis])).sum()
        };
        let radius = grains.iter().map(|grain| grain.radius).sum::<f64>() / grains.len() as f64;
        let overlap = contacts.iter().map(|contact| approach(snapshot, contact)).sum::<f64>() / contacts.len() as f64;
        let contact =
            largest(&mut contacts.iter().map(|contact| contact.normal_force.hypot(contact.shear_force.norm())));
        let sum: Vector3<f64> = walls.iter().map(on_wall).sum();
        Self {
            horizontal: carried(0),
            vertical: carried(1),
            overlap: overlap / radius,
            unbalanced: largest(&mut grains.iter().map(|grain| grain.force.unwrap_or(unknown).norm())) / contact,
            residual: sum.amax() / largest(&mut walls.iter().map(|wall| on_wall(wall).norm())),
        }
    }

    /// Returns the ratio F_H/F_V of horizontal to vertical wall force.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.horizontal / self.vertical
    }
}

/// Returns the approach at a contact (m): the distance from the grain's centre to the partner's centre, or to a plane,
/// in undeformed contact, minus the present distance. For a body or another wall, returns the recorded overlap.
fn approach(snapshot: &Snapshot, contact: &ContactState) -> f64 {
    let grain = &snapshot.grains[contact.grain as usize - 1];
    match contact.partner {
        Partner::Grain(other) => {
            let other = &snapshot.grains[other as usize - 1];
            grain.radius + other.radius - (grain.position - other.position).norm()
        }
        Partner::Wall(wall) => match snapshot.walls[wall as usize].corners[..] {
            [point, normal] => grain.radius - normal.dot(&(grain.position - point)),
            _ => contact.overlap,
        },
        Partner::Body(_) => contact.overlap,
    }
}
