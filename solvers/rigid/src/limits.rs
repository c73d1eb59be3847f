//! Scenes that a rigid-body engine does not support, each with its reason.

use grainbench_scene::effects::Effects;
use grainbench_scene::motion::Moment;
use grainbench_scene::overlap;
use grainbench_scene::scene::{Duration, Probe, ProbeTarget, Scene};

/// Largest initial overlap, relative to the smaller radius; a larger overlap is treated as an error.
const DEEPEST: f64 = 0.25;

/// Returns the reason why a scene is not supported, or `None`.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    if let Some(what) = scene.passing().or_else(|| scene.gathered()) {
        return Some(format!("it has {what}, which was written for `dem` alone"));
    }
    if let Some(what) = scene.round_wall().or_else(|| scene.mesh_wall()) {
        return Some(format!("{what}, which was written for `dem` alone"));
    }
    if let Some(what) = scene.needs_deformable() {
        return Some(format!("it has {what}, and rapier's grains are rigid"));
    }
    if !scene.driven.is_empty() {
        return Some("grains that are moved as walls are were not written for rapier".to_owned());
    }
    let overlap = overlap::deepest(&scene.grains, &scene.walls, scene.domain.as_ref(), 1.0);
    if let Some(deepest) = overlap.filter(|deepest| deepest.ratio() > DEEPEST) {
        let found = deepest.words(&scene.walls);
        return Some(format!(
            "found {found} at the start, expected at most {DEEPEST}: rigid grains have no energy to part with, and the engine \
             pulls them apart at a rate of its own"
        ));
    }
    let effects = Effects::from_scene(scene);
    if effects.periodic {
        return Some("rapier has no periodic axes".to_owned());
    }
    if scene.laws.iter().flatten().any(|law| law.cohesion != 0.0) {
        return Some("rapier's contacts only push: it has no cohesion".to_owned());
    }
    if effects.rolling_resistance {
        return Some("rapier has no resistance against rolling".to_owned());
    }
    if scene.laws.iter().flatten().any(|law| law.is_hertz() && law.normal_damping != 0.0) {
        let reason = "a mass-proportional dashpot on a Hertz contact gives a restitution that depends on speed, which a rigid \
                      contact cannot; `restitution` can be run";
        return Some(reason.to_owned());
    }
    if matches!(scene.duration, Duration::Cycles(_)) {
        return Some(
            "its duration is a number of calculation cycles, whose length is a fraction of the period of the contacts' \
             springs; rigid contacts have none. A duration in seconds can be run"
                .to_owned(),
        );
    }
    if scene.probes.iter().any(|probe| matches!(probe.target, ProbeTarget::Budget)) {
        return Some(
            "it asks for an energy budget, and rapier has no energies of springs, friction and damping".to_owned(),
        );
    }
    let of_contact = |probe: &Probe| !matches!(probe.target, ProbeTarget::Grain(_) | ProbeTarget::System);
    if !scene.probes.is_empty() && scene.probes.iter().all(of_contact) {
        let reason = "it asks for nothing but overlaps and forces over time, which rigid contacts do not have: \
          theirs are impulses \
                      within a step";
        return Some(reason.to_owned());
    }
    let in_cycles = |moment: Moment| matches!(moment, Moment::Cycle(cycle) if cycle > 0);
    let wall = scene
        .walls
        .iter()
        .find(|wall| wall.motion.phases.iter().any(|phase| in_cycles(phase.start) || in_cycles(phase.stop)))?;
    Some(format!(
        "the motion of wall `{}` starts or stops at a calculation cycle, whose length is a fraction of the period of the \
         contacts' springs; rigid contacts have none. Moments in seconds can be run",
        wall.name
    ))
}
