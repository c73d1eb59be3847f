//! `--plan DIR`: writes a plan as a file with one task per line.

use super::arguments::Arguments;
use super::from_arguments;
use crate::cli::exit::{Fault, Outcome, print, print_json};
use grainbench::jobs::plan::{Head, Plan, check_place};
use grainbench::reports::number;
use serde::Serialize;
use std::path::PathBuf;

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
