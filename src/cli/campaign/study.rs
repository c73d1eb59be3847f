//! Kinds of plans: each lists its tasks, runs them, and makes the report.

use super::collect::How;
use super::of_cost::OfCost;
use super::of_run::OfRun;
use super::of_stability::OfStability;
use super::of_sweep::OfSweep;
use super::plan::Arguments;
use crate::cli::exit::{Fault, Outcome};
use grainbench::campaign::finished::Finished;
use grainbench::campaign::log::State;
use grainbench::campaign::plan::{Kind, Plan};
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::Desk;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Kind of plan.
pub(crate) trait Study: Sync {
    /// Returns the kind.
    fn kind(&self) -> Kind;
    /// Returns true if times are measured.
    fn is_timed(&self) -> bool;
    /// Returns all tasks for the program with this hash.
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault>;
    /// Returns the hashes of the files that the tasks depend on.
    fn inputs(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }
    /// Runs tasks, at most `jobs` at a time.
    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<Desk>) -> Result<(), Fault>;
    /// Writes the report of the finished tasks.
    fn collect(&self, plan: &Plan, finished: &Finished, how: &How<'_>) -> Outcome;
}

/// Returns the study that the arguments ask for.
pub(crate) fn from_arguments(arguments: &Arguments) -> Result<Box<dyn Study>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(OfRun::new(arguments)?),
        "cost" => Box::new(OfCost::new(arguments)?),
        "stability" => Box::new(OfStability::new(arguments)?),
        file => Box::new(OfSweep::new(file, arguments)?),
    })
}

/// Result of a task.
pub(crate) enum Came<T> {
    /// No result yet.
    Nothing,
    /// Result.
    Out(T),
    /// Message of a crash of our program.
    Crash(String),
}

/// Reads the result of a task.
pub(crate) fn came<T: DeserializeOwned>(finished: &Finished, id: Id) -> Came<T> {
    let Some(entry) = finished.entries.get(&id) else { return Came::Nothing };
    if entry.state == State::Crashed {
        return Came::Crash(serde_json::from_str(&entry.json).unwrap_or_else(|_| "our program failed".to_owned()));
    }
    match serde_json::from_str(&entry.json) {
        Ok(result) => Came::Out(result),
        Err(error) => Came::Crash(format!("what was left of it cannot be read: {error}")),
    }
}
