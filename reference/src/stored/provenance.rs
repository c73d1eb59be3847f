//! Provenance of a stored run.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Content of `provenance.toml` of a stored run.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Program that made the run.
    pub program: String,
    /// Line with which the program prints its version.
    pub version: String,
    /// Day on which the run was made, YYYY-MM-DD.
    pub date: String,
    /// Description of the run.
    pub title: String,
    /// BLAKE3 hash of all data of the scene that the run depends on. See [`crate::stored::scene_hash`].
    pub scene: String,
    /// Last stored step up to which the run is predictable, or `None` if it is predictable to the end.
    ///
    /// A perturbed run in the same program has one position changed by one unit in the last place. Up to this step,
    /// it differs by at most a billionth of the scale of each column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predictable_steps: Option<u64>,
    /// Shell commands that repeat the run in its folder, and the command that creates all files again.
    pub commands: Vec<String>,
    /// BLAKE3 hash of every file of the run, by name.
    pub blake3: BTreeMap<String, String>,
}
