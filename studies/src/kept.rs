//! What `cost --keep` and `stability --keep` left in this crate's folder.

use std::path::{Path, PathBuf};

/// What `cost --keep` left.
pub const COST: &str = include_str!("../kept/cost.json");
/// What `stability --keep` left.
pub const STABILITY: &str = include_str!("../kept/stability.json");

/// Where a study is kept.
#[must_use]
pub fn place(study: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("kept").join(format!("{study}.json"))
}
