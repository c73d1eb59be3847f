//! Steps at which walls change their velocity.

use grainbench_scene::motion::{Moment, Motion};
use nalgebra::Vector3;

use super::Stepping;

/// Returns the step of a time, or `None` if the time is not before the end of the run. A time between two steps is an
/// error.
fn step_of(moment: Moment, stepping: &Stepping) -> Result<Option<u64>, String> {
    let step = match moment {
        Moment::Never => return Ok(None),
        Moment::Cycle(cycle) => cycle,
        Moment::Seconds(time) => {
            let exact = time / stepping.time_step;
            if (exact - exact.round()).abs() > 1e-9 * exact.max(1.0) {
                return Err(format!("a wall changes its velocity at {time} s, which lies between two steps"));
            }
            exact.round() as u64
        }
    };
    Ok((step < stepping.steps).then_some(step))
}

/// Returns the first step without a wall that is removed at the time `until` (s): the first step that is not before
/// this time.
pub(crate) fn gone_at(until: f64, stepping: &Stepping) -> u64 {
    (until * (1.0 - 1e-9) / stepping.time_step).ceil() as u64
}

/// Returns the steps at which any wall changes its velocity, sorted. The first entry is 0, and the last is the end of
/// the run.
pub(crate) fn changes<'m>(motions: impl Iterator<Item = &'m Motion>, stepping: &Stepping) -> Result<Vec<u64>, String> {
    let mut steps = vec![0, stepping.steps];
    for phase in motions.flat_map(|motion| &motion.phases) {
        for moment in [phase.start, phase.stop] {
            steps.extend(step_of(moment, stepping)?);
        }
    }
    steps.sort_unstable();
    steps.dedup();
    Ok(steps)
}

/// Velocity and angular velocity of a wall between two changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rates {
    /// Velocity (m/s).
    pub(crate) velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub(crate) spin: Vector3<f64>,
}

/// Returns velocity and angular velocity of a wall from a step to the next change.
pub(crate) fn rates_from(motion: &Motion, step: u64, stepping: &Stepping) -> Result<Rates, String> {
    let mut rates = Rates::default();
    for phase in &motion.phases {
        let starts = step_of(phase.start, stepping)?.is_some_and(|start| start <= step);
        let stopped = step_of(phase.stop, stepping)?.is_some_and(|stop| stop <= step);
        if starts && !stopped {
            rates.velocity += phase.velocity;
            rates.spin += phase.spin;
        }
    }
    Ok(rates)
}
