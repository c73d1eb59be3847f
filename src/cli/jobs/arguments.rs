//! Arguments of a plan, read from the command line and from a stored plan.

use crate::cli::exit::Fault;
use crate::cli::value::whole;
use grainbench::jobs::plan::Plan;
use grainbench::jobs::shard;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Arguments of `run`, `cost`, `stability` and `effects`, and the file of a sweep, which determine the tasks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Arguments {
    /// Command, or path of a sweep file.
    pub(crate) what: String,
    pub(crate) cases: Vec<String>,
    pub(crate) solver: Vec<String>,
    pub(crate) levels: Vec<String>,
    pub(crate) filter: Vec<String>,
    pub(crate) no_controls: bool,
    pub(crate) live: bool,
    pub(crate) prices: bool,
    pub(crate) counts: bool,
    /// Number of shards of a plan.
    #[serde(skip)]
    pub(crate) shards: Option<u32>,
    /// Directory of the plan or of the report.
    #[serde(skip)]
    pub(crate) out: PathBuf,
    /// True to print results as JSON.
    #[serde(skip)]
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
    /// Returns the arguments of the plan; none without `--plan`.
    pub(crate) fn planned(&self, arguments: &Arguments) -> Option<Arguments> {
        let out = self.plan.clone()?;
        Some(Arguments { shards: self.shards, out, ..arguments.clone() })
    }
}

/// Options of `cost`, `stability` and `effects` that do not change the tasks.
#[derive(clap::Args)]
pub(crate) struct StudyOptions {
    /// Repeat the finished parts of the study.
    #[arg(long)]
    pub(crate) no_cache: bool,
    /// Store the results in the source tree, for the first screen of the report. Needs all cases and all built-in solvers.
    #[arg(long, conflicts_with_all = ["cases", "solver"])]
    pub(crate) update_stored: bool,
    /// Print the results as JSON instead of text.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) plan: PlanOptions,
}

impl Arguments {
    /// Returns the command, the cases and the solvers for the provenance of the report.
    pub(super) fn command_words(&self) -> Vec<String> {
        let words = std::iter::once(&self.what).chain(&self.cases).cloned();
        words.chain(self.solver.iter().map(|solver| format!("--solver {solver}"))).collect()
    }

    /// Reads the arguments from a stored plan.
    pub(crate) fn read(plan: &Plan) -> Result<Self, Fault> {
        plan.head.arguments.clone().try_into().map_err(|error: toml::de::Error| {
            let path = plan.path.display();
            Fault::input(format!("{path}: arguments: expected the table that this version writes: {}", error.message()))
        })
    }
}
