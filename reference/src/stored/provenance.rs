//! Provenance of a stored run.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Content of `provenance.toml` of a stored run.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Program that made the run.
    pub program: String,
    /// Line in which the program prints its version.
    pub version: String,
    /// Day of the run (YYYY-MM-DD).
    pub date: String,
    /// Short description of the run.
    pub title: String,
    /// BLAKE3 hash of all data of the scene that affect the run. See [`crate::stored::scene_hash`].
    pub scene: String,
    /// Last stored step up to which the run is predictable; `None` if it is predictable until the end.
    ///
    /// A perturbed run starts with one position changed by one unit in the last place. Up to this step, the perturbed
    /// run differs from the stored run by at most 1e-9 of the scale of each column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predictable_steps: Option<u64>,
    /// Shell commands that repeat the run in its folder, and the command that creates all files of the stored run.
    pub commands: Vec<String>,
    /// BLAKE3 hashes of all files of the run, by name.
    pub blake3: BTreeMap<String, String>,
}
