//! Stored results of the three studies, in the folder `kept` of this crate. The option `--update-stored` writes them.

use std::path::{Path, PathBuf};

/// Stored result of `cost --update-stored`.
pub const COST: &str = include_str!("../kept/cost.json");
/// Stored result of `stability --update-stored`.
pub const STABILITY: &str = include_str!("../kept/stability.json");

/// Stored result of `effects --update-stored`.
pub const EFFECTS: &str = include_str!("../kept/effects.json");

/// Returns the path of the stored result of a study.
#[must_use]
pub fn place(study: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("kept").join(format!("{study}.json"))
}
