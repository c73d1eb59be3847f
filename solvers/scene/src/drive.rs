//! The one loop by which every solver goes through a run: what is due is taken down, who watches hears of it,
//! checkpoints are left. And the one clock: it runs from the first step of any kind, settling included, to the last.

use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::record::{Cost, Look, Series, Snapshot};
use crate::recorder::Recorder;
use crate::scene::Scene;
use crate::solver::{RunError, Watch};
use std::time::Instant;

/// A state that takes steps.
pub trait Stepper {
    /// What is done before the clock of the scene starts, such as settling. It counts as work.
    ///
    /// # Errors
    /// When the simulation breaks.
    fn begin(&mut self) -> Result<(), RunError> {
        Ok(())
    }

    /// Steps taken.
    fn step(&self) -> u64;

    /// Takes so many steps.
    ///
    /// # Errors
    /// When the simulation breaks.
    fn advance(&mut self, steps: u64) -> Result<(), RunError>;

    /// The state after the last step; with all that a snapshot holds where one is due.
    fn look(&mut self, snapshot: bool) -> Look;

    /// Counts so far; no times.
    fn cost(&self) -> Cost;

    /// The state with the record so far; none of a solver that leaves no checkpoints.
    ///
    /// # Errors
    /// When it cannot be written down.
    fn keep(&self, _recorder: &Recorder) -> Result<Option<Checkpoint>, CheckpointError> {
        Ok(None)
    }
}

/// What there is to drive through.
pub struct Course<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Time step (s).
    pub time_step: f64,
    /// Steps of the whole run.
    pub steps: u64,
    /// The record of a run that is continued; none of one that begins.
    pub resumed: Option<Recorder>,
    /// Steps after which a watcher hears of progress at the latest.
    pub between_progress: u64,
}

/// What was left behind.
pub struct Driven {
    /// Time series.
    pub series: Series,
    /// Snapshots.
    pub snapshots: Vec<Snapshot>,
    /// Counts, and the time of all steps, settling included (s).
    pub cost: Cost,
}

impl Course<'_> {
    /// Drives a state from where it is to the end.
    ///
    /// # Errors
    /// When the simulation breaks, or a checkpoint cannot be left.
    pub fn drive(self, stepper: &mut dyn Stepper, watch: &mut dyn Watch) -> Result<Driven, RunError> {
        let Self { scene, time_step, steps, resumed, between_progress } = self;
        watch.begin(time_step, steps);
        let clock = Instant::now();
        let begins = resumed.is_none();
        if begins {
            stepper.begin()?;
        }
        let begun = Recorder::new(scene, time_step, steps);
        let first = stepper.step();
        let mut recorder = match resumed {
            None => begun,
            Some(resumed) if resumed.is_of(&begun) && first <= steps => resumed,
            Some(_) => {
                let reason = "its steps or samples are not those of the run that it says it is of";
                return Err(CheckpointError::Damaged(reason.to_owned()).into());
            }
        };
        // No checkpoint is wanted of where the run begins.
        let between_checkpoints = watch.checkpoint_interval().unwrap_or(u64::MAX).max(1);
        loop {
            let now = stepper.step();
            if (begins || now > first) && recorder.is_due(now) {
                let look = stepper.look(recorder.is_snapshot(now));
                recorder.take(scene, look);
                if let Some((column, value)) = recorder.not_finite() {
                    let (column, time) = (column.to_owned(), now as f64 * time_step);
                    return Err(RunError::NotFinite { time, step: now, column, value });
                }
            }
            watch.progress(now, steps);
            if now == steps {
                break;
            }
            if now > first
                && now.is_multiple_of(between_checkpoints)
                && let Some(checkpoint) = stepper.keep(&recorder)?
            {
                watch.checkpoint(checkpoint)?;
            }
            let checkpoint = (now / between_checkpoints + 1).saturating_mul(between_checkpoints);
            let stop = recorder.next(now).min(checkpoint).min(now + between_progress);
            stepper.advance(stop - now)?;
        }
        let mut cost = stepper.cost();
        cost.wall_seconds = clock.elapsed().as_secs_f64();
        let (series, snapshots) = recorder.finish();
        Ok(Driven { series, snapshots, cost })
    }
}
