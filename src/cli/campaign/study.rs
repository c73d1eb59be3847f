//! What a plan is of: who says which tasks there are, does them, and makes the report of what came out.

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

/// What a plan is of.
pub(crate) trait Study: Sync {
    /// Which of the four.
    fn kind(&self) -> Kind;
    /// Whether times are measured.
    fn is_timed(&self) -> bool;
    /// Every task, by the program of this hash.
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault>;
    /// Files that tasks hang on, with their hashes.
    fn inputs(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }
    /// Does some tasks, so many at once.
    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<Desk>) -> Result<(), Fault>;
    /// Makes the report of what is finished.
    fn collect(&self, plan: &Plan, finished: &Finished, how: &How<'_>) -> Outcome;
}

/// The study that is asked for.
pub(crate) fn of(arguments: &Arguments) -> Result<Box<dyn Study>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(OfRun::new(arguments)?),
        "cost" => Box::new(OfCost::new(arguments)?),
        "stability" => Box::new(OfStability::new(arguments)?),
        file => Box::new(OfSweep::new(file, arguments)?),
    })
}

/// What came out of a task: its result, or that our program failed at it.
pub(crate) enum Came<T> {
    /// Nothing yet.
    Nothing,
    /// This.
    Out(T),
    /// A crash of ours, in words.
    Crash(String),
}

/// What came out of a task.
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
