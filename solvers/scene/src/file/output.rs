//! Keys of `output`: intervals of samples and snapshots, and the contents of snapshots.

use crate::columns::Chosen;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Times and contents of samples and snapshots.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OutputSpec {
    /// Time between samples of the probes (s), rounded to whole cycles. Give at most one of `every` and `every_cycles`.
    /// Default: 200 samples over the run.
    pub every: Option<f64>,
    /// Number of calculation cycles (time steps) between samples of the probes.
    pub every_cycles: Option<u64>,
    /// Number of evenly spaced snapshots between the first one (start of the run) and the last one (end of the run).
    /// Default 0.
    pub snapshots: u32,
    /// Times of further snapshots (s), each taken at the nearest cycle.
    pub snapshot_times: Vec<f64>,
    /// If true, external solvers also write the contacts between grains to snapshots. Our solvers do so without this
    /// key, unless `columns` omits contacts. Default false.
    pub contacts: bool,
    /// Optional contents of snapshots: any of `spin`, `force`, `contacts`, `virial` and `mean-virial`. Snapshots always
    /// contain id, material, radius, mass, position and velocity of every grain. `virial` is the product V σ of volume
    /// and mean stress of each grain (J) at the time of the snapshot. `mean-virial` is the average of V σ over the time
    /// since the previous snapshot. Default: `spin`, `force` and `contacts`.
    pub columns: Option<Vec<Chosen>>,
    /// Number of significant digits in snapshots, from 1 to 15. Radii and masses always have all digits. Fewer digits
    /// make smaller files. Default: all digits.
    pub digits: Option<u8>,
    /// Number of calculation cycles between the samples of `mean-virial`. A cycle with a sample takes about twice as
    /// long as a cycle without one. Default 1.
    pub mean_every_cycles: Option<u64>,
}
