//! Arguments of a plan, read from the command line and from a stored plan.

use crate::cli::exit::Fault;
use crate::cli::value::whole;
use grainbench::jobs::plan::Plan;
use grainbench::jobs::shard;
use std::path::{Path, PathBuf};

/// Arguments of `run`, `cost`, `stability` and `effects`, and the file of a sweep, which determine the tasks.
#[derive(Clone, Default, clap::Args)]
pub(crate) struct Arguments {
    /// Command, or path of a sweep file.
    pub(crate) what: String,
    pub(crate) cases: Vec<String>,
    #[arg(long)]
    pub(crate) solver: Vec<String>,
    #[arg(long, value_delimiter = ',')]
    pub(crate) levels: Vec<String>,
    #[arg(long)]
    pub(crate) filter: Vec<String>,
    #[arg(long)]
    pub(crate) no_controls: bool,
    #[arg(long)]
    pub(crate) live: bool,
    #[arg(long)]
    pub(crate) prices: bool,
    #[arg(long)]
    pub(crate) counts: bool,
    /// Number of shards of a plan.
    #[arg(skip)]
    pub(crate) shards: Option<u32>,
    /// Directory of the plan or of the report.
    #[arg(skip)]
    pub(crate) out: PathBuf,
    /// True to print results as JSON.
    #[arg(skip)]
    pub(crate) json: bool,
}

/// Options of commands that can write a plan.
#[derive(clap::Args)]
pub(crate) struct PlanOptions {
    /// Write a plan to this directory and run nothing. `run --resume DIR` runs the plan. Finished tasks of an existing
    /// plan stay finished.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "no_cache", "update_stored"])]
    pub(crate) plan: Option<PathBuf>,
    /// Number of shards of the plan. Default: as many as last at least 60 s on average.
    #[arg(long, value_name = "N", value_parser = whole(1, shard::MOST), requires = "plan")]
    shards: Option<u32>,
}

impl PlanOptions {
    /// Returns true if a plan is written.
    pub(crate) const fn is_given(&self) -> bool {
        self.plan.is_some()
    }

    /// Returns the arguments of the plan; none without `--plan`.
    pub(crate) fn planned(&self, arguments: &Arguments) -> Option<Arguments> {
        let out = self.plan.clone()?;
        Some(Arguments { shards: self.shards, out, ..arguments.clone() })
    }
}

/// Options of `cost`, `stability` and `effects` that do not change the tasks.
pub(crate) struct StudyOptions<'a> {
    /// True to repeat finished tasks.
    pub(crate) no_cache: bool,
    /// `results.json` of an earlier report.
    pub(crate) against: Option<&'a Path>,
    /// True to store the results in the source tree.
    pub(crate) update_stored: bool,
}

/// Parser for the arguments of a stored plan.
#[derive(clap::Parser)]
struct PlanParser {
    #[command(flatten)]
    arguments: Arguments,
}

impl Arguments {
    /// Returns the words of a command line that gives these arguments.
    pub(super) fn words(&self) -> Vec<String> {
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

    /// Returns the command, the cases and the solvers for the provenance of the report.
    pub(super) fn command_words(&self, command: &str) -> Vec<String> {
        let words = std::iter::once(command.to_owned()).chain(self.cases.iter().cloned());
        words.chain(self.solver.iter().map(|solver| format!("--solver {solver}"))).collect()
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
}
