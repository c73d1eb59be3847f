//! Main loop of a run, shared by all solvers. It advances the simulation, records output, and passes progress,
//! snapshots and checkpoints to the observer. It also measures the wall-clock time, relaxation included.

use crate::brief::Brief;
use crate::checkpoint::{Checkpoint, CheckpointError, RunIdentity, fingerprint};
use crate::failure::RunError;
use crate::observer::{Observer, RunOutline};
use crate::record::{Cost, Counts, PartialOutput, Provenance, Record, Snapshot, StepState};
use crate::recorder::Recorder;
use crate::reduction::reduce;
use grainbench_scene::end_state::EndState;
use grainbench_scene::scene::Scene;
use std::time::Instant;

/// State that can be advanced in time.
pub trait Stepper {
    /// Runs the phase before t = 0, such as a relaxation. The cost of the run includes the steps of this phase.
    ///
    /// # Errors
    /// When the simulation breaks.
    fn begin(&mut self) -> Result<(), RunError> {
        Ok(())
    }

    /// Returns the number of particles that each step advances. By default, this is the number of grains.
    fn particles(&self, scene: &Scene) -> u64 {
        scene.grains.len() as u64
    }

    /// Returns the number of steps taken.
    fn step(&self) -> u64;

    /// Takes a number of steps.
    ///
    /// # Errors
    /// When the simulation breaks.
    fn advance(&mut self, steps: u64) -> Result<(), RunError>;

    /// Returns the state after the last step, with all snapshot data if `snapshot` is true. A second call at the same
    /// step may return no contacts.
    fn look(&mut self, snapshot: bool) -> StepState;

    /// Returns the number of rows (grains, contacts and material points) that a snapshot would now have. By default,
    /// this is the number of particles.
    fn rows(&self, scene: &Scene) -> u64 {
        self.particles(scene)
    }

    /// Returns true if a snapshot would now have at most `most_rows` rows.
    fn shows(&self, scene: &Scene, most_rows: u64) -> bool {
        self.rows(scene) <= most_rows
    }

    /// Returns a summary of the state after the last step. The observer receives this summary instead of a snapshot
    /// with too many rows.
    fn brief(&mut self) -> Brief {
        Brief::of_look(&self.look(false))
    }

    /// Returns the work counters since the start, such as steps, contact evaluations and neighbour builds.
    fn counts(&self) -> Counts;

    /// Returns the state after the last step, as the initial state of another scene; `None` if the solver does not
    /// provide it. `solver` is the text of [`Course::solver`].
    fn end_state(&self, _solver: &str) -> Option<EndState> {
        None
    }

    /// Returns text that identifies the layout of the state in checkpoints.
    fn layout(&self) -> &'static str {
        ""
    }

    /// Returns a checkpoint of the state with the record so far; `None` if the solver writes no checkpoints.
    ///
    /// # Errors
    /// When the state cannot be serialised.
    fn keep(&self, _identity: &RunIdentity, _recorder: &Recorder) -> Result<Option<Checkpoint>, CheckpointError> {
        Ok(None)
    }

    /// Restores the state from a checkpoint of the run with this identity, and returns the record so far; `None` if the
    /// solver writes no checkpoints.
    ///
    /// # Errors
    /// When the checkpoint belongs to another run or is damaged.
    fn recall(
        &mut self,
        _identity: &RunIdentity,
        _checkpoint: &Checkpoint,
    ) -> Result<Option<Recorder>, CheckpointError> {
        Ok(None)
    }
}

/// Inputs of the main loop.
pub struct Course<'a> {
    /// Solver and options, as text for checkpoints and final states.
    pub solver: String,
    /// Scene of the run.
    pub scene: &'a Scene,
    /// Number of steps of the whole run.
    pub steps: u64,
    /// Checkpoint from which the run continues; `None` for a new run.
    pub from: Option<&'a Checkpoint>,
    /// Largest number of steps between two progress reports.
    pub between_progress: u64,
    /// Origin of the record, with the time step.
    pub provenance: Provenance,
}

impl Course<'_> {
    /// Advances a state to the end of the run. The record contains the snapshots that the observer returned.
    ///
    /// # Errors
    /// When the checkpoint belongs to another run or is damaged, the simulation breaks or is interrupted, or a snapshot
    /// or a checkpoint cannot be stored. The observer receives the partial output of a run that broke or was
    /// interrupted.
    pub fn drive(self, stepper: &mut dyn Stepper, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let time_step = self.provenance.time_step;
        let recall = |checkpoint| stepper.recall(&self.identity(stepper), checkpoint);
        let resumed = self.from.map(recall).transpose()?.flatten();
        let particles = stepper.particles(self.scene);
        observer.begin(RunOutline { time_step, steps: self.steps, particles });
        let clock = Instant::now();
        let begins = resumed.is_none();
        let begun = Recorder::new(self.scene, time_step, self.steps);
        let mut recorder = match resumed {
            None => begun,
            Some(resumed) if resumed.is_of(&begun) && stepper.step() <= self.steps => resumed,
            Some(_) => {
                let reason = "its steps or samples differ from those of the run that it names";
                return Err(CheckpointError::Damaged(reason.to_owned()).into());
            }
        };
        if let Err(error) = self.steps(begins, &mut recorder, stepper, observer) {
            let end = match error {
                RunError::Interrupted { .. } => {
                    let look = stepper.look(true);
                    // A continued run already has the sample of its first step.
                    if recorder.last_sample() != Some(look.snapshot.step) {
                        recorder.sample(self.scene, &look);
                    }
                    Some(look.snapshot)
                }
                // The stored contacts belong to an earlier step.
                RunError::Broken(_) | RunError::NotFinite { .. } => {
                    Some(Snapshot { contacts: None, ..stepper.look(true).snapshot })
                }
                _ => None,
            };
            if let Some(mut end) = end {
                reduce(&mut end, &self.scene.columns);
                let (series, snapshots) = recorder.finish();
                observer.broke(PartialOutput { series, snapshots, end });
            }
            return Err(error);
        }
        if observer.options().end_state
            && let Some(state) = stepper.end_state(&self.solver)
        {
            observer.end_state(state);
        }
        let cost = Cost::new(stepper.counts(), clock.elapsed().as_secs_f64());
        let (series, snapshots) = recorder.finish();
        Ok(Record { provenance: self.provenance, series, snapshots, cost })
    }

    /// Returns the identity that checkpoints of this run store.
    fn identity(&self, stepper: &dyn Stepper) -> RunIdentity {
        RunIdentity {
            solver: self.solver.clone(),
            scene: self.scene.title.clone(),
            fingerprint: fingerprint(self.scene).to_hex().to_string(),
            time_step: self.provenance.time_step,
            steps: self.steps,
            layout: stepper.layout().to_owned(),
        }
    }

    fn steps(
        &self,
        begins: bool,
        recorder: &mut Recorder,
        stepper: &mut dyn Stepper,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        if begins {
            stepper.begin()?;
        }
        let (first, time_step) = (stepper.step(), self.provenance.time_step);
        // No checkpoint is stored at the first step.
        let between_checkpoints = observer.options().checkpoint_interval.unwrap_or(u64::MAX).max(1);
        loop {
            let now = stepper.step();
            if now < self.steps && observer.is_over() {
                return Err(RunError::Interrupted { time: now as f64 * time_step, step: now });
            }
            if (begins || now > first) && recorder.is_due(now) {
                self.take_down(now, recorder, stepper, observer)?;
            }
            observer.progress(now, self.steps);
            if now == self.steps {
                return Ok(());
            }
            if now > first
                && now.is_multiple_of(between_checkpoints)
                && let Some(checkpoint) = stepper.keep(&self.identity(stepper), recorder)?
            {
                observer.checkpoint(checkpoint)?;
            }
            let checkpoint = (now / between_checkpoints + 1).saturating_mul(between_checkpoints);
            let stop = recorder.next(now).min(checkpoint).min(now + self.between_progress);
            stepper.advance(stop - now)?;
        }
    }

    /// Records the output that is due at a step. A sample that is not finite ends the run before its snapshot is
    /// stored.
    fn take_down(
        &self,
        step: u64,
        recorder: &mut Recorder,
        stepper: &mut dyn Stepper,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let time = step as f64 * self.provenance.time_step;
        let is_snapshot = recorder.is_snapshot(step);
        let shown = is_snapshot && stepper.shows(self.scene, observer.options().most_rows);
        let rows = stepper.rows(self.scene);
        let sampled = recorder.is_sample(step) && !self.scene.probes.is_empty();
        let look = (shown || sampled).then(|| stepper.look(shown));
        if is_snapshot && !shown {
            let brief = look.as_ref().map_or_else(|| stepper.brief(), Brief::of_look);
            observer.in_short(brief, rows);
        }
        let Some(look) = look else {
            recorder.sample_nothing(step, time);
            return Ok(());
        };
        let snapshot = recorder.take(self.scene, look).filter(|_| shown);
        if let Some((column, value)) = recorder.not_finite() {
            return Err(RunError::NotFinite { time, step, column: column.to_owned(), value });
        }
        if let Some(snapshot) = snapshot
            && let Some(kept) = observer.snapshot(snapshot)?
        {
            recorder.keep(kept);
        }
        Ok(())
    }
}
