//! Comparison of the features of a scene with those that a program declares.

use super::manifest::{Capabilities, Manifest, Wall};
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{Scene, WallShape};
use grainbench_solver::resolution::Resolution;

/// Returns the reason why a program cannot run a scene at a resolution, or `None` if it declares all required
/// features.
pub(super) fn lacks(manifest: &Manifest, scene: &Scene, resolution: &Resolution) -> Option<String> {
    let can = &manifest.can;
    let dimension = scene.dimension.count();
    if !can.dimension.contains(&dimension) {
        return Some(format!("it does not declare scenes in {dimension} dimensions"));
    }
    if let Some(reason) = inexpressible(scene) {
        return Some(reason);
    }
    if !scene.grains.is_empty() && manifest.output.grains.is_none() {
        return Some("its manifest declares no output of grains (`output.grains`)".to_owned());
    }
    let deforms = matches!(resolution, Resolution::Grid { .. });
    let law = if deforms { lacks_material(can, scene) } else { lacks_law(can, scene) };
    law.or_else(|| lacks_wall(can, scene)).or_else(|| lacks_effect(can, scene, deforms))
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
            return Some(format!("it does not declare the law `{}`", law.word()));
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
        (!can.deformable.contains(&law)).then(|| format!("it does not declare the law `{law}` of materials"))
    })
}

fn lacks_wall(can: &Capabilities, scene: &Scene) -> Option<String> {
    scene.walls.iter().find_map(|wall| {
        let (kind, word) = match wall.shape {
            WallShape::Plane { .. } => (Wall::Plane, "plane"),
            WallShape::Segment { .. } => (Wall::Segment, "segment"),
            WallShape::Rectangle { .. } => (Wall::Rectangle, "rectangle"),
            WallShape::Round { .. } => (Wall::Round, "round"),
            WallShape::Mesh(_) => (Wall::Mesh, "mesh"),
        };
        (!can.walls.contains(&kind)).then(|| format!("it does not declare walls of the shape `{word}`"))
    })
}

fn lacks_effect(can: &Capabilities, scene: &Scene, deforms: bool) -> Option<String> {
    if !scene.driven.is_empty() && !can.driven {
        return Some("it does not declare driven grains (`can.driven`)".to_owned());
    }
    let is_asked = |effect: &Effect| match effect {
        // Every program must support gravity. Hertz contacts are declared as a law.
        Effect::Gravity | Effect::Hertz => false,
        // Contacts of deformable bodies have no dashpots. Their plasticity and viscosity are declared as laws of
        // materials.
        Effect::ContactDamping | Effect::Restitution | Effect::Plasticity | Effect::Viscosity => !deforms,
        _ => true,
    };
    let called_for = Effect::ALL.into_iter().filter(|effect| is_asked(effect) && effect.is_on(scene));
    let mut missing = called_for.filter(|effect| !can.effects.iter().any(|name| name == effect.key_word()));
    missing.next().map(|effect| format!("it does not declare the effect `{}`", effect.key_word()))
}
