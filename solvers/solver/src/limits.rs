//! Limits of the number of steps and of the size of a record. They are checked before the first step.

use crate::probe_columns;
use grainbench_scene::memory;
use grainbench_scene::scene::{Sampling, Scene};

/// Limit of the number of steps of any solver. A run with this number of steps takes thirty years at a million steps
/// per second.
const MOST_STEPS: f64 = 1e15;

/// Returns an error message for a number of steps that is too large; `None` for other numbers.
#[must_use]
pub fn beyond_steps(steps: f64) -> Option<String> {
    (steps.is_nan() || steps >= MOST_STEPS)
        .then(|| format!("expected fewer than {MOST_STEPS:e} steps, found {steps:.3e}"))
}

/// Returns an error message for a run with steps of `time_step` (s) that has too many steps, or whose record does not
/// fit into memory; `None` for other runs.
#[must_use]
pub fn beyond_run(scene: &Scene, time_step: f64, steps: f64) -> Option<String> {
    beyond_steps(steps).or_else(|| beyond_memory(scene, time_step, steps))
}

/// Memory of one snapshot in the list of due steps and in the index of stored snapshots (B).
const BYTES_OF_A_SNAPSHOT: f64 = 200.0;
/// Memory of a value in a time series (B). A growing list reserves up to twice the memory of its values.
const BYTES_OF_A_VALUE: f64 = 16.0;

/// Returns the number of steps between samples.
pub(crate) fn interval(scene: &Scene, time_step: f64, steps: u64) -> u64 {
    let interval = match scene.sampling {
        Sampling::Cycles(cycles) => cycles,
        Sampling::Seconds(time) => (time / time_step).round() as u64,
        Sampling::Count(count) => steps / count.max(1),
    };
    interval.max(1)
}

/// Returns an error message, with the key of the scene, for output that does not fit into memory; `None` if it fits.
/// The rows of snapshots do not count, because they can be written to the disk one snapshot after the other.
fn beyond_memory(scene: &Scene, time_step: f64, steps: f64) -> Option<String> {
    let samples = steps / interval(scene, time_step, steps as u64) as f64;
    let key = match scene.sampling {
        Sampling::Cycles(_) => "output.every_cycles",
        Sampling::Seconds(_) | Sampling::Count(_) => "output.every",
    };
    // Each sample also has a step and a time.
    let values = samples * (probe_columns::count(scene) + 2) as f64;
    let of_samples = (key, "values of samples", values, BYTES_OF_A_VALUE);
    let snapshots = f64::from(scene.snapshots).min(steps);
    let of_snapshots = ("output.snapshots", "snapshots", snapshots, BYTES_OF_A_SNAPSHOT);
    [of_samples, of_snapshots].into_iter().find_map(|(key, what, count, bytes)| {
        let found = memory::beyond(count, what, bytes)?;
        Some(format!("{key}: expected {what} that fit into memory, found {found}"))
    })
}
