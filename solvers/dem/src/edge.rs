//! Interface between the solver and a simulation. It does not depend on the contact laws for which the simulation was
//! compiled.

use crate::geometry::Geometry;
use crate::simulation::DemSimulation;
use crate::walls::MovingWall;
use grainbench_scene::end_state::EndState;
use grainbench_solver::brief::Brief;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_solver::failure::SimulationFailure;
use grainbench_solver::record::{Counts, StepState};
use grainbench_solver::recorder::Recorder;

/// Simulation as the solver uses it, in two or three dimensions and with any contact laws.
pub trait Simulation: Send {
    /// Runs `steps` cycles.
    ///
    /// # Errors
    /// When a position or velocity is not finite, when a grain moves by more than its radius in a step, when an
    /// inserted grain overlaps too much, or when a contact is too stiff for the time step.
    fn advance(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>>;
    /// Clears the history of every contact, like a restart from a state without contact history.
    fn forget_history(&mut self);
    /// Returns a checkpoint of the state after the last step, with the record so far.
    ///
    /// # Errors
    /// When the checkpoint cannot be stored.
    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError>;
    /// Restores the state from a checkpoint of the run with this identity, and returns the record so far.
    ///
    /// # Errors
    /// When the checkpoint belongs to another run or is damaged.
    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError>;
    /// Returns the number of dimensions and the stages for which the loops over contacts were compiled, as text.
    fn layout(&self) -> &'static str;
    /// Returns the work counters so far, such as steps, pair tests and contact evaluations, without run times.
    fn counts(&self) -> Counts;
    /// Returns the number of cycles taken.
    fn step(&self) -> u64;
    /// Returns the state after the last step as the initial state of another scene, with the name of the solver.
    fn end_state(&self, solver: &str) -> EndState;
    /// Returns the state at this step: grains, contacts, walls and energies. It moves out the recorded contacts, so a
    /// second call at the same step returns none.
    fn look(&mut self) -> StepState;
    /// Returns the state for a snapshot, with averages over the time since the last snapshot.
    fn look_for_snapshot(&mut self) -> StepState;
    /// Returns the number of rows of grains and contacts that a snapshot would have now.
    fn rows(&self) -> u64;
    /// Returns true if individual contacts are recorded and a snapshot would have at most `most_rows` rows now.
    fn shows(&self, most_rows: u64) -> bool;
    /// Summarises the state at this step. The recorded contacts stay in the simulation.
    fn brief(&self) -> Brief;
}

impl<S: Geometry> Simulation for DemSimulation<S> {
    fn advance(&mut self, steps: u64) -> Result<(), Box<SimulationFailure>> {
        self.take_cycles(steps)
    }

    fn forget_history(&mut self) {
        self.neighbours.list.forget();
        self.walls.iter_mut().for_each(MovingWall::forget);
    }

    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        self.kept(identity, recorder)
    }

    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Recorder, CheckpointError> {
        self.recalled(identity, checkpoint)
    }

    fn layout(&self) -> &'static str {
        self.model.loops.words()
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

    fn look(&mut self) -> StepState {
        crate::observe::look(self)
    }

    fn rows(&self) -> u64 {
        self.recording.rows(self.grains.len())
    }

    fn shows(&self, most_rows: u64) -> bool {
        self.recording.one_by_one && self.rows() <= most_rows
    }

    fn brief(&self) -> Brief {
        crate::observe::brief(self)
    }

    fn look_for_snapshot(&mut self) -> StepState {
        let mut look = crate::observe::look(self);
        if let Some(mean) = &mut self.recording.mean_virial {
            mean.tell(&mut look.snapshot.grains);
        }
        look
    }
}
