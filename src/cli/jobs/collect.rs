//! `report` of a plan, which contains the results of all finished tasks, as if one machine had run them. `--progress`
//! prints the progress of the plan instead.

use super::arguments::Arguments as Planned;
use super::study::ReportOptions;
use super::{enter, from_arguments};
use crate::cli::exit::{self, Fault, Outcome, RED, check_writable, print, print_json};
use grainbench::jobs::plan::Plan;
use grainbench::jobs::slurm;
use grainbench::jobs::status::Status;
use grainbench::reports::number;
use grainbench::reports::trend::{Column, write_trend};
use grainbench::store::results::FinishedTasks;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf, absolute};

/// Options of the report of a plan.
#[derive(Default, clap::Args)]
pub(crate) struct CollectOptions {
    /// Plot the trend of outcomes and counts from these earlier reports, oldest first. Repeatable. For a plan made by
    /// `cost`, times are compared with the last of these reports.
    #[arg(long, value_name = "DIR|results.json")]
    pub(crate) against: Vec<PathBuf>,
    /// Treat amber results as red.
    #[arg(long)]
    pub(crate) strict: bool,
    /// Also write `rows.parquet` for a plan made by `run`. The report of a sweep always contains it.
    #[arg(long)]
    pub(crate) parquet: bool,
    /// Directory of the report. Default: `report` in the directory of the plan.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the results as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

impl CollectOptions {
    /// Returns the name of the first option that is given; none if no option is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--against", !self.against.is_empty()),
            ("--strict", self.strict),
            ("--parquet", self.parquet),
            ("--out", self.out.is_some()),
            ("--json", self.json),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }
}

pub(crate) fn collect(plan: &Path, arguments: &CollectOptions) -> Outcome {
    let mut columns = arguments.against.iter().map(|path| read_column(path)).collect::<Result<Vec<_>, _>>()?;
    // Paths on the command line are relative to the current directory. Paths in the plan are relative to the directory
    // in which the plan was made.
    let from_here = |path: &Path| absolute(path).unwrap_or_else(|_| path.to_owned());
    let out = from_here(&arguments.out.clone().unwrap_or_else(|| plan.join("report")));
    let against = arguments.against.last().map(|path| results_of(&from_here(path)));
    if let Some(out) = &arguments.out {
        check_writable(out)?;
    }
    let plan = enter(plan)?;
    plan.check_program()?;
    check_writable(&out)?;
    let study = from_arguments(&Planned::read(&plan)?, true)?;
    study.check(&plan)?;
    let finished = FinishedTasks::read(&plan.path, true).map_err(Fault::input)?;
    let how = ReportOptions {
        out: out.clone(),
        strict: arguments.strict,
        parquet: arguments.parquet,
        json: arguments.json,
        against: against.as_deref(),
        words: words(&plan, &finished),
        ..ReportOptions::default()
    };
    let code = study.report_of(&plan, &finished, how)?;
    if !columns.is_empty() {
        columns.push(read_column(&out)?);
        write_trend(&out, &columns)?;
    }
    let missing = plan.tasks.iter().filter(|task| !finished.entries.contains_key(&task.id)).count();
    if missing > 0 {
        let what =
            format!("{missing} of {} tasks are not finished; the report contains the finished tasks", plan.tasks.len());
        exit::say("warning", &what);
        return Ok(RED);
    }
    Ok(code)
}

/// Returns texts for the report: the machines that ran the tasks, and the largest system load during timed tasks.
fn words(plan: &Plan, finished: &FinishedTasks) -> Vec<String> {
    let mut words = Vec::new();
    let used: BTreeSet<usize> =
        plan.tasks.iter().filter_map(|task| finished.entries.get(&task.id)).map(|entry| entry.worker).collect();
    let mut machines: BTreeSet<String> = BTreeSet::new();
    for worker in used.into_iter().filter_map(|place| finished.workers.get(place)) {
        let granted =
            worker.granted.map_or_else(String::new, |cores| format!(", of which {cores} were allotted to the job"));
        machines.insert(format!("{} ({}{granted})", worker.host, worker.machine));
    }
    if !machines.is_empty() {
        words.push(format!("worked on {}", machines.into_iter().collect::<Vec<_>>().join("; ")));
    }
    if plan.head.timed {
        let loads = plan.tasks.iter().filter_map(|task| finished.entries.get(&task.id)?.load);
        if let Some(most) = loads.reduce(f64::max) {
            words.push(format!("load at most {most} while times were measured"));
        }
    }
    words
}

fn results_of(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("results.json") } else { path.to_owned() }
}

/// Reads an earlier report as a column of the trend.
fn read_column(path: &Path) -> Result<Column, Fault> {
    let file = results_of(path);
    let name = if path.is_dir() { path } else { path.parent().unwrap_or(path) };
    let name = name.file_name().map_or_else(|| "report".to_owned(), |name| name.to_string_lossy().into_owned());
    Column::read(&name, &file).map_err(|error| Fault::input(format!("--against: {error}")))
}

/// Progress of a plan, printed as JSON.
#[derive(Serialize)]
struct StatusJson<'a> {
    #[serde(flatten)]
    status: &'a Status,
    /// Number of elements of job arrays that wait or run; null if the batch system cannot be queried.
    queued: Option<usize>,
}

/// Prints how many tasks of a plan are in each state.
pub(crate) fn status(plan: &Path, json: bool) -> Outcome {
    let plan = Plan::read(plan)?;
    let status = Status::from_plan(&plan)?;
    let queued = slurm::in_queue(&plan.path);
    if json {
        return print_json(&StatusJson { status: &status, queued: queued.ok() });
    }
    let mut text = String::new();
    let lines = [
        ("done", status.done),
        ("failed", status.failed),
        ("crashed", status.crashed),
        ("running", status.running),
        ("waiting", status.waiting),
        ("twice", status.twice),
        ("damaged", status.damaged),
    ];
    for (word, count) in lines {
        // Counts that should be zero are printed only if they are not zero.
        if count > 0 || !matches!(word, "crashed" | "twice" | "damaged") {
            text.push_str(&format!("{word:<9} {}\n", number::count(count as u64)));
        }
    }
    text.push_str(&format!("{:<9} {}\n", "of", number::count(status.tasks as u64)));
    for worker in &status.workers {
        let tasks: usize = worker.tasks.iter().map(|[from, to]| to - from).sum();
        let job = worker.job.as_ref().map_or_else(String::new, |job| format!(", job {job}"));
        text.push_str(&format!("worker    {}{job}: {} of {tasks}\n", worker.worker, worker.done));
    }
    match queued {
        Ok(0) => {}
        Ok(count) => text.push_str(&format!("queued    {} shards\n", number::count(count as u64))),
        Err(fault) => text.push_str(&format!("queued    not known: {fault}\n")),
    }
    if status.running + status.waiting > 0 {
        text.push_str(&format!("left      about {}\n", number::seconds(status.seconds_left)));
    }
    print(&text)
}
