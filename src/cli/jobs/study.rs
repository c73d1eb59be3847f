//! Kinds of work: each kind lists its tasks, performs them and makes the report. The tasks run in memory, in the output
//! directory of a command, or in the directory of a plan.

use super::arguments::Arguments;
use crate::cli::exit::{self, Fault, Outcome, RED, refuse};
use crate::cli::keep::keep_study;
use crate::cli::own::sources;
use crate::cli::provenance::{self, provenance};
use crate::cli::publish::{Output, publish_study};
use grainbench::jobs::execute::{TaskList, Watch};
use grainbench::jobs::plan::{Head, Plan};
use grainbench::jobs::task::Task;
use grainbench::jobs::work::{Summary, WorkRequest, work};
use grainbench::reports::study::{Study as Report, write_study};
use grainbench::store::log::Worker;
use grainbench::store::results::FinishedTasks;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Kind of work.
pub(crate) trait Study: TaskList {
    /// Returns true if the tasks measure times.
    fn is_timed(&self) -> bool {
        false
    }
    /// Returns all tasks. `program` is the hash of this program.
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault>;
    /// Returns the hashes of the files on which the tasks depend, by path.
    fn inputs(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }
    /// Returns an error if the cases or programs have changed since the plan was written.
    fn check(&self, plan: &Plan) -> Result<(), Fault> {
        check_ids(plan, &self.tasks(&plan.head.program)?)
    }
    /// Writes the report of the finished tasks. `results` has an entry for each task: `None` if it is not finished, an
    /// error if it crashed.
    fn report(&self, results: Vec<Option<Result<Self::Output, String>>>, how: &ReportOptions<'_>) -> Outcome;
}

/// Returns an error if a plan has other tasks.
pub(crate) fn check_ids(plan: &Plan, tasks: &[Task]) -> Result<(), Fault> {
    let is_same = tasks.iter().map(|task| task.id).eq(plan.tasks.iter().map(|task| task.id));
    let path = plan.path.display();
    let message = "the cases or programs have changed; write the plan again, unchanged tasks stay finished";
    if is_same { Ok(()) } else { Err(Fault::input(format!("{path}: {message}"))) }
}

/// Kind of work whose results have any type.
pub(crate) trait AnyStudy: Sync {
    /// Returns the plan of all tasks in the directory that the arguments name, without writing it.
    fn plan(&self, arguments: &Arguments) -> Result<Plan, Fault>;
    /// Returns an error if the cases or programs have changed since the plan was written.
    fn check(&self, plan: &Plan) -> Result<(), Fault>;
    /// Runs a shard of a plan.
    fn work(&self, plan: &Plan, asked: &WorkRequest, worker: &Worker, watch: &dyn Watch) -> Result<Summary, Fault>;
    /// Writes the report of the finished tasks of a plan, and adds to the options how much is finished. A study with
    /// unfinished tasks is not stored.
    fn report_of(&self, plan: &Plan, finished: &FinishedTasks, how: ReportOptions<'_>) -> Outcome;
}

impl<S: Study> AnyStudy for S {
    fn plan(&self, arguments: &Arguments) -> Result<Plan, Fault> {
        let words = toml::Value::try_from(arguments)?;
        let mut head = Head::new(words, self.is_timed());
        head.shards = arguments.shards.unwrap_or(0);
        head.version = format!("{} ({})", env!("CARGO_PKG_VERSION"), env!("GRAINBENCH_COMMIT"));
        head.date = provenance::now();
        head.inputs = self.inputs();
        let tasks = self.tasks(&head.program)?;
        if tasks.is_empty() {
            refuse!("expected at least one task, found none for the selected cases and solvers");
        }
        if tasks.len() > u32::MAX as usize {
            refuse!("expected at most 4294967295 tasks, found {}", tasks.len());
        }
        Ok(Plan { path: arguments.out.clone(), head, tasks })
    }

    fn check(&self, plan: &Plan) -> Result<(), Fault> {
        Study::check(self, plan)
    }

    fn work(&self, plan: &Plan, asked: &WorkRequest, worker: &Worker, watch: &dyn Watch) -> Result<Summary, Fault> {
        Ok(work(plan, asked, worker, watch, self)?)
    }

    fn report_of(&self, plan: &Plan, finished: &FinishedTasks, how: ReportOptions<'_>) -> Outcome {
        let entries = plan.tasks.iter().filter_map(|task| finished.entries.get(&task.id));
        let (all, done) = (plan.tasks.len(), entries.clone().count());
        let unfinished = (done < all).then(|| format!("unfinished: {done} of {all} tasks"));
        let words = unfinished.iter().cloned().chain(how.words).collect();
        let update_stored = how.update_stored.filter(|_| unfinished.is_none());
        let seconds = entries.map(|entry| entry.seconds).sum();
        let results = plan.tasks.iter().map(|task| finished.result(task.id)).collect();
        self.report(results, &ReportOptions { unfinished, words, update_stored, seconds, ..how })
    }
}

/// Directory, format and comparison of a report.
#[derive(Clone, Default)]
pub(crate) struct ReportOptions<'a> {
    /// Directory of the report.
    pub(crate) out: PathBuf,
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
    /// True while tasks are running: the report is written, and nothing is printed.
    pub(crate) is_draft: bool,
    /// Name under which a study is stored in the source tree, if it is stored.
    pub(crate) update_stored: Option<&'a str>,
    /// Text after the results.
    pub(crate) end: String,
}

impl ReportOptions<'_> {
    /// Returns a study without results. `words` are the command and its options.
    pub(super) fn study(&self, words: Vec<String>) -> Report {
        Report::new(provenance(words.into_iter().chain(self.words.iter().cloned()).collect(), self.seconds))
    }

    /// Adds the hashes of the solvers' sources to a study, and writes and prints it. The exit code is red if a task
    /// crashed.
    pub(super) fn publish(&self, mut study: Report, has_crash: bool) -> Outcome {
        let points = study.diagrams.iter().flat_map(|diagram| &diagram.points).map(|point| &point.solver);
        let limits = study.limits.iter().map(|limit| &limit.solver).chain(study.hard.iter().map(|row| &row.solver));
        let shifts = study.ledger.iter().flat_map(|entry| &entry.shifts).map(|shift| &shift.solver);
        study.sources = sources(&points.chain(limits).chain(shifts).cloned().collect::<Vec<_>>());
        if self.is_draft {
            write_study(&self.out, &study)?;
            return Ok(ExitCode::SUCCESS);
        }
        if let Some(name) = self.update_stored {
            keep_study(name, &study)?;
        }
        let text = Some(study.text() + &self.end);
        let code = publish_study(&study, Output { text, ..Output::new(&self.out, self.json) })?;
        Ok(if has_crash { RED } else { code })
    }
}

/// Returns the results of a study. A task whose result is missing has no entry; a crash is reported.
pub(super) fn outputs<T>(results: Vec<Option<Result<T, String>>>, how: &ReportOptions<'_>) -> (Vec<Option<T>>, bool) {
    let mut has_crash = false;
    let mut note = |detail: &String| {
        has_crash = true;
        if !how.is_draft {
            exit::say("warning", &format!("a task crashed and is omitted: {detail}"));
        }
    };
    let outputs = results.into_iter().map(|result| result?.inspect_err(&mut note).ok()).collect();
    (outputs, has_crash)
}
