//! Where a stored run comes from.

use std::collections::BTreeMap;

use serde::Deserialize;

/// What `provenance.toml` of a stored run says.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The program that made the run.
    pub program: String,
    /// The line by which that program names its version.
    pub version: String,
    /// The day on which the run was made, YYYY-MM-DD.
    pub date: String,
    /// The units of every number of the run.
    pub units: String,
    /// What to type, in the run's folder, to have the run and its twin again.
    pub commands: Vec<String>,
    /// The BLAKE3 hash of every file of the run, by name.
    pub blake3: BTreeMap<String, String>,
}
