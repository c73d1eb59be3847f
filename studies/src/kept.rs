//! Stored studies of `cost --keep` and `stability --keep` in this crate's folder.

use std::path::{Path, PathBuf};

/// Stored result of `cost --keep`.
pub const COST: &str = include_str!("../kept/cost.json");
/// Stored result of `stability --keep`.
pub const STABILITY: &str = include_str!("../kept/stability.json");

/// Returns the path of a stored study.
#[must_use]
pub fn place(study: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("kept").join(format!("{study}.json"))
}
