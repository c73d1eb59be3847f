//! State of a simulation between two steps. A run that continues from this state gives the same results bit for bit.
//!
//! The order of the pairs in the neighbour list is part of the state, because it affects the last bit of the force sums.

use crate::accounts::Accounts;
use crate::geometry::Geometry;
use crate::grains::Grains;
use crate::mean_virial::MeanVirial;
use crate::neighbours::Neighbours;
use crate::simulation::DemSimulation;
use crate::walls::WallMemory;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_solver::finite::is_finite;
use grainbench_solver::record::Counts;
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

impl<S: Geometry> DemSimulation<S> {
    /// Returns a checkpoint of the state after the last step, with the record so far.
    pub(crate) fn kept(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        let state = State::<S> {
            grains: self.grains.clone(),
            neighbours: self.neighbours.list.in_shares(1),
            walls: self.walls.iter().map(|wall| wall.memory()).collect(),
            step: self.step,
            extent: self.neighbours.extent,
            cost: self.cost,
            accounts: self.budget.accounts.clone(),
            entered: self.entered,
            mean_virial: self.recording.mean_virial.clone(),
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &state)
    }

    /// Restores the state of a checkpoint, and returns the record so far.
    pub(crate) fn recalled(
        &mut self,
        identity: &RunIdentity,
        checkpoint: &Checkpoint,
    ) -> Result<Recorder, CheckpointError> {
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
        Ok(state.recorder)
    }
}
