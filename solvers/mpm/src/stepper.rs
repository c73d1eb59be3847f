//! Simulation as the main loop runs it, and its state between two steps. A restart from this state gives the same bits as
//! an uninterrupted run.
//!
//! The order of points is stored, because the last bit of sums at nodes depends on it. Tracer positions and tangential
//! spring displacements are stored too. Nodes, windows, pairs and planes are recomputed in each step.

use crate::contact::friction::Coulomb;
use crate::energy::accounts::{Accounts, Sums};
use crate::energy::ledger::{EnergyGuard, Tally};
use crate::points::arrays::Points;
use crate::simulation::Simulation;
use grainbench_scene::scene::Scene;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError, RunIdentity};
use grainbench_solver::drive::Stepper;
use grainbench_solver::failure::RunError;
use grainbench_solver::finite::is_finite;
use grainbench_solver::record::{Counts, StepState};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::space::Space;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
struct CheckpointData<S: Space> {
    points: Points<S>,
    /// Positions of tracers (m), and their areas (m²).
    tracers: Vec<(S::Vector, S::Vector)>,
    friction: Option<Coulomb<S>>,
    /// Rotation of every body at the last observation (rad).
    angles: Vec<f64>,
    looked: u64,
    /// Number of particle batches of every body when its points were last sorted.
    runs_in_order: Vec<usize>,
    step: u64,
    cost: Counts,
    /// Sums of the energy budget and energies of contacts in the last step, if the run requests a budget.
    accounts: Option<(Sums, Tally)>,
    /// Monitored energy of a closed run.
    watched: Option<EnergyGuard>,
    recorder: Recorder,
}

impl<S: Space> Stepper for Simulation<S> {
    /// Relaxes the bodies and sets their initial velocities.
    fn begin(&mut self) -> Result<(), RunError> {
        let team = self.state.team.clone();
        team.lead(|| self.settle())?;
        let Self { critical, scheme, .. } = *self;
        let moving = team.lead(|| self.set_moving());
        moving.map_err(|failure| failure.into_simulation_failure(0, scheme.time_step, critical))?;
        self.open_accounts();
        self.watch_energy();
        Ok(())
    }

    fn particles(&self, _: &Scene) -> u64 {
        self.state.points.len() as u64
    }

    fn rows(&self, scene: &Scene) -> u64 {
        self.particles(scene) + scene.grains.len() as u64
    }

    fn step(&self) -> u64 {
        self.step
    }

    /// Takes `steps` steps. Contact points are recorded in the last step.
    fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        let team = self.state.team.clone();
        Ok(team.lead(|| (0..steps).rev().try_for_each(|left| self.cycle(left == 0)))?)
    }

    /// Returns the state at this step. A snapshot includes every material point.
    fn look(&mut self, snapshot: bool) -> StepState {
        self.observed(snapshot)
    }

    fn counts(&self) -> Counts {
        self.cost
    }

    fn layout(&self) -> &'static str {
        std::any::type_name::<Self>()
    }

    fn keep(&self, identity: &RunIdentity, recorder: &Recorder) -> Result<Option<Checkpoint>, CheckpointError> {
        let (state, tracers) = (&self.state, &self.contacts.tracers);
        let kept = CheckpointData::<S> {
            points: state.points.clone(),
            tracers: tracers.position.iter().copied().zip(tracers.area.iter().copied()).collect(),
            friction: self.contacts.springs.clone(),
            angles: state.bodies.iter().map(|body| body.angle).collect(),
            looked: self.looked,
            runs_in_order: state.bodies.iter().map(|body| body.runs_in_order).collect(),
            step: self.step,
            cost: self.cost,
            accounts: self.accounts.as_ref().map(|accounts| (accounts.sums, accounts.tally)),
            watched: self.watched,
            recorder: recorder.clone(),
        };
        Checkpoint::keep(identity, self.step, &kept).map(Some)
    }

    fn recall(&mut self, identity: &RunIdentity, checkpoint: &Checkpoint) -> Result<Option<Recorder>, CheckpointError> {
        let kept: CheckpointData<S> = checkpoint.state(identity)?;
        self.cover();
        let Self { state, contacts, .. } = self;
        let same = kept.points.is_like(&state.points)
            && kept.tracers.len() == contacts.tracers.len()
            && kept.friction.as_ref().map(Coulomb::tracers) == contacts.springs.as_ref().map(Coulomb::tracers)
            && kept.angles.len() == state.bodies.len()
            && kept.runs_in_order.len() == state.bodies.len();
        if !same {
            return Err(CheckpointError::Damaged("it has a different number of points, tracers or bodies".to_owned()));
        }
        let Points { mass, reference_volume, volume, .. } = &kept.points;
        let is_positive = [mass, reference_volume, volume].into_iter().flatten().all(|value| *value > 0.0);
        let is_finite = is_finite(&(&kept.points, &kept.tracers, &kept.friction, &kept.angles));
        if !(is_positive && is_finite && kept.recorder.is_finite()) {
            let reason = "it has a number that is not finite, or a mass or volume that is zero or negative";
            return Err(CheckpointError::Damaged(reason.to_owned()));
        }
        state.before.clone_from(&kept.points.velocity);
        state.points = kept.points;
        state.shares.iter_mut().for_each(|share| share.runs.clear());
        (contacts.tracers.position, contacts.tracers.area) = kept.tracers.into_iter().unzip();
        contacts.springs = kept.friction;
        for ((body, angle), runs) in state.bodies.iter_mut().zip(kept.angles).zip(kept.runs_in_order) {
            (body.angle, body.runs_in_order) = (angle, runs);
        }
        state.find_all_bounds(&mut contacts.tracers);
        self.looked = kept.looked;
        (self.step, self.cost) = (kept.step, kept.cost);
        (self.is_fresh, self.watched) = (false, kept.watched);
        self.open_accounts();
        if let (Some(Accounts { sums, tally, .. }), Some(kept)) = (&mut self.accounts, kept.accounts) {
            (*sums, *tally) = kept;
        }
        Ok(Some(kept.recorder))
    }
}
