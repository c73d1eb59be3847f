//! Kinds of plans: each lists its tasks, runs them, and makes the report.

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
    /// Returns the kind of plan that is stored in its file.
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

/// Output directory, format and comparison of a report.
pub(crate) struct ReportOptions<'a> {
    /// Directory of the report.
    pub(crate) out: &'a Path,
    pub(crate) strict: bool,
    pub(crate) parquet: bool,
    pub(crate) json: bool,
    /// Results of the last earlier report.
    pub(crate) against: Option<&'a Path>,
    /// Number of finished tasks in words, if some are missing.
    pub(crate) unfinished: Option<String>,
    /// Additional options that the report lists, in words.
    pub(crate) words: Vec<String>,
    /// Total duration of all tasks (s).
    pub(crate) seconds: f64,
}
