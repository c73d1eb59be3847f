//! Comparison of the features of a scene with those that a program declares.

use super::manifest::{Capabilities, Manifest, Wall};
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{Scene, WallShape};
use grainbench_solver::resolution::Resolution;
use std::collections::BTreeSet;

/// Returns the reason why a program cannot run a scene at a resolution, or `None` if it declares all required
/// features.
pub(super) fn lacks(manifest: &Manifest, scene: &Scene, resolution: &Resolution) -> Option<String> {
    let can = &manifest.can;
    let dimension = scene.dimension.count();
    if !can.dimension.contains(&dimension) {
        return Some(format!("{UNDECLARED}scenes in {dimension} dimensions"));
    }
    if let Some(reason) = inexpressible(scene) {
        return Some(reason);
    }
    if !scene.grains.is_empty() && manifest.output.grains.is_none() {
        return Some("its manifest declares no output of grains (`output.grains`)".to_owned());
    }
    let deforms = matches!(resolution, Resolution::Grid { .. });
    let law = if deforms { lacks_material(can, scene) } else { lacks_law(can, scene) };
    law.or_else(|| undeclared(can, scene, deforms))
}

/// Start of the reason of a scene with features that a manifest does not declare.
const UNDECLARED: &str = "it does not declare ";

/// Returns the reason for all missing walls and effects of a scene, such as ``it does not declare effects `friction`,
/// `cohesion` ``, or `None`.
fn undeclared(can: &Capabilities, scene: &Scene, deforms: bool) -> Option<String> {
    if !scene.driven.is_empty() && !can.driven {
        return Some(format!("{UNDECLARED}driven grains (`can.driven`)"));
    }
    let missing = [("walls", lacks_walls(can, scene)), ("effects", lacks_effects(can, scene, deforms))];
    let part = |(key, names): (&str, Vec<&str>)| {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        (!names.is_empty()).then(|| format!("{key} {}", names.join(", ")))
    };
    let parts: Vec<String> = missing.into_iter().filter_map(part).collect();
    (!parts.is_empty()).then(|| format!("{UNDECLARED}{}", parts.join("; ")))
}

/// Returns the missing features that the reason of an unsupported scene names: the key of `[can]` and the name of each.
pub fn named_features(reason: &str) -> Vec<(&str, &str)> {
    let Some((_, missing)) = reason.split_once(UNDECLARED) else { return Vec::new() };
    let of_part = |part| {
        let key = ["walls", "effects", "laws", "deformable"].into_iter().find(|key| str::starts_with(part, key));
        key.into_iter().flat_map(move |key| str::split(part, '`').skip(1).step_by(2).map(move |name| (key, name)))
    };
    missing.split("; ").flat_map(of_part).collect()
}

/// Returns a message about the first feature of a scene that resolved scenes cannot express, or `None`.
pub fn inexpressible(scene: &Scene) -> Option<String> {
    if let Some(what) = scene.passing().or_else(|| scene.gathered()) {
        return Some(format!("resolved scenes cannot express {what}"));
    }
    if let Some(wall) = scene.walls.iter().find(|wall| !wall.motion.functions.is_empty()) {
        return Some(format!("resolved scenes cannot express the sine or ramp of wall `{}`", wall.name));
    }
    let driven = scene.driven.iter().find(|driven| !driven.motion.is_empty() || driven.spin.norm() > 0.0)?;
    Some(format!("resolved scenes cannot express the spin or motion of the driven grains `{}`", driven.name))
}

/// Returns a message about the first feature that the program lacks for rigid grains, or `None`.
fn lacks_law(can: &Capabilities, scene: &Scene) -> Option<String> {
    if let Some(what) = scene.needs_deformable() {
        return Some(match can.deformable[..] {
            [] => format!("it declares no deformable bodies (`can.deformable`), but the scene has {what}"),
            _ => format!("the scene has {what}, but the resolution sets no grid cells"),
        });
    }
    for law in scene.laws.iter().flatten() {
        let law = law.springs.kind();
        if !can.laws.contains(&law) {
            return Some(format!("{UNDECLARED}laws `{}`", law.word()));
        }
    }
    None
}

/// Returns a message about the first feature that the program lacks for deformable grains and bodies, or `None`. Their
/// contacts have friction but no springs.
fn lacks_material(can: &Capabilities, scene: &Scene) -> Option<String> {
    if can.deformable.is_empty() {
        return Some("it declares no deformable bodies (`can.deformable`)".to_owned());
    }
    if scene.start.manufactured.is_some() || scene.start.initial_pressure.is_some() {
        return scene.start.needs_deformable().map(|what| format!("a manifest cannot declare {what}"));
    }
    if let Some(body) = scene.bodies.iter().find(|body| body.stress.is_some()) {
        return Some(format!("body `{}` starts with a stress, which a manifest cannot declare", body.name));
    }
    let used = scene.grains.iter().map(|grain| grain.material).chain(scene.bodies.iter().map(|body| body.material));
    used.into_iter().find_map(|place| {
        let name = &scene.materials[usize::from(place)];
        let Some(material) = scene.deformable.get(usize::from(place)).copied().flatten() else {
            return Some(format!("material `{name}` has no elastic moduli"));
        };
        let law = material.constitutive.kind();
        (!can.deformable.contains(&law)).then(|| format!("{UNDECLARED}deformable `{law}`"))
    })
}

/// Returns the shapes of walls that the program does not declare, each once.
fn lacks_walls(can: &Capabilities, scene: &Scene) -> Vec<&'static str> {
    let missing = scene.walls.iter().filter_map(|wall| {
        let (kind, word) = match wall.shape {
            WallShape::Plane { .. } => (Wall::Plane, "plane"),
            WallShape::Segment { .. } => (Wall::Segment, "segment"),
            WallShape::Rectangle { .. } => (Wall::Rectangle, "rectangle"),
            WallShape::Round { .. } => (Wall::Round, "round"),
            WallShape::Mesh(_) => (Wall::Mesh, "mesh"),
        };
        (!can.walls.contains(&kind)).then_some(word)
    });
    BTreeSet::from_iter(missing).into_iter().collect()
}

/// Returns the effects of the scene that the program does not declare.
fn lacks_effects(can: &Capabilities, scene: &Scene, deforms: bool) -> Vec<&'static str> {
    let is_asked = |effect: &Effect| match effect {
        // Every program must support gravity. Hertz contacts are declared as a law.
        Effect::Gravity | Effect::Hertz => false,
        // Contacts of deformable bodies have no dashpots. Their plasticity and viscosity are declared as laws of
        // materials.
        Effect::ContactDamping | Effect::Restitution | Effect::Plasticity | Effect::Viscosity => !deforms,
        _ => true,
    };
    let called_for = Effect::ALL.into_iter().filter(|effect| is_asked(effect) && effect.is_on(scene));
    called_for.map(Effect::key_word).filter(|name| !can.effects.iter().any(|known| known == name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_read_from_the_reason() {
        let reason = "one cannot run this scene: it does not declare walls `mesh`; effects `friction`, `cohesion`";
        assert_eq!(named_features(reason), [("walls", "mesh"), ("effects", "friction"), ("effects", "cohesion")]);
        assert_eq!(named_features("it does not declare laws `hertz-mindlin`"), [("laws", "hertz-mindlin")]);
        for other in ["it moves one grain", "it does not declare driven grains (`can.driven`)"] {
            assert_eq!(named_features(other), []);
        }
    }
}
