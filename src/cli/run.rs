//! `grainbench run`: judges the claims of cases and writes the report.

use super::cache;
use super::claims::tasks::ClaimTasks;
use super::claims::{ClaimOptions, report};
use super::cores::at_once;
use super::earlier::EarlierReport;
use super::exit::{self, Fault, Outcome, check_writable, exit_code, refuse};
use super::filter::Filters;
use super::jobs;
use super::jobs::arguments::{Arguments as Planned, PlanOptions};
use super::jobs::watch::Follower;
use super::jobs::work::WorkOptions;
use super::keep::{self, keep};
use super::provenance::provenance;
use super::publish::{Output, add_reasons, publish};
use super::select::CaseSelection;
use grainbench::harness::run::{Data, SceneDataError};
use grainbench::harness::runner::RunnerOptions;
use grainbench::jobs::execute::in_memory;
use grainbench::reference::outside::named_features;
use grainbench::reports::{Report, Section, line, number};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases, patterns such as 'incline-*' or '*/60deg*', or folders with `scene.toml` and `claims.toml`. Default: all
    /// built-in cases.
    #[arg(value_name = "CASE|CASE/VARIANT|FOLDER")]
    cases: Vec<String>,
    /// Judge only the claims of this solver. With a manifest, the external solver runs the solver-independent claims. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    #[command(flatten)]
    rest: RunOptions,
}

/// Options that `run` and `judge` share.
#[derive(clap::Args)]
pub(super) struct RunOptions {
    #[command(flatten)]
    options: ClaimOptions,
    #[command(flatten)]
    pub(super) plan: PlanOptions,
    /// Run the unfinished tasks of the plan in DIR.
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["plan", "cases", "solver", "levels", "filter", "live", "no_controls", "json", "out", "no_cache"]
    )]
    resume: Option<PathBuf>,
    #[command(flatten)]
    work: WorkOptions,
}

/// Runs the cases, writes a plan, or runs the tasks of a plan.
pub(crate) fn command(arguments: Arguments) -> Outcome {
    judge_by(arguments.cases, arguments.solver, arguments.rest)
}

/// Judges solvers by the cases, writes a plan, or runs the tasks of a plan.
pub(super) fn judge_by(cases: Vec<String>, solver: Vec<String>, rest: RunOptions) -> Outcome {
    let RunOptions { options, plan, resume, work } = rest;
    if let Some(plan) = resume {
        return jobs::work::work(&plan, &work, options.jobs, options.retry_failed);
    }
    let arguments = Planned {
        what: "run".to_owned(),
        cases,
        solver,
        levels: options.levels.clone(),
        filter: options.filter.clone(),
        no_controls: options.no_controls,
        live: options.live,
        json: options.json,
        ..Planned::default()
    };
    plan.planned(&arguments).map_or_else(|| run(arguments, &options), |planned| jobs::plan::plan(&planned))
}

/// Runs the named cases, or all cases if none is named.
fn run(mut arguments: Planned, options: &ClaimOptions) -> Outcome {
    let filters = Filters::read(&arguments.filter)?;
    // With `--retry-failed` and without names, the cases of the earlier run are used.
    let before = if options.retry_failed { Some(EarlierReport::read("--retry-failed", &options.out)?) } else { None };
    if let Some(before) = before.as_ref().filter(|_| arguments.cases.is_empty()) {
        arguments.cases = before.cases();
    }
    let earlier = options.against.as_deref().map(|path| EarlierReport::read("--against", path)).transpose()?;
    let (threads, data) = (usize::from(options.threads), options.data.clone());
    let of_runs = RunnerOptions { threads, data, ..RunnerOptions::default() };
    let tasks = ClaimTasks::new(&arguments, &filters, before.as_ref(), of_runs)?;
    if let Some(folder) = &options.data {
        refuse_without_use(&tasks.selected, folder)?;
    }
    check_writable(&options.out)?;
    let tasks = tasks.cached(cache::open(options.no_cache));
    let selected = &tasks.selected;
    let kept = if options.expect_stored { Some(keep::read(keep::program(selected)?)?) } else { None };
    let named = arguments.cases.iter().chain(&arguments.filter).next();
    if let Some(part) = named.filter(|_| options.update_stored) {
        refuse!("--update-stored: expected all cases, found `{part}` named");
    }
    let keeping = if options.update_stored { Some(keep::program(selected)?) } else { None };
    let start = Instant::now();
    let results = perform(&tasks, options);
    let left = results.iter().filter(|result| result.is_none()).count();
    let sections = tasks.sections(results);
    let mut words = tasks.words.clone();
    if left > 0 {
        let kept = if tasks.cache.is_some() { ", and the next run continues with the finished runs" } else { "" };
        let what = format!("interrupted: {left} checks were omitted; the report contains the finished checks{kept}");
        exit::say("warning", &what);
        words.push(interrupted(left));
    }
    words.extend(tasks.cache.as_deref().and_then(cache::words));
    let provenance = provenance(words, start.elapsed().as_secs_f64());
    let mut report = report(provenance, sections, tasks.is_whole)?;
    if let Some(program) = keeping {
        if left > 0 {
            refuse!("--update-stored: expected a whole run, found {left} checks left out");
        }
        keep(program, &report)?;
    }
    if left > 0 {
        report.red_because.push(interrupted(left));
    }
    add_reasons(&mut report, false, options.strict && !options.expect_stored);
    let otherwise = match &kept {
        Some(kept) => keep::differences(keep::program(selected)?, kept, &report),
        None => Vec::new(),
    };
    report.red_because.extend(otherwise.iter().map(|line| format!("differs from the stored results: {line}")));
    report.shown = filters.outcomes();
    let ClaimOptions { out, parquet, json, .. } = options;
    let output = Output { parquet: *parquet, quiet: options.quiet, ..Output::new(out, *json) };
    let code = publish(&report, &output)?;
    tell_undeclared(&report);
    if let Some(earlier) = &earlier {
        let changes = earlier.changes(&report, named.is_none() && before.is_none());
        let none = ["nothing: every result and every control has the same outcome, value and tolerance".to_owned()];
        let lines = if changes.is_empty() { &none[..] } else { &changes[..] };
        lines.iter().for_each(|line| exit::say("changed", line));
    }
    if kept.is_some() {
        otherwise.iter().for_each(|line| exit::say("differs from the stored results", line));
        return Ok(exit_code(!report.red_because.is_empty()));
    }
    Ok(code)
}

/// Returns the reason why an interrupted run is red. [`EarlierReport`] recognizes this text.
fn interrupted(left: usize) -> String {
    format!("interrupted: {left} checks left out")
}

/// Returns an error if no claim uses the data directory, if it contains none of the needed data, or if its data are damaged.
fn refuse_without_use(selected: &[CaseSelection], folder: &Path) -> Result<(), Fault> {
    let runs = selected.iter().flat_map(|selection| &selection.claims).flat_map(|claim| &claim.runs);
    let mut needed: Vec<&Data> = runs.filter_map(|run| run.data).collect();
    needed.sort_by_key(|data| data.name);
    needed.dedup_by_key(|data| data.name);
    if needed.is_empty() {
        refuse!("--data: expected claims that start from third-party data, found none in the selection");
    }
    let not_made: Vec<SceneDataError> = needed.iter().filter_map(|data| (data.scene)(folder).err()).collect();
    let is_wrong = |reason: &SceneDataError| matches!(reason, SceneDataError::Wrong(_));
    let any_is_wrong = not_made.iter().any(is_wrong);
    if any_is_wrong || not_made.len() == needed.len() {
        let reasons =
            not_made.into_iter().filter(|reason| !any_is_wrong || is_wrong(reason)).map(SceneDataError::into_words);
        refuse!("--data: {}", reasons.collect::<Vec<_>>().join("; "));
    }
    Ok(())
}

/// Performs all tasks in this process. A task that was omitted because of an interrupt has no result.
fn perform(tasks: &ClaimTasks, options: &ClaimOptions) -> Vec<Option<Result<Section, String>>> {
    let follower = Follower::new("checks", None);
    let tell = |finished: &Section| {
        for row in finished.verdicts.iter().filter(|_| options.verbose) {
            follower.tell(&format!("{}: {}", row.outcome.word(), line::verdict(row)));
        }
    };
    let jobs = options.jobs.map_or_else(|| at_once(usize::from(options.threads)), usize::from);
    in_memory(tasks, &tasks.order(), jobs, &follower, &tell)
}

/// Prints the number of unsupported results and the features that they need, most frequent first. Nothing is printed if
/// no result needs such a feature.
fn tell_undeclared(report: &Report) {
    let rows = report.verdicts();
    if let Some(message) = undeclared(rows.filter_map(|row| row.detail.as_deref())) {
        exit::say("note", &message);
    }
}

/// Returns the message about features that results need and that the manifest of an external solver does not declare.
fn undeclared<'a>(reasons: impl Iterator<Item = &'a str>) -> Option<String> {
    let (mut results, mut counts) = (0, BTreeMap::<(&str, &str), usize>::new());
    for features in reasons.map(named_features).filter(|found| !found.is_empty()) {
        results += 1;
        features.into_iter().for_each(|feature| *counts.entry(feature).or_default() += 1);
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words: Vec<String> = counts.iter().map(|((_, name), count)| format!("{name} ({count})")).collect();
    let mut keys: Vec<String> = counts.iter().map(|((key, _), _)| format!("`can.{key}`")).collect();
    keys.sort();
    keys.dedup();
    let message = format!(
        "{} unsupported: {}; a solver that has these features declares them in SOLVER.toml, {}",
        number::counted(results, "result"),
        words.join(", "),
        keys.join(" and ")
    );
    (results > 0).then_some(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_is_counted_once_for_each_result() {
        let reasons = [
            "it does not declare effects `friction`",
            "one cannot run this scene: it does not declare walls `mesh`; effects `friction`, `cohesion`",
            "it moves one grain",
        ];
        assert_eq!(
            undeclared(reasons.into_iter()).unwrap(),
            "2 results unsupported: friction (2), cohesion (1), mesh (1); a solver that has these features declares them in \
             SOLVER.toml, `can.effects` and `can.walls`"
        );
        assert_eq!(undeclared(reasons[2..].iter().copied()), None);
    }
}
