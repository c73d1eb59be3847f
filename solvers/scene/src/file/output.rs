//! Keys of `output`: intervals of samples and snapshots, and the contents of snapshots.

use crate::columns::Chosen;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Output of the run.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputSpec {
    /// Time between samples of the probes (s), rounded to whole cycles. Give this or `every_cycles`. Without both,
    /// there are 200 samples over the run.
    #[serde(default)]
    pub every: Option<f64>,
    /// Cycles between samples of the probes.
    #[serde(default)]
    pub every_cycles: Option<u64>,
    /// Number of evenly spaced snapshots between the first and the last. Default 0.
    #[serde(default)]
    pub snapshots: u32,
    /// Times of further snapshots (s), each taken at the nearest cycle.
    #[serde(default)]
    pub snapshot_times: Vec<f64>,
    /// If true, snapshots of external solvers hold the contacts between grains, as those of our solvers always do.
    /// Default false.
    #[serde(default)]
    pub contacts: bool,
    /// Columns of snapshots in addition to id, material, radius, mass, position and velocity of every grain: any of
    /// `spin`, `force`, `contacts`, `virial` and `mean-virial`. `virial` is the instantaneous V σ of grains, and
    /// `mean-virial` its average over the time since the previous snapshot. Default: `spin`, `force` and `contacts`.
    #[serde(default)]
    pub columns: Option<Vec<Chosen>>,
    /// Significant digits of numbers in snapshots, 1 to 15; all digits by default. Fewer digits make smaller files.
    #[serde(default)]
    pub digits: Option<u8>,
    /// Calculation cycles between the samples of `mean-virial`. A sampled cycle takes about twice as long as another
    /// cycle.
    #[serde(default)]
    pub mean_every_cycles: Option<u64>,
}
