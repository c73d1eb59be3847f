//! Stress of a cell from the contacts of its grains, or from its material points.
//!
//! ```text
//! T = (1/V) Σ Δx⊗F over the contacts of grains whose centre is in the cell       | (1/V) Σ V_p σ_p
//! ```
//!
//! Δx goes from the centre of a grain to its contact and F acts on it there, so compression is negative; contacts with walls
//! count as all others do. The two are one: for a grain in equilibrium ∫σ dV = Σ Δx⊗F by Gauss' theorem. A grain counts as a
//! whole to the cell of its centre, so that T of a single cell scatters by as much as grains stick out of it; summed over
//! cells nothing is lost. Momentum flux is left out.

use crate::grid::{Grid, inside};
use grainbench_scene::record::{Partner, Snapshot};
use nalgebra::Matrix3;

/// T of every cell (Pa; N/m in the plane); none where contacts were not told, for that is not zero.
#[must_use]
pub fn contact_stress(snapshot: &Snapshot, dimension: usize, grid: &Grid) -> Option<Vec<Matrix3<f64>>> {
    let mut stress = vec![Matrix3::zeros(); grid.cells()];
    if snapshot.points.is_empty() {
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
                let [xx, yy, zz, xy, yz, zx] = point.stress;
                stress[cell] += Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) * point.volume;
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
