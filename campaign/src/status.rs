//! How far a plan is.

use crate::fault::Fault;
use crate::finished::Finished;
use crate::lease::{self, Said};
use crate::log::State;
use crate::plan::Plan;
use crate::task::Id;
use serde::Serialize;
use std::collections::HashSet;

/// How far a plan is.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Status {
    /// All tasks.
    pub tasks: usize,
    /// That ended as they should.
    pub done: usize,
    /// That ended in an error, which is their result.
    pub failed: usize,
    /// At which our program failed; they may be done again.
    pub crashed: usize,
    /// That somebody is at.
    pub running: usize,
    /// That nobody has taken up.
    pub waiting: usize,
    /// Time that is left (s): what is not finished, as long as what is finished took of what it was expected to take, shared
    /// by those who work; by one where nobody does.
    pub seconds_left: f64,
    /// Who works.
    pub workers: Vec<Said>,
    /// Lines of results that are cut off or damaged; what they were of is done again.
    pub damaged: usize,
    /// Tasks that were done more than once.
    pub twice: usize,
}

impl Status {
    /// Looks at a plan.
    ///
    /// # Errors
    /// When something in it cannot be read.
    pub fn of(plan: &Plan) -> Result<Self, Fault> {
        let workers = lease::held(&plan.path, plan.head.lease_seconds)?;
        let finished = Finished::read(&plan.path, false)?;
        let mut status = Self { tasks: plan.tasks.len(), damaged: finished.damaged, ..Self::default() };
        let (mut left, mut took, mut expected) = (0.0, 0.0, 0.0);
        for (place, task) in plan.tasks.iter().enumerate() {
            let Some(entry) = finished.entries.get(&task.id) else {
                left += task.seconds;
                let is_running = workers.iter().any(|worker| worker.has(place));
                *(if is_running { &mut status.running } else { &mut status.waiting }) += 1;
                continue;
            };
            took += entry.seconds;
            expected += task.seconds;
            *match entry.state {
                State::Done => &mut status.done,
                State::Failed => &mut status.failed,
                State::Crashed => &mut status.crashed,
            } += 1;
        }
        let pace = if expected > 0.0 && took > 0.0 { took / expected } else { 1.0 };
        status.seconds_left = left * pace / workers.len().max(1) as f64;
        let ids: HashSet<Id> = plan.tasks.iter().map(|task| task.id).collect();
        status.twice = if finished.entries.keys().any(|id| ids.contains(id)) { finished.twice } else { 0 };
        status.workers = workers;
        Ok(status)
    }

    /// Whether every task has a result.
    #[must_use]
    pub const fn is_whole(&self) -> bool {
        self.done + self.failed + self.crashed == self.tasks
    }
}
