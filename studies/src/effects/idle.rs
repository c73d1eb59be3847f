//! Test of effects that are off. Each effect is turned on with a neutral value. The final positions, velocities and
//! forces must not change by a single bit, except for the sign of zero. The additional cost is measured.

use super::{ratio_of_counts, ratio_of_times};
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{self, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use std::time::{Duration, Instant};

/// Maximum number of steps, enough for contacts to open and close.
const STEPS: u64 = 20_000;
/// Maximum number of particle-steps.
const PARTICLE_STEPS: u64 = 4_000_000;
/// Minimum number of pairs of runs with and without the effect.
const FEWEST: usize = 3;
/// Maximum number of pairs of runs with and without the effect.
const MOST: usize = 15;
/// Time limit for further pairs of runs.
const PATIENCE: Duration = Duration::from_millis(300);

/// Result of a trial of an effect with its neutral value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeutralTrial {
    /// True if positions, velocities and forces of all grains and the number of contacts are equal at the end. The sign of
    /// zero is ignored.
    pub same: bool,
    /// Sum of particle-steps and contact evaluations with the effect, divided by the sum without it.
    pub counts: f64,
    /// Median ratio of the times of the stepping loop with and without the effect; `None` if a run is too short to
    /// time.
    pub time: Option<f64>,
}

/// Compares a scene with and without an effect at its neutral value, in alternating runs. The scene is shortened to a
/// maximum number of steps.
///
/// After three pairs, further pairs are run until a time limit, in total at most 15 pairs. Returns `None` if the effect has no
/// neutral value.
///
/// # Errors
/// When the solver cannot run the scene.
pub fn try_idly(
    solver: &dyn Solver,
    scene: &Scene,
    resolution: &Resolution,
    effect: Effect,
) -> Result<Option<NeutralTrial>, RunError> {
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
    // The critical step is that of the scene without the effect, because an unused material must not change the step.
    let resolution = match resolution.steps(&plain) {
        Ok((time_step, _)) => Resolution::TimeStep(time_step),
        Err(_) => *resolution,
    };
    let run = |scene: &Scene| solver.run(scene, &resolution, &mut ());
    let mut ratios: Vec<Option<f64>> = Vec::new();
    let start = Instant::now();
    let (without, with) = loop {
        let (without, with) = (run(&plain)?, run(&idle)?);
        ratios.push(ratio_of_times(&with, &without));
        if ratios.len() >= FEWEST && (ratios.len() >= MOST || start.elapsed() >= PATIENCE) {
            break (without, with);
        }
    };
    let mut timed: Vec<f64> = ratios.iter().copied().flatten().collect();
    timed.sort_by(f64::total_cmp);
    Ok(Some(NeutralTrial {
        same: same(&without, &with),
        counts: ratio_of_counts(&with, &without),
        time: timed.get(timed.len() / 2).copied().filter(|_| timed.len() == ratios.len()),
    }))
}

/// Returns true if two records end with equal positions, velocities and forces of all grains and equal numbers of
/// contacts. The sign of zero is ignored.
///
/// Spins are not compared, because solvers do not integrate them if no torque can act.
fn same(a: &Record, b: &Record) -> bool {
    let (Some(a), Some(b)) = (a.snapshots.last(), b.snapshots.last()) else { return false };
    a.grains.len() == b.grains.len()
        && a.told_contacts().len() == b.told_contacts().len()
        && a.grains
            .iter()
            .zip(&b.grains)
            .all(|(a, b)| a.position == b.position && a.velocity == b.velocity && a.force == b.force)
}
