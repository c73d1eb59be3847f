//! What a simulation must remember between two steps, to go on to the same bits.
//!
//! Points in the order that they are in, since sums at nodes depend on it in their last bit; where tracers are and how far their
//! springs are stretched. Nodes, windows, pairs and planes are found anew in each step.

use crate::accounts::{Accounts, Sums, Tally};
use crate::contact::friction::Friction;
use crate::points::Points;
use crate::simulation::Simulation;
use grainbench_scene::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_scene::record::Cost;
use grainbench_scene::recorder::Recorder;
use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct State<S: Space> {
    points: Points<S>,
    /// Where tracers are (m), and their areas (m²).
    tracers: Vec<(S::Vector, S::Vector)>,
    friction: Friction<S>,
    /// Rotation of every body as last looked at (rad).
    angles: Vec<f64>,
    looked: u64,
    /// How many runs the points of every body made when they were last put in order.
    runs_in_order: Vec<usize>,
    step: u64,
    cost: Cost,
    /// The energy budget, where it is asked for, and what contacts told of the last step.
    accounts: Option<(Sums, Tally)>,
    recorder: Recorder,
}

impl<S: Space> Simulation<S> {
    /// The state after the last step, with the record so far.
    pub(crate) fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        let tracers = self.tracers.position.iter().copied().zip(self.tracers.area.iter().copied());
        let state = State::<S> {
            points: self.points.clone(),
            tracers: tracers.collect(),
            friction: self.springs.friction.clone(),
            angles: self.bodies.iter().map(|body| body.angle).collect(),
            looked: self.looked,
            runs_in_order: self.bodies.iter().map(|body| body.part.runs_in_order).collect(),
            step: self.step,
            cost: self.cost,
            accounts: self.accounts.as_ref().map(|accounts| (accounts.sums, accounts.tally)),
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &state)
    }

    /// Goes to a state that was kept; the record so far.
    pub(crate) fn recall(
        &mut self,
        identity: &RunIdentity,
        checkpoint: &Checkpoint,
    ) -> Result<Recorder, CheckpointError> {
        let state: State<S> = checkpoint.state(identity)?;
        self.drop_idle_surfaces();
        let same = state.points.is_like(&self.points)
            && state.tracers.len() == self.tracers.len()
            && state.friction.is_like(&self.springs.friction)
            && state.angles.len() == self.bodies.len()
            && state.runs_in_order.len() == self.bodies.len();
        if !same {
            return Err(CheckpointError::Damaged("it has another number of points, tracers or bodies".to_owned()));
        }
        self.before.clone_from(&state.points.velocity);
        self.points = state.points;
        (self.tracers.position, self.tracers.area) = state.tracers.into_iter().unzip();
        self.springs.friction = state.friction;
        self.bodies.iter_mut().zip(state.angles).for_each(|(body, angle)| body.angle = angle);
        let parts = self.bodies.iter_mut().map(|body| &mut body.part);
        parts.zip(state.runs_in_order).for_each(|(part, runs)| part.runs_in_order = runs);
        self.looked = state.looked;
        (self.step, self.cost) = (state.step, state.cost);
        self.open_accounts();
        if let (Some(Accounts { sums, tally, .. }), Some(kept)) = (&mut self.accounts, state.accounts) {
            (*sums, *tally) = kept;
        }
        self.find_all_bounds();
        Ok(state.recorder)
    }
}
