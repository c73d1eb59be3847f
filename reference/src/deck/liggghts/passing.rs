//! Temporary walls, insertion and removal of grains, and pistons.

use grainbench_scene::scene::Scene;

use crate::deck::Stepping;
use crate::deck::asks_for_wall;
use crate::deck::outline::AxisPlane;
use crate::deck::schedule::gone_at;

/// Returns an error if the scene inserts or removes grains, has pistons or initial springs, or removes a wall that
/// LIGGGHTS must keep.
pub(super) fn refuse(scene: &Scene) -> Result<(), String> {
    if !scene.stays.entries.is_empty() {
        return Err(
            "its grains are poured at places and times of their own: LIGGGHTS (`fix insert`) draws both itself; \
                    begin with the deposit (`simulate --state`)"
                .to_owned(),
        );
    }
    if scene.stays.removal.is_some() {
        return Err(
            "grains are taken out of it: LIGGGHTS has no `fix evaporate`, and loses grains beyond its box only \
                    when it rebuilds its lists, which is at no step of the scene"
                .to_owned(),
        );
    }
    if scene.walls.iter().any(|wall| wall.piston.is_some()) {
        return Err("it has a wall that is pressed: the servo wall of LIGGGHTS (`mesh/surface/stress/servo`) is a controller that \
                    sets a speed, and has no mass"
            .to_owned());
    }
    if scene.springs.is_some() {
        return Err(
            "its contacts remember something at the start, and a data file of LIGGGHTS holds no springs (`springs = \
                    false` beside the state leaves that out)"
                .to_owned(),
        );
    }
    for (number, wall) in (1..).zip(&scene.walls).filter(|(_, wall)| wall.until.is_some()) {
        if AxisPlane::from_wall(wall).is_none() {
            let name = &wall.name;
            return Err(format!(
                "`{name}` is removed and needs a mesh: one `fix wall/gran` has all meshes, and keeps them"
            ));
        }
        if asks_for_wall(scene, number) {
            let name = &wall.name;
            return Err(format!("`{name}` is removed, and its force is requested: LIGGGHTS then has no wall"));
        }
    }
    Ok(())
}

/// Returns the walls that are removed, by number from 1, and the steps at which a run without them begins.
///
/// LIGGGHTS recomputes all forces at the start of that run. It therefore omits half of the impulse of the wall in
/// that step, while our solvers omit all of it.
pub(super) fn gone(scene: &Scene, stepping: &Stepping) -> Vec<(usize, u64)> {
    (1..).zip(&scene.walls).filter_map(|(number, wall)| Some((number, gone_at(wall.until?, stepping)))).collect()
}
