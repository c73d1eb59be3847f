//! What a simulation must remember between two steps, to go on to the same bits.
//!
//! Points in the order that they are in, since sums at nodes depend on it in their last bit; where tracers are and how
//! far their springs are stretched. Nodes, windows, pairs and planes are found anew in each step.

use crate::accounts::{Accounts, Sums};
use crate::contact::friction::Friction;
use crate::guard::Watched;
use crate::ledger::Tally;
use crate::points::Points;
use crate::simulation::Simulation;
use grainbench_scene::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_scene::record::Counts;
use grainbench_scene::recorder::Recorder;
use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct Kept<S: Space> {
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
    cost: Counts,
    /// The energy budget, where it is asked for, and what contacts told of the last step.
    accounts: Option<(Sums, Tally)>,
    /// The energy of a closed run, where it is watched.
    watched: Option<Watched>,
    recorder: Recorder,
}

impl<S: Space> Simulation<S> {
    /// The state after the last step, with the record so far.
    pub(crate) fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Checkpoint, CheckpointError> {
        let (state, tracers) = (&self.state, &self.contacts.tracers);
        let kept = Kept::<S> {
            points: state.points.clone(),
            tracers: tracers.position.iter().copied().zip(tracers.area.iter().copied()).collect(),
            friction: self.contacts.springs.friction.clone(),
            angles: state.bodies.iter().map(|body| body.angle).collect(),
            looked: self.looked,
            runs_in_order: state.bodies.iter().map(|body| body.part.runs_in_order).collect(),
            step: self.step,
            cost: self.cost,
            accounts: self.accounts.as_ref().map(|accounts| (accounts.sums, accounts.tally)),
            watched: self.watched,
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &kept)
    }

    /// Goes to a state that was kept; the record so far.
    pub(crate) fn recall(
        &mut self,
        identity: &RunIdentity,
        checkpoint: &Checkpoint,
    ) -> Result<Recorder, CheckpointError> {
        let kept: Kept<S> = checkpoint.state(identity)?;
        self.cover();
        let Self { state, contacts, .. } = self;
        let same = kept.points.is_like(&state.points)
            && kept.tracers.len() == contacts.tracers.len()
            && kept.friction.is_like(&contacts.springs.friction)
            && kept.angles.len() == state.bodies.len()
            && kept.runs_in_order.len() == state.bodies.len();
        if !same {
            return Err(CheckpointError::Damaged("it has another number of points, tracers or bodies".to_owned()));
        }
        state.before.clone_from(&kept.points.velocity);
        state.points = kept.points;
        state.shares.iter_mut().for_each(|share| share.runs.clear());
        (contacts.tracers.position, contacts.tracers.area) = kept.tracers.into_iter().unzip();
        contacts.springs.friction = kept.friction;
        for ((body, angle), runs) in state.bodies.iter_mut().zip(kept.angles).zip(kept.runs_in_order) {
            (body.angle, body.part.runs_in_order) = (angle, runs);
        }
        state.find_all_bounds(&mut contacts.tracers);
        self.looked = kept.looked;
        (self.step, self.cost) = (kept.step, kept.cost);
        (self.is_fresh, self.watched) = (false, kept.watched);
        self.open_accounts();
        if let (Some(Accounts { sums, tally, .. }), Some(kept)) = (&mut self.accounts, kept.accounts) {
            (*sums, *tally) = kept;
        }
        Ok(kept.recorder)
    }
}
