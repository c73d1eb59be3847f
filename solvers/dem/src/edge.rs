//! A simulation as the solver holds it, whatever it was compiled for.

use crate::geometry::Geometry;
use crate::simulation::Simulated;
use grainbench_scene::brief::Brief;
use grainbench_scene::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_scene::end_state::EndState;
use grainbench_scene::record::{Counts, Look};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::solver::Broken;

/// A simulation as the solver holds it, whatever it was compiled for.
pub trait Simulation: Send {
    /// Takes `steps` cycles.
    ///
    /// # Errors
    /// When the state of a grain is no longer finite, or a grain moves by more than its radius in a step.
    fn advance(&mut self, steps: u64) -> Result<(), Box<Broken>>;
    /// Forgets the history of every contact, as a restart that does not store it would.
    fn forget_history(&mut self);
    /// A checkpoint of the state after the last step, with the record so far.
    ///
    /// # Errors
    /// When it cannot be stored.
    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError>;
    /// Goes to the state that a run of the same identity left, and gives the record so far.
    ///
    /// # Errors
    /// When the checkpoint is of another run or damaged.
    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError>;
    /// The loops over contacts in words: the space and the stages that they were compiled for.
    fn layout(&self) -> &'static str;
    /// Steps, pairs and contacts counted so far; no times.
    fn counts(&self) -> Counts;
    /// Cycles taken.
    fn step(&self) -> u64;
    /// The state after the last step, for another scene to begin with, of what the named solver made.
    fn end_state(&self, solver: &str) -> EndState;
    /// The state at this step: grains, contacts, walls and energies. The contacts are taken away: whoever looks again at the
    /// same step is told none.
    fn look(&mut self) -> Look;
    /// The same for a snapshot, with means over the time since the last one.
    fn look_for_snapshot(&mut self) -> Look;
    /// Rows of grains and contacts that a snapshot has now.
    fn rows(&self) -> u64;
    /// Whether a snapshot can be shown now that has at most so many rows.
    fn shows(&self, most_rows: u64) -> bool;
    /// The state at this step in short. No contacts are taken away.
    fn brief(&self) -> Brief;
}

impl<S: Geometry> Simulation for Simulated<S> {
    fn advance(&mut self, steps: u64) -> Result<(), Box<Broken>> {
        self.take_cycles(steps)
    }

    fn forget_history(&mut self) {
        self.forget();
    }

    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        self.kept(identity, recorder)
    }

    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError> {
        self.recalled(identity, checkpoint)
    }

    fn layout(&self) -> &'static str {
        self.forces.words()
    }

    fn counts(&self) -> Counts {
        self.cost
    }

    fn step(&self) -> u64 {
        self.step
    }

    fn end_state(&self, solver: &str) -> EndState {
        Self::end_state(self, solver)
    }

    fn look(&mut self) -> Look {
        crate::observe::look(self)
    }

    fn rows(&self) -> u64 {
        Self::rows(self)
    }

    fn shows(&self, most_rows: u64) -> bool {
        Self::shows(self, most_rows)
    }

    fn brief(&self) -> Brief {
        crate::observe::brief(self)
    }

    fn look_for_snapshot(&mut self) -> Look {
        let mut look = crate::observe::look(self);
        if let Some(mean) = &mut self.mean_virial {
            mean.tell(&mut look.snapshot.grains);
        }
        look
    }
}
