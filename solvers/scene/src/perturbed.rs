//! Perturbed run, in which one position of the scene is changed by one unit in the last place. It shows how long a run
//! is predictable.

use crate::scene::Scene;

/// Divergence of perturbed runs, relative to the largest value, at which pointwise comparison ends.
pub const PARTED: f64 = 1e-9;

/// Moves the grain in the middle of the list by one unit in the last place.
pub fn move_one(scene: &mut Scene) {
    let middle = scene.grains.len() / 2;
    if let Some(grain) = scene.grains.get_mut(middle) {
        // An axis with a nonzero coordinate is chosen, because the number after zero is too small to be a length.
        let axis = (0..3).find(|&axis| grain.position[axis] != 0.0).unwrap_or(0);
        grain.position[axis] = grain.position[axis].next_up();
    }
}
