//! Scenes that a rigid-body engine does not support, each with its reason.

use grainbench_scene::effect::Effect;
use grainbench_scene::motion::Moment;
use grainbench_scene::overlap;
use grainbench_scene::scene::{Duration, Probe, ProbeTarget, Scene};

/// Largest supported initial overlap, relative to the smaller radius.
const DEEPEST: f64 = 0.25;

/// Returns the reason why a scene is not supported, or `None` if it is supported.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    if let Some(what) = scene.passing().or_else(|| scene.gathered()) {
        return Some(format!("it has {what}, which only `dem` supports"));
    }
    if let Some(what) = scene.round_wall().or_else(|| scene.mesh_wall()) {
        return Some(format!("{what}, which only `dem` supports"));
    }
    if let Some(what) = scene.needs_deformable() {
        return Some(format!("it has {what}, but the grains of rapier are rigid"));
    }
    if !scene.driven.is_empty() {
        return Some("driven grains are not supported with rapier".to_owned());
    }
    let overlap = overlap::deepest(&scene.grains, &scene.walls, scene.domain.as_ref(), 1.0);
    if let Some(deepest) = overlap.filter(|deepest| deepest.ratio() > DEEPEST) {
        let found = deepest.words(&scene.walls);
        return Some(format!(
            "found {found} at the start, expected at most {DEEPEST}: overlapping rigid grains store no energy, and the \
             engine separates them at its own rate"
        ));
    }
    if scene.is_periodic() {
        return Some("rapier has no periodic axes".to_owned());
    }
    if scene.laws.iter().flatten().any(|law| law.cohesion != 0.0) {
        return Some("the contacts of rapier can only push, so it has no cohesion".to_owned());
    }
    if Effect::RollingResistance.is_on(scene) {
        return Some("rapier has no rolling resistance".to_owned());
    }
    if scene.laws.iter().flatten().any(|law| law.is_hertz() && law.normal_damping != 0.0) {
        let reason = "a mass-proportional dashpot at a Hertz contact gives a restitution that depends on speed, which \
                      a rigid contact cannot reproduce; use `restitution`";
        return Some(reason.to_owned());
    }
    if matches!(scene.duration, Duration::Cycles(_)) {
        return Some(
            "its duration is a number of calculation cycles, whose length is a fraction of the period of the contact \
             springs, but rigid contacts have no springs; use a duration in seconds"
                .to_owned(),
        );
    }
    if scene.probes.iter().any(|probe| matches!(probe.target, ProbeTarget::Budget)) {
        return Some(
            "it requests an energy budget, but rapier has no energies of springs, friction and damping".to_owned(),
        );
    }
    let of_contact = |probe: &Probe| !matches!(probe.target, ProbeTarget::Grain(_) | ProbeTarget::System);
    if !scene.probes.is_empty() && scene.probes.iter().all(of_contact) {
        let reason = "it requests only overlaps and forces over time, but rigid contacts have only impulses within a \
          step";
        return Some(reason.to_owned());
    }
    let in_cycles = |moment: Moment| matches!(moment, Moment::Cycle(cycle) if cycle > 0);
    let wall = scene
        .walls
        .iter()
        .find(|wall| wall.motion.phases.iter().any(|phase| in_cycles(phase.start) || in_cycles(phase.stop)))?;
    Some(format!(
        "the motion of wall `{}` starts or stops at a calculation cycle, whose length is a fraction of the period of \
         the contact springs, but rigid contacts have no springs; use times in seconds",
        wall.name
    ))
}
