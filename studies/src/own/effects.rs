//! Importance of the effects of a scene, within the time budget of its cost study.

use super::cost::{MATTERS, Measurement, PARTS, SceneStudy, StudyFollower};
use super::within::Within;
use crate::effects::scene::StudyInput;
use crate::run_cache::key_of_run;
use grainbench_reports::number;
use grainbench_reports::study::effects::Entry;
use grainbench_scene::effect::Effect;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use grainbench_store::WriteError;

/// Switches off each effect that the scene uses, with the first solver that has measured levels. Also returns a remark if
/// effects were left out because of the time.
///
/// # Errors
/// When a result cannot be stored.
pub fn measure(
    study: &SceneStudy<'_>,
    measured: &Measurement<'_>,
    follower: &mut dyn StudyFollower,
) -> Result<(Vec<Entry>, Option<String>), WriteError> {
    let command = format!("`grainbench effects {}` tests all effects.", study.name);
    let effects = |name: &str| -> Vec<Effect> {
        let concerns = |effect: &Effect| Method::from_name(name).is_none_or(|method| effect.concerns(method));
        Effect::switches().filter(|effect| effect.key(study.scene).is_some()).filter(concerns).collect()
    };
    let extra = if measured.is_chaotic() { 5.0 } else { 2.0 };
    let first = study.names.iter().find_map(|name| {
        let runs = effects(name).len() as f64 + extra;
        let (resolution, seconds) = measured.resolution_within(name, measured.remaining(PARTS[2]) / runs)?;
        Some((name, resolution, seconds * runs))
    });
    let Some((name, resolution, seconds)) = first else { return Ok((Vec::new(), None)) };
    let effects = effects(name);
    if effects.is_empty() {
        return Ok((Vec::new(), None));
    }
    if seconds > measured.remaining(1.0) {
        let reason = format!("Effects were left out: their runs need about {}. {command}", number::seconds(seconds));
        return Ok((Vec::new(), Some(reason)));
    }
    let program = study.program.clone() + &study.solvers.edition(name);
    let id = key_of_run(&program, name, study.scene, &resolution, "effects of a scene");
    if let Ok(entries) = study.cache.get(&id) {
        return Ok((entries, None));
    }
    let Some(solver) = study.solvers.find(name) else { return Ok((Vec::new(), None)) };
    let deadline = measured.deadline(measured.remaining(1.05));
    let within = Within::new(&*solver, deadline, study.stop);
    let scene = Scene { snapshots: 0, snapshot_times: Vec::new(), ..study.scene.clone() };
    let input = StudyInput { name: study.name.clone(), scene: &scene, solver: &within, resolution, matters: MATTERS };
    follower.now(&format!("{name}: all effects"), measured.spent());
    let whole = match input.whole() {
        Ok(whole) => whole,
        Err(error) => return Ok((Vec::new(), Some(format!("Effects were left out: {error}. {command}")))),
    };
    let mut entries = Vec::new();
    for effect in effects {
        follower.now(&format!("{name}: without {}", effect.word()), measured.spent());
        let entry = input.entry(&whole, effect);
        if measured.is_stopped() {
            return Ok((entries, None));
        }
        if within.0.is_cut() {
            return Ok((entries, Some(format!("Some effects were left out because of the time. {command}"))));
        }
        entries.extend(entry);
    }
    study.cache.put(&id, &entries)?;
    Ok((entries, None))
}
