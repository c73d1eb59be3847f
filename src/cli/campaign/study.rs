//! Interface of all kinds of plans: each kind lists its tasks, runs them and makes the report.

use crate::cli::exit::{Fault, Outcome};
use grainbench::campaign::finished::FinishedTasks;
use grainbench::campaign::plan::{Kind, Plan};
use grainbench::campaign::task::Task;
use grainbench::campaign::work::ResultSink;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Kind of plan.
pub(crate) trait Study: Sync {
    /// Returns the kind as stored in the file of the plan.
    fn kind(&self) -> Kind;
    /// Returns true if the tasks measure times.
    fn is_timed(&self) -> bool;
    /// Returns all tasks. `program` is the hash of this program.
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault>;
    /// Returns the hashes of the files on which the tasks depend, by path.
    fn inputs(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }
    /// Runs tasks, at most `jobs` at the same time.
    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault>;
    /// Writes the report of the finished tasks.
    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome;
}

/// Directory, format and comparison of a report.
pub(crate) struct ReportOptions<'a> {
    /// Directory of the report.
    pub(crate) out: &'a Path,
    pub(crate) strict: bool,
    pub(crate) parquet: bool,
    pub(crate) json: bool,
    /// `results.json` of the last earlier report.
    pub(crate) against: Option<&'a Path>,
    /// Text with the number of finished tasks; none if all tasks are finished.
    pub(crate) unfinished: Option<String>,
    /// Further lines that the report lists among its options.
    pub(crate) words: Vec<String>,
    /// Total duration of the finished tasks (s).
    pub(crate) seconds: f64,
}
