//! `grainbench conform`: tests the conformance properties that every solver must satisfy.

use super::claims::conformance::conforming;
use super::claims::tasks::ClaimTasks;
use super::cores::at_once;
use super::exit::{Fault, Outcome, check_writable};
use super::provenance::provenance;
use super::publish::ReportArguments;
use grainbench::cases::solvers;
use grainbench::jobs::execute::in_memory;
use grainbench::reports::Report;
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Names or manifests of solvers. Default: all built-in solvers.
    #[arg(value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    #[command(flatten)]
    report: ReportArguments,
}

/// Tests the conformance properties of the solvers and writes the report.
pub(crate) fn conform(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    check_writable(&arguments.report.out)?;
    let conforming = conforming(&arguments.solver)?;
    if conforming.is_empty() {
        let names: Vec<String> = solvers::with_terms().iter().map(|(solver, _)| solver.name()).collect();
        let expected = "the path of a manifest (`SOLVER.toml`) or a built-in solver";
        return Err(Fault::unknown(expected, &arguments.solver.join(", "), names.iter().map(String::as_str)));
    }
    let tasks = ClaimTasks::with(Vec::new(), conforming);
    let results = in_memory(&tasks, &tasks.order(), at_once(1), &(), &|_| {});
    let mut words = vec!["conform".to_owned()];
    words.extend(arguments.solver.iter().cloned());
    let report = Report::new(provenance(words, start.elapsed().as_secs_f64()), tasks.sections(results));
    arguments.report.publish(report, false, None)
}
