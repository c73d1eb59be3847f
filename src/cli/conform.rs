//! `grainbench conform`: tests the conformance properties that every solver must satisfy.

use super::claims::conformance::owing;
use super::claims::tasks::ClaimTasks;
use super::cores::at_once;
use super::exit::{Fault, Outcome, check_writable};
use super::provenance::provenance;
use super::publish::{Output, add_reasons, publish};
use grainbench::cases::solvers;
use grainbench::jobs::execute::in_memory;
use grainbench::reports::Report;
use std::path::PathBuf;
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Names or manifests of solvers. Default: all built-in solvers.
    #[arg(value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    /// Treat amber results as red.
    #[arg(long)]
    strict: bool,
    /// Directory of the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Tests the conformance properties of the solvers and writes the report.
pub(crate) fn conform(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    check_writable(&arguments.out)?;
    let owing = owing(&arguments.solver)?;
    if owing.is_empty() {
        let names: Vec<String> = solvers::with_terms().iter().map(|(solver, _)| solver.name()).collect();
        let expected = "the path of a manifest (`SOLVER.toml`) or a built-in solver";
        return Err(Fault::unknown(expected, &arguments.solver.join(", "), names.iter().map(String::as_str)));
    }
    let tasks = ClaimTasks::with(Vec::new(), owing);
    let results = in_memory(&tasks, &tasks.order(), at_once(1), &(), &|_| {});
    let mut words = vec!["conform".to_owned()];
    words.extend(arguments.solver.iter().cloned());
    let mut report = Report::new(provenance(words, start.elapsed().as_secs_f64()), tasks.sections(results));
    add_reasons(&mut report, false, arguments.strict);
    publish(&report, &Output::new(&arguments.out, arguments.json, arguments.strict))
}
