//! The keys of `output`: how often samples and snapshots are taken.

use crate::columns::Chosen;
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
    /// What snapshots hold beside id, material, radius, mass, position and velocity of every grain: any of `spin`, `force`,
    /// `contacts`, and V σ of grains, of the instant (`virial`) or its mean over the time since the snapshot before
    /// (`mean-virial`). The first three when absent.
    #[serde(default)]
    pub columns: Option<Vec<Chosen>>,
    /// Significant digits that numbers in snapshots keep, 1 to 15; all when absent. Files take the less room the fewer there are.
    #[serde(default)]
    pub digits: Option<u8>,
    /// Cycles between those that `mean-virial` is the mean of. A cycle that is looked at takes about as long as two.
    #[serde(default)]
    pub mean_every_cycles: Option<u64>,
}
