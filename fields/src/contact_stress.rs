//! Stress of a cell from the contacts of its grains, from what was told of each, or from its material points.
//!
//! ```text
//! T = (1/V) Σ Δx⊗F over the contacts of grains whose centre is in the cell       | (1/V) Σ V_p σ_p
//! ```
//!
//! Δx goes from the centre of a grain to its contact and F acts on it there, so compression is negative; contacts with walls
//! count as all others do. The two are one: for a grain in equilibrium ∫σ dV = Σ Δx⊗F by Gauss' theorem. A grain counts as a
//! whole to the cell of its centre, so that T of a single cell scatters by as much as grains stick out of it; summed over
//! cells nothing is lost. Momentum flux is left out. Where V σ is told of each grain, its cell is that of its centre at the
//! time of the snapshot.

use crate::grid::{Grid, inside};
use grainbench_scene::record::{GrainState, Partner, Snapshot};
use nalgebra::Matrix3;

/// Which stress of grains is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stress {
    /// That of the instant: of the contacts of a snapshot, or else of the V σ of its grains.
    #[default]
    Instant,
    /// Its mean over the time since the snapshot before, which runs that were asked for it tell grain by grain.
    Interval,
}

impl Stress {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Instant => "stress of the instant",
            Self::Interval => "stress as its mean over the time since the frame before",
        }
    }
}

/// Whether a snapshot tells the mean of the stress over the time before it.
#[must_use]
pub fn tells_interval(snapshot: &Snapshot) -> bool {
    snapshot.points.is_empty() && snapshot.grains.iter().any(|grain| grain.mean_virial.is_some())
}

/// V σ of all grains (J) by what is told of each; none where it is not told of all.
fn of_grains(
    snapshot: &Snapshot,
    grid: &Grid,
    of: impl Fn(&GrainState) -> Option<[f64; 6]>,
) -> Option<Vec<Matrix3<f64>>> {
    let mut stress = vec![Matrix3::zeros(); grid.cells()];
    for grain in &snapshot.grains {
        let virial = of(grain)?;
        if let Some(cell) = grid.find(grain.position) {
            stress[cell] += symmetric(virial);
        }
    }
    Some(stress)
}

const fn symmetric([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// T of every cell (Pa; N/m in the plane); none where it was not told, for that is not zero. Of material points there is the
/// stress of the instant alone.
#[must_use]
pub fn contact_stress(snapshot: &Snapshot, dimension: usize, grid: &Grid, which: Stress) -> Option<Vec<Matrix3<f64>>> {
    let mut stress = vec![Matrix3::zeros(); grid.cells()];
    let grains_alone = snapshot.points.is_empty();
    if grains_alone && which == Stress::Interval {
        stress = of_grains(snapshot, grid, |grain| grain.mean_virial.as_deref().copied())?;
    } else if grains_alone && snapshot.contacts.is_none() {
        stress = of_grains(snapshot, grid, |grain| grain.virial.as_deref().copied())?;
    } else if grains_alone {
        let contacts = snapshot.contacts.as_ref()?;
        let homes: Vec<Option<usize>> = snapshot.grains.iter().map(|grain| grid.find(grain.position)).collect();
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
            // Contacts of discs know nothing of the stress along z, and pressure is that of the plane.
            stress.set_row(2, &nalgebra::RowVector3::zeros());
            stress.set_column(2, &nalgebra::Vector3::zeros());
        }
    }
    Some(stress)
}
