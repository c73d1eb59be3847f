//! What a scene calls for that a program does not declare.

use super::manifest::{Can, Law, Wall};
use grainbench_scene::contact_law::Springs;
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{Scene, WallShape};

/// Why a scene is not given to a program, in words; none where it declares all that the scene calls for.
pub(super) fn lacks(can: &Can, scene: &Scene) -> Option<String> {
    let dimension = scene.dimension.count();
    if !can.dimension.contains(&dimension) {
        return Some(format!("it declares no scenes of {dimension} dimensions"));
    }
    if let Some(what) = scene.needs_deformable().or_else(|| scene.passing()) {
        return Some(format!("{what} cannot be declared"));
    }
    for law in scene.laws.iter().flatten() {
        let (law, word) = match law.springs {
            Springs::Absent => (Law::Coulomb, "coulomb"),
            Springs::Linear { .. } => (Law::Linear, "linear"),
            Springs::Hertz { .. } => (Law::HertzMindlin, "hertz-mindlin"),
        };
        if !can.laws.contains(&law) {
            return Some(format!("it does not declare the law `{word}`"));
        }
    }
    for wall in &scene.walls {
        let (kind, word) = match wall.shape {
            WallShape::Plane { .. } => (Wall::Plane, "plane"),
            WallShape::Segment { .. } => (Wall::Segment, "segment"),
            WallShape::Rectangle { .. } => (Wall::Rectangle, "rectangle"),
            WallShape::Round { .. } => (Wall::Round, "round"),
        };
        if !can.walls.contains(&kind) {
            return Some(format!("it does not declare walls that are a `{word}`"));
        }
    }
    if !scene.driven.is_empty() && !can.driven {
        return Some("it does not declare driven grains (`can.driven`)".to_owned());
    }
    // Whoever moves grains at all lets them fall, and Hertz' law is declared as a law.
    let of_all = [Effect::Gravity, Effect::Hertz];
    let called_for = Effect::ALL.into_iter().filter(|effect| !of_all.contains(effect) && effect.is_on(scene));
    let mut missing = called_for.filter(|effect| !can.effects.iter().any(|name| name == effect.key_word()));
    missing.next().map(|effect| format!("it does not declare the effect `{}`", effect.key_word()))
}
