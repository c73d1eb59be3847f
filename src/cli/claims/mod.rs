//! Claims of a run: the options that select them, and their report.

pub(crate) mod conformance;
pub(crate) mod tasks;

use super::cores::MOST_THREADS;
use super::earlier::EarlierReport;
use super::exit::{Fault, refuse};
use super::filter::Filters;
use super::jobs::arguments::Arguments;
use super::select::CaseSelection;
use super::value::whole;
use grainbench::harness::claim::Claim;
use grainbench::reports::measured::Measurements;
use grainbench::reports::{Provenance, Report, Section};
use std::path::PathBuf;

/// Options of `run` and `judge`.
#[derive(clap::Args)]
pub(crate) struct ClaimOptions {
    /// Resolution levels: `default`, `all`, or names such as `dt=.1`.
    #[arg(long, value_name = "default|all|NAME,…", value_delimiter = ',')]
    pub(crate) levels: Vec<String>,
    /// Select results by quantity, source (substring or pattern), evidence or outcome. Of several filters with the same
    /// key, one must match. With a filter by outcome, all claims still run and determine the exit code.
    #[arg(long, value_name = "quantity=…|source=…|evidence=…|outcome=…")]
    pub(crate) filter: Vec<String>,
    /// Repeat only the failed claims and controls of the report in `--out`, and the missing ones of an interrupted run.
    /// With `--resume`, repeat the failed tasks of the plan.
    #[arg(long, conflicts_with_all = ["update_stored", "plan"])]
    pub(crate) retry_failed: bool,
    /// Print the results and controls whose outcome, expected value or tolerance has changed since this earlier report.
    #[arg(long, value_name = "DIR|results.json", conflicts_with_all = ["plan", "resume"])]
    pub(crate) against: Option<PathBuf>,
    /// Directory of the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Write `rows.parquet` in addition to `rows.csv`.
    #[arg(long, conflicts_with_all = ["plan", "resume"])]
    pub(crate) parquet: bool,
    /// Run `lammps` and `liggghts` even if a stored run exists.
    #[arg(long)]
    pub(crate) live: bool,
    /// Directory with your copy of third-party data. Claims whose data are missing are `not-available`.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["plan", "resume"])]
    pub(crate) data: Option<PathBuf>,
    /// Treat amber results as red, including those of programs that are not installed.
    #[arg(long, conflicts_with_all = ["plan", "resume"])]
    pub(crate) strict: bool,
    /// Ignore the cache of finished runs.
    #[arg(long)]
    pub(crate) no_cache: bool,
    /// Skip the negative controls.
    #[arg(long)]
    pub(crate) no_controls: bool,
    /// Store the results of an external solver in `judged.json` in the directory of its manifest. Needs all cases and
    /// all controls.
    #[arg(long, requires = "solver", conflicts_with = "no_controls")]
    pub(crate) update_stored: bool,
    /// Compare the outcomes with those in `judged.json` in the directory of the manifest. Only a different outcome is red.
    #[arg(long, requires = "solver", conflicts_with_all = ["no_controls", "update_stored", "plan"])]
    pub(crate) expect_stored: bool,
    /// Number of threads of each run. The results do not depend on it.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = whole(1, MOST_THREADS),
        conflicts_with_all = ["plan", "resume"]
    )]
    pub(crate) threads: u16,
    /// Number of simultaneous runs or tasks. Default: as many as the cores allow, or 1 if a plan measures times.
    #[arg(short, long, value_name = "N", value_parser = whole(1, MOST_THREADS), conflicts_with_all = ["plan", "on"])]
    pub(crate) jobs: Option<u16>,
    /// Print only the counts and the failed results.
    #[arg(short, long, conflicts_with_all = ["verbose", "plan", "resume"])]
    pub(crate) quiet: bool,
    /// Print each result to standard error as soon as it is judged.
    #[arg(short, long, conflicts_with_all = ["plan", "resume"])]
    pub(crate) verbose: bool,
}

/// Returns a report. If `is_whole` is true, the report also contains the stored results of external solvers and the
/// stored measurements.
pub(crate) fn report(provenance: Provenance, sections: Vec<Section>, is_whole: bool) -> Result<Report, Fault> {
    let (judged, measured) = if is_whole {
        (grainbench::peers::kept()?, grainbench::kept::measured()?)
    } else {
        (Vec::new(), Measurements::default())
    };
    Ok(Report { judged, measured, ..Report::new(provenance, sections) })
}

/// Removes the claims that the filters exclude. With the earlier report of `--retry-failed`, also removes the claims that were
/// not red in it, unless an interrupted run omitted them.
fn narrow(
    selected: &mut Vec<CaseSelection>,
    arguments: &Arguments,
    filters: &Filters,
    before: Option<&EarlierReport>,
) -> Result<(), Fault> {
    for of_case in &mut *selected {
        let case = of_case.case.name;
        let external = of_case.external.as_ref().map(|external| external.manifest().name.as_str());
        let is_meant = |claim: &Claim| {
            let solver = external.or(claim.runs.first().map(|run| run.solver)).unwrap_or_default();
            before.is_none_or(|before| before.is_open(case, solver, claim, !arguments.no_controls))
        };
        let asked = of_case.claims.len();
        of_case.claims.retain(|claim| filters.means(claim) && is_meant(claim));
        of_case.is_part = of_case.claims.len() < asked;
    }
    selected.retain(|of_case| !of_case.claims.is_empty());
    if selected.is_empty() {
        let what =
            if before.is_some() { "that was red or omitted in the earlier report" } else { "that matches the filters" };
        refuse!("expected at least one claim {what}, found none");
    }
    Ok(())
}

/// Returns the cases, and the given options that select claims or change runs, for the provenance of the report.
fn words(arguments: &Arguments, has_data: bool, retry_failed: bool) -> Vec<String> {
    let Arguments { cases, solver, levels, filter, live, no_controls, .. } = arguments;
    let mut words = cases.clone();
    words.extend(solver.iter().map(|solver| format!("--solver {solver}")));
    if !levels.is_empty() {
        words.push(format!("--levels {}", levels.join(",")));
    }
    let given = [("--live", *live), ("--no-controls", *no_controls), ("--data", has_data)];
    words.extend(given.into_iter().filter(|(_, is_given)| *is_given).map(|(name, _)| name.to_owned()));
    words.extend(filter.iter().map(|filter| format!("--filter {filter}")));
    words.extend(retry_failed.then(|| "--retry-failed".to_owned()));
    words
}
