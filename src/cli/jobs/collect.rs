//! `report` of a plan. The report contains the results of all finished tasks, as if one machine had run them.

use super::arguments::Arguments as Planned;
use super::study::ReportOptions;
use super::{enter, from_arguments};
use crate::cli::exit::{self, Fault, Outcome, RED, check_writable};
use grainbench::jobs::plan::Plan;
use grainbench::reports::trend::{Column, write_trend};
use grainbench::store::results::FinishedTasks;
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
