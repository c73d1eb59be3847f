//! An absent effect, compiled in with a value that does nothing: the answer bit by bit, and what it costs.

use grainbench_scene::effect::Effect;
use grainbench_scene::record::Record;
use grainbench_scene::scene::{self, Scene};
use grainbench_scene::solver::{Resolution, RunError, Solver};
use std::time::{Duration, Instant};

/// Steps at most: enough for contacts to open and close.
const STEPS: u64 = 20_000;
/// Particle-steps at most.
const PARTICLE_STEPS: u64 = 4_000_000;
/// Times that both are run, in turn, at least.
const FEWEST: usize = 3;
/// Times that both are run, in turn, at most.
const MOST: usize = 15;

/// What was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Idle {
    /// Whether every number is the same, the sign of zero apart.
    pub same: bool,
    /// Particle-steps and contact evaluations with it over those without it.
    pub counts: f64,
    /// Time of the loop with it over that without it, the median of runs in turn.
    pub time: f64,
}

/// Tries an effect in a scene that does not call for it, in so many runs in turn as there is `patience` for; none where
/// there is no value that does nothing.
///
/// # Errors
/// When the solver cannot run the scene.
pub fn try_idly(
    solver: &dyn Solver,
    scene: &Scene,
    resolution: &Resolution,
    effect: Effect,
    patience: Duration,
) -> Result<Option<Idle>, RunError> {
    let mut plain = scene.clone();
    if let Ok((time_step, steps)) = resolution.steps(scene) {
        let most = STEPS.min(PARTICLE_STEPS / scene.grains.len().max(1) as u64).max(1);
        if steps > most {
            plain.duration = match scene.duration {
                scene::Duration::Cycles(_) => scene::Duration::Cycles(most),
                scene::Duration::Seconds(_) => scene::Duration::Seconds(time_step * most as f64),
            };
        }
    }
    let mut idle = plain.clone();
    if !effect.switch_on_idly(&mut idle) {
        return Ok(None);
    }
    // The critical step is that of the scene as it is: a material that nobody has must not change it.
    let resolution = match resolution.steps(&plain) {
        Ok((time_step, _)) => Resolution::TimeStep(time_step),
        Err(_) => *resolution,
    };
    let mut ratios: Vec<f64> = Vec::new();
    let mut records = [None, None];
    let start = Instant::now();
    while ratios.len() < FEWEST || (ratios.len() < MOST && start.elapsed() < patience) {
        let mut times = [0.0; 2];
        for (at, scene) in [&plain, &idle].into_iter().enumerate() {
            let record = solver.run(scene, &resolution, &mut ())?;
            times[at] = record.cost.wall_seconds.max(f64::MIN_POSITIVE);
            records[at] = Some(record);
        }
        ratios.push(times[1] / times[0]);
    }
    ratios.sort_by(f64::total_cmp);
    let [Some(without), Some(with)] = records else { return Ok(None) };
    let work = |record: &Record| record.cost.work() as f64;
    Ok(Some(Idle {
        same: same(&without, &with),
        counts: work(&with) / work(&without).max(1.0),
        time: ratios[ratios.len() / 2],
    }))
}

/// Whether two records end in the same numbers. Equality of numbers is that of bits but for the sign of zero. A spin
/// that nothing can change is not carried along without friction, and is left out.
fn same(a: &Record, b: &Record) -> bool {
    let (Some(a), Some(b)) = (a.snapshots.last(), b.snapshots.last()) else { return false };
    a.grains.len() == b.grains.len()
        && a.told_contacts().len() == b.told_contacts().len()
        && a.grains
            .iter()
            .zip(&b.grains)
            .all(|(a, b)| a.position == b.position && a.velocity == b.velocity && a.force == b.force)
}
