//! `--plan DIR`: writes a plan with one task per line.

use super::study;
use crate::cli::exit::{Fault, Outcome, print, print_json};
use crate::cli::value::whole;
use grainbench::campaign::plan::{Head, Plan, check_place};
use grainbench::campaign::shard;
use grainbench::reports::number;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of the command.
#[derive(Clone, Default, clap::Args)]
pub(crate) struct Arguments {
    /// Kind of plan: claims of cases, computing cost, stability limits, or a sweep file.
    #[arg(value_name = "run|cost|stability|SWEEP.toml")]
    pub(crate) what: String,
    /// Cases, as for `run`, `cost` and `stability`; all by default.
    #[arg(value_name = "CASE|CASE/VARIANT")]
    pub(crate) cases: Vec<String>,
    /// Select a solver, by name or manifest; repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Resolution levels for `run`; for `cost`, `all` includes points that take more than twenty seconds.
    #[arg(long, value_name = "default|all|NAME,…", value_delimiter = ',')]
    pub(crate) levels: Vec<String>,
    /// Filter for `run`, as its option `--filter`.
    #[arg(long, value_name = "quantity=…|source=…|evidence=…")]
    pub(crate) filter: Vec<String>,
    /// Skip the negative controls, for `run`.
    #[arg(long)]
    pub(crate) no_controls: bool,
    /// Run `lammps` and `liggghts` even if a stored run exists, for `run`.
    #[arg(long)]
    pub(crate) live: bool,
    /// Measure also the cost of the parts of a step, and of a step with one and with ten thousand grains, for `cost`.
    #[arg(long)]
    pub(crate) prices: bool,
    /// Measure only errors and counts, for `cost`; without timing, tasks can share a machine.
    #[arg(long, conflicts_with = "prices")]
    pub(crate) counts: bool,
    /// Number of shards; by default each shard lasts about a minute.
    #[arg(long, value_name = "N", value_parser = whole(1, shard::MOST))]
    pub(crate) shards: Option<u32>,
    /// Directory for the plan; finished tasks of an existing plan stay finished.
    #[arg(long, value_name = "DIR", default_value = "grainbench-plan")]
    pub(crate) out: PathBuf,
    /// Print the plan as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Options that write a plan instead of doing the work.
#[derive(clap::Args)]
pub(crate) struct PlanOptions {
    /// Write a plan to this directory instead of doing the work; `run --resume DIR` does it. Finished tasks of an existing plan
    /// stay finished.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "no_cache", "update_stored"])]
    pub(crate) plan: Option<PathBuf>,
    /// Number of shards of the plan; by default each shard lasts about a minute.
    #[arg(long, value_name = "N", value_parser = whole(1, shard::MOST), requires = "plan")]
    shards: Option<u32>,
}

impl PlanOptions {
    /// Returns the arguments of a plan; none if no plan is requested.
    pub(crate) fn arguments(&self, what: &str, cases: &[String], solver: &[String]) -> Option<Arguments> {
        let out = self.plan.clone()?;
        let (what, cases, solver) = (what.to_owned(), cases.to_vec(), solver.to_vec());
        Some(Arguments { what, cases, solver, shards: self.shards, out, ..Arguments::default() })
    }
}

/// Parser for the arguments of a stored plan.
#[derive(clap::Parser)]
struct PlanParser {
    #[command(flatten)]
    arguments: Arguments,
}

impl Arguments {
    /// Returns the command line that gives these arguments again.
    fn words(&self) -> Vec<String> {
        let mut words = vec![self.what.clone()];
        words.extend(self.cases.iter().cloned());
        let options = |name: &str, values: &[String]| -> Vec<String> {
            values.iter().map(|value| format!("--{name}={value}")).collect()
        };
        words.extend(options("solver", &self.solver));
        words.extend(options("levels", &self.levels));
        words.extend(options("filter", &self.filter));
        let flags =
            [("no-controls", self.no_controls), ("live", self.live), ("prices", self.prices), ("counts", self.counts)];
        words.extend(flags.iter().filter(|(_, is_set)| *is_set).map(|(name, _)| format!("--{name}")));
        words
    }

    /// Reads the arguments from a stored plan.
    pub(crate) fn read(plan: &Plan) -> Result<Self, Fault> {
        let words = std::iter::once("plan").chain(plan.head.arguments.iter().map(String::as_str));
        let again = <PlanParser as clap::Parser>::try_parse_from(words).map_err(|error| {
            let found = error.to_string().lines().next().unwrap_or_default().to_owned();
            Fault::input(format!("{}: expected arguments of a plan, found {found}", plan.path.display()))
        })?;
        Ok(again.arguments)
    }

    /// Rejects options that this kind of plan does not support.
    pub(crate) fn only(&self, heeded: &[&str]) -> Result<(), Fault> {
        let given = [
            ("CASE", !self.cases.is_empty()),
            ("--solver", !self.solver.is_empty()),
            ("--levels", !self.levels.is_empty()),
            ("--filter", !self.filter.is_empty()),
            ("--no-controls", self.no_controls),
            ("--live", self.live),
            ("--prices", self.prices),
            ("--counts", self.counts),
        ];
        match given.iter().find(|(name, is_given)| *is_given && !heeded.contains(name)) {
            Some((name, _)) => {
                let study_name = if heeded.is_empty() { "a sweep" } else { self.what.as_str() };
                Err(Fault::input(format!("{name}: not supported with {study_name}")))
            }
            None => Ok(()),
        }
    }
}

/// JSON summary of a plan.
#[derive(Serialize)]
struct Summary<'a> {
    tasks: usize,
    shards: u32,
    seconds: f64,
    timed: bool,
    out: &'a PathBuf,
}

/// Writes a plan.
pub(crate) fn write(arguments: &Arguments) -> Result<Plan, Fault> {
    check_place(&arguments.out).map_err(|fault| Fault::input(format!("--out: {fault}")))?;
    let study = study::from_arguments(arguments)?;
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

/// Writes a plan and prints its size.
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
