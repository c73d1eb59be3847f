//! Scenes that the method does not support, each with its reason.

use grainbench_scene::body::Block;
use grainbench_scene::dimension::GrainShape;
use grainbench_scene::motion::Moment;
use grainbench_scene::overlap;
use grainbench_scene::scene::{Duration, Scene, WallShape};

/// Returns the reason why the method does not support a scene, or `None` if it supports the scene.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    if let Some(what) = scene.passing().or_else(|| scene.gathered()) {
        return Some(format!("it has {what}, which only `dem` supports"));
    }
    let flat = scene.dimension.count() == 2;
    if flat && scene.grain_shape == GrainShape::Sphere && !scene.grains.is_empty() {
        return Some("a sphere in two dimensions is neither a disc in plane strain nor a free sphere".to_owned());
    }
    let used = scene.grains.iter().map(|grain| grain.material).chain(scene.bodies.iter().map(|body| body.material));
    let bare =
        used.into_iter().find(|&material| scene.deformable.get(usize::from(material)).is_none_or(Option::is_none));
    if let Some(material) = bare {
        return Some(format!(
            "material `{}` has no elastic moduli (`young_modulus` and `poisson_ratio`, or `bulk_modulus` and \
             `shear_modulus`), but this solver needs them because grains deform",
            scene.materials[usize::from(material)]
        ));
    }
    if let Some(refusal) = crate::points::stress_at_start::refusal(scene) {
        return Some(refusal);
    }
    if let Some((name, axis)) = longer_than_period(scene) {
        return Some(format!("body `{name}` is longer along {axis} than the period there: it would overlap itself"));
    }
    if let Some(wall) = scene.walls.iter().find(|wall| !matches!(wall.shape, WallShape::Plane { .. })) {
        return Some(format!("wall `{}` is not a plane", wall.name));
    }
    let overlap = overlap::deepest(&scene.grains, &scene.walls, scene.domain.as_ref(), 1.0);
    if let Some(deepest) = overlap.filter(|deepest| deepest.ratio() >= 1.0) {
        let found = deepest.words(&scene.walls);
        return Some(format!(
            "expected overlaps below 1 radius at the start, found {found}: surfaces inside each other have no defined \
             direction in which they separate"
        ));
    }
    if scene.laws.iter().flatten().any(|law| law.cohesion != 0.0) {
        return Some("its contacts can only push, so it has no cohesion".to_owned());
    }
    if scene.laws.iter().flatten().any(|law| law.rolling_friction > 0.0) {
        return Some("rolling resistance comes from the deformation of grains here, not from a coefficient".to_owned());
    }
    if let Some(reason) = crate::energy::accounts::reason(scene).filter(|_| scene.asks_for_budget()) {
        return Some(reason);
    }
    if scene.driven.iter().any(|driven| driven.spin != nalgebra::Vector3::zeros()) {
        return Some(
            "it has driven grains that rotate, but all nodes of a driven body have one velocity here".to_owned(),
        );
    }
    if matches!(scene.duration, Duration::Cycles(_)) {
        return Some("its duration is a number of calculation cycles of another method; use seconds".to_owned());
    }
    let in_cycles = |moment: Moment| matches!(moment, Moment::Cycle(cycle) if cycle > 0);
    let phases = scene.walls.iter().flat_map(|wall| &wall.motion.phases);
    if phases.into_iter().any(|phase| in_cycles(phase.start) || in_cycles(phase.stop)) {
        return Some("a wall starts or stops at a calculation cycle of another method; use seconds".to_owned());
    }
    None
}

/// Returns the name of a body that is longer than the period along an axis, and the name of this axis.
fn longer_than_period(scene: &Scene) -> Option<(&str, &'static str)> {
    let domain = scene.domain?;
    let names = ["x", "y", "z"];
    let longer = |body: &Block, axis: usize| {
        let (low, high) = body.shape.corners();
        let period = domain.high[axis] - domain.low[axis];
        // The tolerance covers rounding errors of lengths.
        domain.periodic[axis] && high[axis] - low[axis] > period * (1.0 + 1e-9)
    };
    let first = |body: &Block| (0..scene.dimension.count()).find(|&axis| longer(body, axis));
    scene.bodies.iter().find_map(|body| Some((body.name.as_str(), names[first(body)?])))
}
