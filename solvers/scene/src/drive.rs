//! The one loop by which every solver goes through a run: what is due is taken down, who watches hears of it,
//! checkpoints are left. And the one clock: it runs from the first step of any kind, settling included, to the last.

use crate::brief::Brief;
use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::end_state::EndState;
use crate::record::{Cost, Counts, Look, Remains, Series, Snapshot};
use crate::recorder::Recorder;
use crate::scene::Scene;
use crate::solver::{Ahead, RunError, Watch};
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

    /// Particles that take every step: grains, unless a solver says otherwise.
    fn particles(&self, scene: &Scene) -> u64 {
        scene.grains.len() as u64
    }

    /// Steps taken.
    fn step(&self) -> u64;

    /// Takes so many steps.
    ///
    /// # Errors
    /// When the simulation breaks.
    fn advance(&mut self, steps: u64) -> Result<(), RunError>;

    /// The state after the last step; with all that a snapshot holds where one is due. It is looked at once a step: who looks
    /// again may be told no contacts.
    fn look(&mut self, snapshot: bool) -> Look;

    /// Rows of grains, contacts and points that a snapshot has now.
    fn rows(&self, scene: &Scene) -> u64 {
        self.particles(scene)
    }

    /// Whether a snapshot can be shown now that has at most so many rows.
    fn shows(&self, scene: &Scene, most_rows: u64) -> bool {
        self.rows(scene) <= most_rows
    }

    /// The state after the last step in short, where nobody looks at it.
    fn brief(&mut self) -> Brief {
        Brief::of_look(&self.look(false))
    }

    /// Counts so far; no times.
    fn counts(&self) -> Counts;

    /// The state after the last step, for another scene to begin with; none of a solver that does not tell it.
    fn end_state(&self) -> Option<EndState> {
        None
    }

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
    /// When the simulation breaks, or a snapshot or a checkpoint cannot be left. Who watches hears of what there is of a
    /// simulation that broke.
    pub fn drive(mut self, stepper: &mut dyn Stepper, watch: &mut dyn Watch) -> Result<Driven, RunError> {
        let particles = stepper.particles(self.scene);
        watch.begin(Ahead { time_step: self.time_step, steps: self.steps, particles });
        let clock = Instant::now();
        let resumed = self.resumed.take();
        let begins = resumed.is_none();
        let begun = Recorder::new(self.scene, self.time_step, self.steps);
        let mut recorder = match resumed {
            None => begun,
            Some(resumed) if resumed.is_of(&begun) && stepper.step() <= self.steps => resumed,
            Some(_) => {
                let reason = "its steps or samples are not those of the run that it says it is of";
                return Err(CheckpointError::Damaged(reason.to_owned()).into());
            }
        };
        if let Err(error) = self.steps(begins, &mut recorder, stepper, watch) {
            let end = match error {
                RunError::Interrupted { .. } => {
                    let look = stepper.look(true);
                    // A run that is continued has the sample of its first step.
                    if recorder.last_sample() != Some(look.snapshot.step) {
                        recorder.sample(self.scene, &look);
                    }
                    Some(look.snapshot)
                }
                // The contacts of the last look are of an earlier step.
                RunError::Broken(_) | RunError::NotFinite { .. } => {
                    Some(Snapshot { contacts: None, ..stepper.look(true).snapshot })
                }
                _ => None,
            };
            if let Some(mut end) = end {
                self.scene.columns.keep(&mut end);
                let (series, snapshots) = recorder.finish();
                watch.broke(Remains { series, snapshots, end });
            }
            return Err(error);
        }
        if watch.wants_end_state()
            && let Some(state) = stepper.end_state()
        {
            watch.end_state(state);
        }
        let cost = Cost::of(stepper.counts(), clock.elapsed().as_secs_f64());
        let (series, snapshots) = recorder.finish();
        Ok(Driven { series, snapshots, cost })
    }

    fn steps(
        &self,
        begins: bool,
        recorder: &mut Recorder,
        stepper: &mut dyn Stepper,
        watch: &mut dyn Watch,
    ) -> Result<(), RunError> {
        if begins {
            stepper.begin()?;
        }
        let first = stepper.step();
        // No checkpoint is wanted of where the run begins.
        let between_checkpoints = watch.checkpoint_interval().unwrap_or(u64::MAX).max(1);
        loop {
            let now = stepper.step();
            if now < self.steps && watch.is_over() {
                return Err(RunError::Interrupted { time: now as f64 * self.time_step, step: now });
            }
            if (begins || now > first) && recorder.is_due(now) {
                self.take_down(now, recorder, stepper, watch)?;
            }
            watch.progress(now, self.steps);
            if now == self.steps {
                return Ok(());
            }
            if now > first
                && now.is_multiple_of(between_checkpoints)
                && let Some(checkpoint) = stepper.keep(recorder)?
            {
                watch.checkpoint(checkpoint)?;
            }
            let checkpoint = (now / between_checkpoints + 1).saturating_mul(between_checkpoints);
            let stop = recorder.next(now).min(checkpoint).min(now + self.between_progress);
            stepper.advance(stop - now)?;
        }
    }

    /// Takes down what is due at a step. A sample that is no number ends the run before its snapshot is taken for a good one.
    fn take_down(
        &self,
        step: u64,
        recorder: &mut Recorder,
        stepper: &mut dyn Stepper,
        watch: &mut dyn Watch,
    ) -> Result<(), RunError> {
        let is_snapshot = recorder.is_snapshot(step);
        let shown = is_snapshot && stepper.shows(self.scene, watch.most_rows());
        let rows = stepper.rows(self.scene);
        let sampled = recorder.is_sample(step) && !self.scene.probes.is_empty();
        let look = (shown || sampled).then(|| stepper.look(shown));
        if is_snapshot && !shown {
            let brief = look.as_ref().map_or_else(|| stepper.brief(), Brief::of_look);
            watch.in_short(brief, rows);
        }
        let Some(look) = look else {
            recorder.sample_nothing(step, step as f64 * self.time_step);
            return Ok(());
        };
        let snapshot = recorder.take(self.scene, look).filter(|_| shown);
        if let Some((column, value)) = recorder.not_finite() {
            let (column, time) = (column.to_owned(), step as f64 * self.time_step);
            return Err(RunError::NotFinite { time, step, column, value });
        }
        if let Some(snapshot) = snapshot
            && let Some(kept) = watch.snapshot(snapshot)?
        {
            recorder.keep(kept);
        }
        Ok(())
    }
}
