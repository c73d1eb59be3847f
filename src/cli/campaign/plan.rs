//! `--plan DIR`: writes a plan as a file with one task per line.

use super::arguments::Arguments;
use super::kinds;
use crate::cli::exit::{Fault, Outcome, print, print_json};
use grainbench::campaign::plan::{Head, Plan, check_place};
use grainbench::reports::number;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

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
    let study = kinds::from_arguments(arguments)?;
    let mut head = Head::new(study.kind(), arguments.words(), study.is_timed());
    head.shards = arguments.shards.unwrap_or(0);
    head.version = format!("{} ({})", env!("CARGO_PKG_VERSION"), env!("GRAINBENCH_COMMIT"));
    head.date = jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M:%S UTC").to_string();
    head.inputs = study.inputs();
    let tasks = study.tasks(&head.program)?;
    if tasks.is_empty() {
        return Err(Fault::input("expected at least one task, found none for the selected cases and solvers"));
    }
    if tasks.len() > u32::MAX as usize {
        return Err(Fault::input(format!("expected at most 4294967295 tasks, found {}", tasks.len())));
    }
    Ok(Plan::write(&arguments.out, head, tasks)?)
}

/// Writes a plan and prints the number of tasks and their expected duration.
pub(crate) fn plan(arguments: &Arguments) -> Outcome {
    let plan = write(arguments)?;
    let Head { tasks, shards, seconds, timed, .. } = plan.head;
    if arguments.json {
        print_json(&Summary { tasks, shards, seconds, timed, out: &arguments.out })?;
        return Ok(ExitCode::SUCCESS);
    }
    let plural =
        |count: u64, what: &str| format!("{} {what}{}", number::count(count), if count == 1 { "" } else { "s" });
    let times = if timed { ", times are measured" } else { "" };
    print(&format!(
        "{}, about {} on one core, in {}{times}\n{}\n",
        plural(tasks as u64, "task"),
        number::seconds(seconds),
        plural(u64::from(shards), "shard"),
        arguments.out.display()
    ))?;
    Ok(ExitCode::SUCCESS)
}
