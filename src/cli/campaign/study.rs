//! Kinds of plans: each lists its tasks, runs them, and makes the report.

use super::collect::ReportOptions;
use super::of_cost::CostStudy;
use super::of_run::ClaimStudy;
use super::of_stability::StabilityStudy;
use super::of_sweep::SweepStudy;
use super::plan::Arguments;
use crate::cli::exit::{Fault, Outcome};
use grainbench::campaign::finished::FinishedTasks;
use grainbench::campaign::plan::{Kind, Plan};
use grainbench::campaign::task::Task;
use grainbench::campaign::work::ResultSink;
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
    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault>;
    /// Writes the report of the finished tasks.
    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome;
}

/// Returns the study that the arguments ask for.
pub(crate) fn from_arguments(arguments: &Arguments) -> Result<Box<dyn Study>, Fault> {
    Ok(match arguments.what.as_str() {
        "run" => Box::new(ClaimStudy::new(arguments)?),
        "cost" => Box::new(CostStudy::new(arguments)?),
        "stability" => Box::new(StabilityStudy::new(arguments)?),
        file => Box::new(SweepStudy::new(file, arguments)?),
    })
}
