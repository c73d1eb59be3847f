//! An absent effect, compiled in with a value that does nothing: the answer bit by bit, and what it costs.

use crate::clock;
use grainbench_cases::effect::Effect;
use grainbench_cases::solvers;
use grainbench_scene::record::Record;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_scene::solver::{Resolution, RunError, Solver};

/// Steps at most: enough for contacts to open and close.
const STEPS: u64 = 20_000;
/// Particle-steps at most.
const PARTICLE_STEPS: u64 = 4_000_000;
/// Times that both are run, in turn.
const REPETITIONS: usize = 3;

/// What was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Idle {
    /// Whether every number is the same, the sign of zero apart.
    pub same: bool,
    /// Particle-steps and contact evaluations with it over those without it.
    pub counts: f64,
    /// Processor time with it over that without it, the shortest of each.
    pub time: f64,
}

/// Tries an effect in a scene that does not call for it; none where there is no value that does nothing.
///
/// # Errors
/// When the solver cannot run the scene.
pub fn try_idly(
    solver: &str,
    scene: &Scene,
    resolution: &Resolution,
    effect: Effect,
) -> Result<Option<Idle>, RunError> {
    let mut plain = scene.clone();
    if let Ok((time_step, steps)) = resolution.steps(scene) {
        let most = STEPS.min(PARTICLE_STEPS / scene.grains.len().max(1) as u64).max(1);
        if steps > most {
            plain.duration = match scene.duration {
                Duration::Cycles(_) => Duration::Cycles(most),
                Duration::Seconds(_) => Duration::Seconds(time_step * most as f64),
            };
        }
    }
    let mut idle = plain.clone();
    let Some(solver) = solvers::by_name(solver).filter(|_| effect.switch_on_idly(&mut idle)) else { return Ok(None) };
    // The critical step is that of the scene as it is: a material that nobody has must not change it.
    let resolution = match resolution.steps(&plain) {
        Ok((time_step, _)) => Resolution::TimeStep(time_step),
        Err(_) => *resolution,
    };
    let mut times = [f64::INFINITY; 2];
    let mut records = [None, None];
    for _ in 0..REPETITIONS {
        for (at, scene) in [&plain, &idle].into_iter().enumerate() {
            let (record, time) = timed(&*solver, scene, &resolution)?;
            times[at] = times[at].min(time);
            records[at] = Some(record);
        }
    }
    let [Some(without), Some(with)] = records else { return Ok(None) };
    let work = |record: &Record| (record.cost.particle_steps + record.cost.contact_evaluations) as f64;
    Ok(Some(Idle {
        same: same(&without, &with),
        counts: work(&with) / work(&without).max(1.0),
        time: times[1] / times[0].max(f64::MIN_POSITIVE),
    }))
}

fn timed(solver: &dyn Solver, scene: &Scene, resolution: &Resolution) -> Result<(Record, f64), RunError> {
    let start = clock::cpu_seconds();
    let record = solver.run(scene, resolution, &mut ())?;
    Ok((record, clock::cpu_seconds() - start))
}

/// Whether two records end in the same numbers. Equality of numbers is that of bits but for the sign of zero. A spin that
/// nothing can change is not carried along without friction, and is left out.
fn same(a: &Record, b: &Record) -> bool {
    let (Some(a), Some(b)) = (a.snapshots.last(), b.snapshots.last()) else { return false };
    a.grains.len() == b.grains.len()
        && a.contacts.len() == b.contacts.len()
        && a.grains
            .iter()
            .zip(&b.grains)
            .all(|(a, b)| a.position == b.position && a.velocity == b.velocity && a.force == b.force)
}
