//! Tasks of a command: written as a plan with `--plan DIR`, otherwise performed in its output directory. An interrupted
//! command continues there.

use super::arguments::{Arguments, StudyOptions};
use super::from_arguments;
use super::study::ReportOptions;
use super::watch::Follower;
use super::work::worker;
use crate::cli::cores::cores;
use crate::cli::exit::{self, Fault, Outcome, RED, check_writable, print, print_json, refuse};
use grainbench::jobs::plan::{Head, Plan, RUNNING, check_place};
use grainbench::jobs::shard::Shard;
use grainbench::jobs::work::WorkRequest;
use grainbench::reports::number;
use grainbench::store::log::State;
use grainbench::store::results::{self, FinishedTasks};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Summary of a plan, printed as JSON.
#[derive(Serialize)]
struct Summary<'a> {
    tasks: usize,
    shards: u32,
    seconds: f64,
    timed: bool,
    out: &'a PathBuf,
}

/// Computes the tasks of a plan, writes it to `--out` and returns it.
pub(crate) fn write(arguments: &Arguments) -> Result<Plan, Fault> {
    check_place(&arguments.out).map_err(|fault| Fault::input(format!("--out: {fault}")))?;
    Ok(from_arguments(arguments, true)?.plan(arguments)?.write()?)
}

/// Writes a plan and prints the number of tasks and their expected duration.
pub(crate) fn plan(arguments: &Arguments) -> Outcome {
    let plan = write(arguments)?;
    let Head { tasks, shards, seconds, timed, .. } = plan.head;
    if arguments.json {
        return print_json(&Summary { tasks, shards, seconds, timed, out: &arguments.out });
    }
    let times = if timed { ", times are measured" } else { "" };
    print(&format!(
        "{}, about {} on one core, in {}{times}\n{}\n",
        number::counted(tasks, "task"),
        number::seconds(seconds),
        number::counted(shards as usize, "shard"),
        arguments.out.display()
    ))
}

/// Shortest time between two updates of the report while tasks run.
const EVERY: Duration = Duration::from_secs(5);
/// Directories with finished parts that an earlier version of this program wrote to the output directory.
const EARLIER: [&str; 2] = ["points", "pieces"];

/// Writes a plan if `--plan` is given. Otherwise performs the tasks. `against` is the `results.json` of an earlier report.
pub(crate) fn plan_or_perform(arguments: &Arguments, options: &StudyOptions, against: Option<&Path>) -> Outcome {
    let arguments = &Arguments { json: options.json, ..arguments.clone() };
    match options.plan.planned(arguments) {
        Some(planned) => plan(&planned),
        None => perform(arguments, options, against),
    }
}

/// Performs the tasks that are not finished and writes the report. The report is also written while tasks run.
fn perform(arguments: &Arguments, options: &StudyOptions, against: Option<&Path>) -> Outcome {
    let out = &arguments.out;
    let study = from_arguments(arguments, false)?;
    if Plan::is_in(out) {
        let there = out.display();
        refuse!("--out: {there}: expected a directory without a plan, found a plan");
    }
    if let Some(path) = against {
        grainbench::reports::study::points_of(path)?;
    }
    check_writable(out)?;
    let plan = study.plan(arguments)?;
    for folder in EARLIER.map(|name| out.join(name)).iter().filter(|folder| folder.is_dir()) {
        let what = "finished parts of an earlier version are not read, and their folder can be deleted";
        exit::say("note", &format!("{}: {what}", folder.display()));
    }
    if options.no_cache {
        results::remove(out)?;
    }
    let how = ReportOptions { out: out.clone(), json: arguments.json, against, ..ReportOptions::default() };
    let report = |how: ReportOptions<'_>| {
        let finished = FinishedTasks::read(out, true).map_err(Fault::input)?;
        study.report_of(&plan, &finished, how)
    };
    let written = Mutex::new(Instant::now());
    let draft = || {
        // One thread writes the report, and the others continue.
        if let Ok(mut written) = written.try_lock()
            && written.elapsed() > EVERY
        {
            // An error of the disk is reported with the last report.
            let _ = report(ReportOptions { is_draft: true, ..how.clone() });
            *written = Instant::now();
        }
    };
    let jobs = if plan.head.timed { 1 } else { cores() };
    let asked = WorkRequest { shard: Shard::WHOLE, again: &[State::Crashed], jobs };
    let summary = study.work(&plan, &asked, &worker(), &Follower::new("tasks", Some(&draft)))?;
    // The folder of leases is empty unless another process works on the same directory.
    let _ = fs::remove_dir(out.join(RUNNING));
    let end = format!("{} of {} tasks were finished before\n", summary.before, summary.tasks);
    let update_stored = options.update_stored.then_some(arguments.what.as_str());
    let code = report(ReportOptions { end, update_stored, ..how.clone() })?;
    if summary.left > 0 {
        exit::say("warning", &format!("{} tasks remain; the same command continues the work", summary.left));
        return Ok(RED);
    }
    Ok(code)
}
