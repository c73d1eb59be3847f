//! The keys of `output`: how often samples and snapshots are taken.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is written down during the run.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputSpec {
    /// Time between samples of the probes (s), rounded to whole cycles. Give this or `every_cycles`; 200 samples over
    /// the run when both are absent.
    #[serde(default)]
    pub every: Option<f64>,
    /// Cycles between samples of the probes.
    #[serde(default)]
    pub every_cycles: Option<u64>,
    /// Number of snapshots, evenly spread, beside the first and the last. Default 0.
    #[serde(default)]
    pub snapshots: u32,
    /// Times of further snapshots (s), each taken at the nearest cycle.
    #[serde(default)]
    pub snapshot_times: Vec<f64>,
    /// Whether snapshots of other programs hold the contacts between grains, as those of our solvers always do.
    #[serde(default)]
    pub contacts: bool,
}
