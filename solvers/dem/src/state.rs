//! What a simulation must remember between two steps so that it goes on to the same bits.
//!
//! The order of the pairs in the neighbour list is stored too: the sums of forces depend on it in their last bit.

use crate::accounts::Accounts;
use crate::contact::chain::Memory;
use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::tangential::Tangential;
use crate::grains::Grains;
use crate::neighbours::Neighbours;
use crate::simulation::Kernel;
use crate::walls::WallMemory;
use grainbench_scene::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_scene::record::Counts;
use grainbench_scene::recorder::Recorder;
use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};

/// What is stored. The order of the fields is that of the bytes in a checkpoint.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct State<S: Space, T: Tangential<S>, R: Rolling<S>> {
    grains: Grains<S, T::Rotation>,
    neighbours: Neighbours<S, Memory<S, T, R>>,
    walls: Vec<WallMemory<S, Memory<S, T, R>>>,
    step: u64,
    extent: f64,
    cost: Counts,
    accounts: Accounts,
    recorder: Recorder,
}

impl<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>> Kernel<S, N, T, R> {
    /// A checkpoint of the state after the last step, with the record so far.
    pub(crate) fn kept(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        let state = State::<S, T, R> {
            grains: self.grains.clone(),
            neighbours: self.neighbours.clone(),
            walls: self.walls.iter().map(|wall| wall.memory()).collect(),
            step: self.step,
            extent: self.extent,
            cost: self.cost,
            accounts: self.accounts.clone(),
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &state)
    }

    /// Goes to the state of a checkpoint, and gives the record so far.
    pub(crate) fn recalled(
        &mut self,
        identity: &RunIdentity,
        checkpoint: &Checkpoint,
    ) -> Result<Recorder, CheckpointError> {
        let state: State<S, T, R> = checkpoint.state(identity)?;
        let count = self.grains.len();
        let same = state.grains.is_like(&self.grains)
            && state.neighbours.is_of(count)
            && state.walls.len() == self.walls.len()
            && state.walls.iter().all(|wall| wall.is_of(count));
        if !same {
            return Err(CheckpointError::Damaged("it has other grains, pairs or walls".to_owned()));
        }
        self.grains = state.grains;
        self.neighbours = state.neighbours;
        self.walls.iter_mut().zip(state.walls).for_each(|(wall, memory)| wall.recall(memory));
        self.step = state.step;
        self.extent = state.extent;
        self.cost = state.cost;
        self.accounts = state.accounts;
        Ok(state.recorder)
    }
}
