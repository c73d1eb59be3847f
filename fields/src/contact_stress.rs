//! Stress of a cell from contacts, from the virial of each grain, or from material points.
//!
//! ```text
//! T = (1/V) Σ Δx⊗F over the contacts of grains whose centre is in the cell       | (1/V) Σ V_p σ_p
//! ```
//!
//! V is the volume of the cell. For grains, Δx is the vector from the centre of a grain to a contact, and F the force
//! on the grain at this contact. For material points, V_p is the volume of a point and σ_p its stress. Compression is
//! negative. Contacts with walls are included if the snapshot lists them. Contact dumps of LAMMPS and LIGGGHTS list only
//! pairs of grains. The stress of cells at walls is then too small, so [`crate::course::Course`] masks all cells at
//! non-periodic sides of the grid. Both sums are consistent: for a grain in equilibrium ∫σ dV = Σ Δx⊗F by Gauss' theorem.
//! A grain belongs as a whole to the cell of its centre. T of a single cell therefore depends on the grains that
//! intersect the boundary of the cell, but sums over all cells are exact. Momentum flux is not included. A snapshot may
//! contain the virial of each grain (volume times mean stress of the grain) instead of contacts. The virial then belongs
//! to the cell that contains the grain's centre at the time of the snapshot.

use crate::grid::{Grid, inside};
use grainbench_solver::record::{ContactState, GrainState, Partner, Snapshot};
use nalgebra::Matrix3;

/// Kind of stress of grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stress {
    /// Instantaneous stress from the contacts of a snapshot. If the snapshot has no list of contacts, the virials of
    /// the grains are used.
    #[default]
    Instant,
    /// Time average since the previous snapshot, which a run writes for each grain on request.
    Interval,
}

impl Stress {
    /// Returns a description of the kind of stress.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Instant => "instantaneous stress",
            Self::Interval => "stress averaged over the time since the previous frame",
        }
    }
}

/// Returns true if a snapshot of grains contains time averages of the stress.
#[must_use]
pub fn tells_interval(snapshot: &Snapshot) -> bool {
    snapshot.points.is_empty() && snapshot.grains.iter().any(|grain| grain.mean_virial.is_some())
}

/// Returns true if the contacts of a snapshot may lack contacts with walls: all are between grains, and the grains have no
/// forces. Snapshots of external programs are of this kind, while our solvers report the force on each grain.
pub(crate) fn lacks_walls(snapshot: &Snapshot) -> bool {
    let is_pair = |contact: &ContactState| matches!(contact.partner, Partner::Grain(_));
    snapshot.contacts.as_ref().is_some_and(|contacts| contacts.iter().all(is_pair))
        && snapshot.grains.first().is_some_and(|grain| grain.force.is_none())
}

const fn symmetric([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// Returns the stress T of every cell (Pa; N/m for spheres in two dimensions), or `None` if it is unknown.
///
/// The stress of material points is always instantaneous, for both values of `which`.
#[must_use]
pub fn contact_stress(snapshot: &Snapshot, dimension: usize, grid: &Grid, which: Stress) -> Option<Vec<Matrix3<f64>>> {
    let mut stress = vec![Matrix3::zeros(); grid.cells()];
    let grains_alone = snapshot.points.is_empty();
    if grains_alone && (which == Stress::Interval || snapshot.contacts.is_none()) {
        for grain in &snapshot.grains {
            let virial = if which == Stress::Interval { &grain.mean_virial } else { &grain.virial };
            let virial = symmetric(*virial.as_deref()?);
            if let Some(cell) = grid.find(inside(snapshot, grain.position)) {
                stress[cell] += virial;
            }
        }
    } else if grains_alone {
        let contacts = snapshot.contacts.as_ref()?;
        let home = |grain: &GrainState| grid.find(inside(snapshot, grain.position));
        let homes: Vec<Option<usize>> = snapshot.grains.iter().map(home).collect();
        for contact in contacts {
            let force = contact.shear_force - contact.normal * contact.normal_force;
            let arm = |id: u32, side: f64| {
                let place = snapshot.place_of(id)?;
                let radius = snapshot.grains[place].radius;
                Some((homes[place]?, contact.normal * (side * (radius - 0.5 * contact.overlap))))
            };
            if let Some((cell, arm)) = arm(contact.grain, 1.0) {
                stress[cell] += arm * force.transpose();
            }
            if let Partner::Grain(other) = contact.partner
                && let Some((cell, arm)) = arm(other, -1.0)
            {
                stress[cell] -= arm * force.transpose();
            }
        }
    } else {
        for point in &snapshot.points {
            if let Some(cell) = grid.find(inside(snapshot, point.position)) {
                stress[cell] += symmetric(point.stress) * point.volume;
            }
        }
    }
    for stress in &mut stress {
        *stress /= grid.volume();
        if dimension == 2 {
            // Contacts of discs do not determine the stress along z, and the pressure is defined in the plane.
            stress.set_row(2, &nalgebra::RowVector3::zeros());
            stress.set_column(2, &nalgebra::Vector3::zeros());
        }
    }
    Some(stress)
}
