//! The perturbed run that tells for how long a run can be foretold: the same scene, one position moved by one unit in the last
//! place.

use crate::scene::Scene;

/// How far perturbed runs have parted when comparison moment by moment ends, in units of the largest value.
pub const PARTED: f64 = 1e-9;

/// Moves the grain in the middle of the list by one unit in the last place.
pub fn move_one(scene: &mut Scene) {
    let middle = scene.grains.len() / 2;
    if let Some(grain) = scene.grains.get_mut(middle) {
        // Along an axis where it is not zero, whose next number is no length at all.
        let axis = (0..3).find(|&axis| grain.position[axis] != 0.0).unwrap_or(0);
        grain.position[axis] = grain.position[axis].next_up();
    }
}
