//! Perturbed run, in which one coordinate of one grain is changed by one unit in the last place. It shows how long a
//! run is predictable.

use grainbench_scene::scene::Scene;

/// Difference between a run and its perturbed run, relative to the largest value, at which pointwise comparison ends.
pub const PARTED: f64 = 1e-9;

/// Changes one coordinate of the grain in the middle of the list by one unit in the last place.
pub fn move_one(scene: &mut Scene) {
    let middle = scene.grains.len() / 2;
    if let Some(grain) = scene.grains.get_mut(middle) {
        // The coordinate must not be zero, because the next number after zero is too small to be a length.
        let axis = (0..3).find(|&axis| grain.position[axis] != 0.0).unwrap_or(0);
        grain.position[axis] = grain.position[axis].next_up();
    }
}
