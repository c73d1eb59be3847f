//! Temporary walls, insertion and removal of grains, and pistons.

use grainbench_scene::scene::Scene;

use crate::deck::Stepping;
use crate::deck::outline::AxisPlane;
use crate::deck::schedule::gone_at;
use crate::deck::script::asks_for_wall;

/// Returns an error if the scene inserts or removes grains, or has pistons or initial springs. A wall that is removed
/// must not be a mesh, and its force must not be requested.
pub(super) fn refuse(scene: &Scene) -> Result<(), String> {
    if !scene.stays.entries.is_empty() {
        return Err(
            "its grains are poured at given places and times, but LIGGGHTS (`fix insert`) chooses both at random; \
                    start from the deposited grains (`simulate --state`)"
                .to_owned(),
        );
    }
    if scene.stays.removal.is_some() {
        return Err(
            "it removes grains, but LIGGGHTS has no `fix evaporate` and removes grains outside its box only when it \
                    rebuilds its neighbour lists, at steps that the scene does not set"
                .to_owned(),
        );
    }
    if scene.walls.iter().any(|wall| wall.piston.is_some()) {
        return Err(
            "it has a piston, but the servo wall of LIGGGHTS (`mesh/surface/stress/servo`) is a controller that \
                    sets a speed and has no mass"
                .to_owned(),
        );
    }
    if scene.springs.is_some() {
        return Err(
            "its contacts have springs at the start, but a data file of LIGGGHTS contains no springs (`springs = \
                    false` next to the state omits them)"
                .to_owned(),
        );
    }
    for (number, wall) in (1..).zip(&scene.walls).filter(|(_, wall)| wall.until.is_some()) {
        if AxisPlane::from_wall(wall).is_none() {
            let name = &wall.name;
            return Err(format!(
                "`{name}` is removed and needs a mesh, but a single `fix wall/gran` holds all meshes and cannot remove \
                 one"
            ));
        }
        if asks_for_wall(scene, number) {
            let name = &wall.name;
            return Err(format!("`{name}` is removed, but its force is requested until the end"));
        }
    }
    Ok(())
}

/// Returns the numbers of the walls that are removed, counted from 1, and the step at which a run without each wall
/// begins.
///
/// LIGGGHTS recomputes all forces at the start of this run. It therefore omits half of the wall's impulse in this step,
/// while our solvers omit all of it.
pub(super) fn gone(scene: &Scene, stepping: &Stepping) -> Vec<(usize, u64)> {
    (1..).zip(&scene.walls).filter_map(|(number, wall)| Some((number, gone_at(wall.until?, stepping)))).collect()
}
