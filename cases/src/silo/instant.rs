//! Data of the last frame of a silo: principal axes of stress T and strain rate D of its blocks, and contact forces in
//! a part of the silo (figures 4 and 5 of the paper).

use super::flow::{FLOWING, Flow};
use grainbench_fields::element::Element;
use grainbench_fields::grid::Grid;
use grainbench_fields::mask::MaskReasons;
use grainbench_fields::tensor::{deviator, principal};
use grainbench_harness::prelude::*;
use nalgebra::Matrix3;

/// Columns of the table of axes, one row per block. The three axes of T, from the smallest principal value to the
/// largest, are projected on the x-z plane. Each axis has the length √|principal value of the deviator| (√(mg/d²)). The
/// last four columns are the projected axes of the smallest and the largest principal value of D; they are empty unless
/// the block flows.
pub(super) const AXES: [&str; 12] = [
    "x",
    "z",
    "smallest_x",
    "smallest_z",
    "middle_x",
    "middle_z",
    "largest_x",
    "largest_z",
    "shortens_x",
    "shortens_z",
    "lengthens_x",
    "lengthens_z",
];
/// Columns of the table of forces, one row per contact between grains: both centres and the magnitude of the force.
pub(super) const FORCES: [&str; 5] = ["from_x", "from_z", "to_x", "to_z", "force"];

/// Returns the part of a silo whose contact forces are plotted: lower and upper corner in x and z (d).
pub(super) const fn part(flow: Flow) -> [[f64; 2]; 2] {
    match flow {
        // Boundary between the flowing funnel and the resting grains beside it.
        Flow::Drained => [[0.0, 5.0], [10.0, 15.0]],
        // Above the edge of the moving floor, where a shear band rises.
        Flow::Pushed => [[-5.0, 10.0], [5.0, 20.0]],
    }
}

/// Returns the axes of blocks that contain enough grains and are not at the surface.
pub(super) fn axes(blocks: &[Element], masked: &[MaskReasons], grid: &Grid) -> Table {
    let mut table = Table::new("axes", &AXES);
    for (cell, element) in blocks.iter().enumerate().filter(|(cell, _)| !masked[*cell].few && !masked[*cell].surface) {
        let Some(stress) = element.stress else { continue };
        let middle = grid.middle(cell);
        let mut row = vec![Some(middle.x), Some(middle.z)];
        let flat = |axis: Vector3<f64>| [Some(axis.x), Some(axis.z)];
        let of_stress = long(&stress);
        row.extend(of_stress.into_iter().flat_map(flat));
        if let Some(gradient) = element.motion.gradient.filter(|_| element.shear_rate() >= Some(FLOWING)) {
            let of_rate = principal(&gradient.symmetric_part(), 3);
            row.extend([of_rate.axes[0], of_rate.axes[2]].into_iter().flat_map(flat));
        }
        table.push(&row);
    }
    table
}

/// Returns the axes of a stress, each of length √|principal value of the deviator|.
fn long(stress: &Matrix3<f64>) -> [Vector3<f64>; 3] {
    let deviatoric = principal(&deviator(stress, 3), 3);
    [0, 1, 2].map(|number| deviatoric.axes[number] * deviatoric.values[number].abs().sqrt())
}

/// Returns the contacts between grains whose contact point is in a part of the silo.
pub(super) fn forces(snapshot: &Snapshot, [low, high]: [[f64; 2]; 2]) -> Table {
    let mut table = Table::new("forces", &FORCES);
    for contact in snapshot.told_contacts() {
        let at = [contact.point.x, contact.point.z];
        let Partner::Grain(other) = contact.partner else { continue };
        if (0..2).any(|axis| !(low[axis]..=high[axis]).contains(&at[axis])) {
            continue;
        }
        let radius = |id: u32| Some(snapshot.grain(id)?.radius);
        let (Some(one), Some(two)) = (radius(contact.grain), radius(other)) else { continue };
        // Both positions follow from the contact point, so that a pair across the periodic boundary is not drawn across
        // the silo.
        let from = contact.point - contact.normal * one;
        let to = contact.point + contact.normal * two;
        let force = (contact.shear_force - contact.normal * contact.normal_force).norm();
        table.push(&[from.x, from.z, to.x, to.z, force].map(Some));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_as_long_as_the_roots_of_the_deviator() {
        // The pressure is p = 3, so the deviator is diag(−2, 0.9, 1.1). The middle and the largest axis are distinct.
        let stress = Matrix3::from_diagonal(&Vector3::new(-5.0, -2.1, -1.9));
        let [smallest, middle, largest] = long(&stress).map(|axis| axis.abs());
        assert!((smallest - Vector3::new(2.0_f64.sqrt(), 0.0, 0.0)).norm() < 1e-12);
        assert!((middle - Vector3::new(0.0, 0.9_f64.sqrt(), 0.0)).norm() < 1e-12);
        assert!((largest - Vector3::new(0.0, 0.0, 1.1_f64.sqrt())).norm() < 1e-12);
    }
}
