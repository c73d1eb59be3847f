//! Progress of a plan.

use crate::fault::Fault;
use crate::lease::{self, LeaseContents};
use crate::plan::Plan;
use grainbench_store::log::{Entry, State};
use grainbench_store::results::FinishedTasks;
use serde::Serialize;

/// Progress of a plan.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Status {
    /// Number of all tasks.
    pub tasks: usize,
    /// Number of successful tasks.
    pub done: usize,
    /// Number of tasks that ended in an error, which is their result.
    pub failed: usize,
    /// Number of tasks in which our program panicked.
    pub crashed: usize,
    /// Number of unfinished tasks with a lease.
    pub running: usize,
    /// Number of unfinished tasks without a lease.
    pub waiting: usize,
    /// Estimated remaining time (s): the expected time of the unfinished tasks, divided by the number of active
    /// workers, or by 1 if there is none.
    ///
    /// The quotient is multiplied by the ratio of actual to expected time of the finished tasks, or by 1 if none is
    /// finished.
    pub seconds_left: f64,
    /// Active workers.
    pub workers: Vec<LeaseContents>,
    /// Number of truncated or damaged result lines. Their tasks are repeated.
    pub damaged: usize,
    /// Number of further results for tasks of the plan that already had a successful result.
    pub twice: usize,
}

impl Status {
    /// Reads the progress of a plan.
    ///
    /// # Errors
    /// When a file of the plan cannot be read.
    pub fn from_plan(plan: &Plan) -> Result<Self, Fault> {
        let mut workers = lease::held(&plan.path, plan.head.lease_seconds)?;
        let finished = FinishedTasks::read(&plan.path, false).map_err(Fault::Input)?;
        // A lease is renewed every few seconds. The result file of its worker is newer.
        for worker in &mut workers {
            let is_own = |entry: &&Entry| finished.workers[entry.worker].name == worker.worker;
            worker.done = worker.done.max(finished.entries.values().filter(is_own).count());
        }
        let mut status = Self { tasks: plan.tasks.len(), damaged: finished.damaged, ..Self::default() };
        let (mut left, mut took, mut expected) = (0.0, 0.0, 0.0);
        for (place, task) in plan.tasks.iter().enumerate() {
            let Some(entry) = finished.entries.get(&task.id) else {
                left += task.seconds;
                let is_running = workers.iter().any(|worker| worker.has(place));
                *(if is_running { &mut status.running } else { &mut status.waiting }) += 1;
                continue;
            };
            status.twice += entry.repeats;
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
        status.workers = workers;
        Ok(status)
    }
}
