//! Where a stored run comes from.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What `provenance.toml` of a stored run says.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The program that made the run.
    pub program: String,
    /// The line by which that program names its version.
    pub version: String,
    /// The day on which the run was made, YYYY-MM-DD.
    pub date: String,
    /// What was run, in words.
    pub title: String,
    /// BLAKE3 hash of everything in the scene that the run depends on; see [`crate::stored::scene_hash`].
    pub scene: String,
    /// The last stored step up to which the run can be predicted: a perturbed run in the same program, with one position
    /// moved by one unit in the last place, is within a billionth of it, in units of what moves. None where it is so to
    /// the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predictable_steps: Option<u64>,
    /// What to type, in the run's folder, to have the run again; and what makes all of this again.
    pub commands: Vec<String>,
    /// The BLAKE3 hash of every file of the run, by name.
    pub blake3: BTreeMap<String, String>,
}
