//! Simulation as the main loop runs it, in two or three dimensions and with any contact laws, and its state between two
//! steps. A run that continues from this state gives the same results bit for bit.
//!
//! The order of the pairs in the neighbour list is part of the state, because it affects the last bit of the force sums.

use crate::accounts::Accounts;
use crate::geometry::Geometry;
use crate::grains::Grains;
use crate::mean_virial::MeanVirial;
use crate::neighbours::Neighbours;
use crate::observe::{grain_states, observed};
use crate::simulation::DemSimulation;
use crate::walls::{MovingWall, WallMemory};
use grainbench_scene::end_state::EndState;
use grainbench_scene::scene::Scene;
use grainbench_solver::Defect;
use grainbench_solver::brief::Brief;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_solver::drive::Stepper;
use grainbench_solver::failure::RunError;
use grainbench_solver::finite::is_finite;
use grainbench_solver::record::{Counts, StepState};
use grainbench_solver::recorder::Recorder;
use serde::{Deserialize, Serialize};

/// Content of a checkpoint. The order of the fields is the order of the bytes in the checkpoint.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct State<S: Geometry> {
    grains: Grains<S>,
    neighbours: Neighbours,
    walls: Vec<WallMemory>,
    step: u64,
    extent: f64,
    cost: Counts,
    accounts: Accounts,
    entered: usize,
    mean_virial: Option<Box<MeanVirial>>,
    recorder: Recorder,
}

impl<S: Geometry> Stepper for DemSimulation<S> {
    fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        match self.defect {
            None => self.take_cycles(steps)?,
            Some(Defect::ForgetsHistory) => {
                for _ in 0..steps {
                    self.take_cycles(1)?;
                    self.neighbours.list.forget();
                    self.walls.iter_mut().for_each(MovingWall::forget);
                }
            }
        }
        Ok(())
    }

    fn step(&self) -> u64 {
        self.step
    }

    fn counts(&self) -> Counts {
        self.cost
    }

    fn look(&mut self, snapshot: bool) -> StepState {
        let mut look = observed(self);
        if let Some(mean) = self.recording.mean_virial.as_mut().filter(|_| snapshot) {
            mean.tell(&mut look.snapshot.grains);
        }
        look
    }

    fn rows(&self, _: &Scene) -> u64 {
        self.recording.rows(self.grains.len())
    }

    /// Returns true if individual contacts are recorded and a snapshot would have at most `most_rows` rows now.
    fn shows(&self, scene: &Scene, most_rows: u64) -> bool {
        self.recording.one_by_one && self.rows(scene) <= most_rows
    }

    /// Summarises the state at this step. The recorded contacts stay in the simulation.
    fn brief(&mut self) -> Brief {
        let touching = self.recording.touching(self.step, &self.neighbours.list.shares);
        Brief::of_grains((self.step, self.time()), grain_states(self), touching)
    }

    fn end_state(&self, solver: &str) -> Option<EndState> {
        Some(self.final_state(solver))
    }

    /// Returns the type name of the loops over contacts, which contains the number of dimensions and the stages.
    fn layout(&self) -> &'static str {
        self.model.loops.words()
    }

    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Option<Checkpoint>, CheckpointError> {
        let state = State::<S> {
            grains: self.grains.clone(),
            neighbours: self.neighbours.list.in_shares(1),
            walls: self.walls.iter().map(|wall| wall.kept.clone()).collect(),
            step: self.step,
            extent: self.neighbours.extent,
            cost: self.cost,
            accounts: self.budget.accounts.clone(),
            entered: self.entered,
            mean_virial: self.recording.mean_virial.clone(),
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &state).map(Some)
    }

    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Option<Recorder>, CheckpointError> {
        let state: State<S> = checkpoint.state(identity)?;
        let count = state.grains.len();
        let same_mean = match (&state.mean_virial, &self.recording.mean_virial) {
            (Some(state), Some(own)) => state.is_of(own),
            (state, own) => state.is_none() && own.is_none(),
        };
        let same = same_mean
            && state.grains.is_of(&self.scene, self.model.loops.turn())
            && state.entered <= self.scene.stays.entries.len()
            && state.neighbours.is_of(count, self.model.loops.layout())
            && state.walls.len() == self.walls.len()
            && state.walls.iter().zip(&self.walls).all(|(memory, wall)| memory.is_of(count, wall));
        if !same {
            return Err(CheckpointError::Damaged("it has other grains, pairs or walls than the scene".to_owned()));
        }
        let finite = is_finite(&(&state.grains, &state.neighbours, &state.walls, &state.mean_virial));
        if !(finite && state.extent.is_finite() && state.recorder.is_finite()) {
            return Err(CheckpointError::Damaged("it has a number that is not finite".to_owned()));
        }
        self.grains = state.grains;
        self.neighbours.list = state.neighbours.in_shares(self.threads.partitions(count));
        self.walls.iter_mut().zip(state.walls).for_each(|(wall, memory)| wall.recall(memory));
        self.step = state.step;
        // The displacement bound is not stored. Infinity makes the next cycle compute it.
        self.neighbours.travelled = f64::INFINITY;
        self.neighbours.extent = state.extent;
        self.cost = state.cost;
        self.budget.accounts = state.accounts;
        self.entered = state.entered;
        self.recording.mean_virial = state.mean_virial;
        Ok(Some(state.recorder))
    }
}
