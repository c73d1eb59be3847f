//! Numerical uncertainties of claims, estimated once over three levels of resolution and stored with provenance:
//! `grainbench reference uncertainty` makes them.

use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::uncertainty::Estimate;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The estimates of a case, as they are stored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stored {
    /// The program that made them, with its version.
    pub program: String,
    /// The commit that it was built from; unknown of estimates from before it was told.
    #[serde(default)]
    pub commit: String,
    /// When (YYYY-MM-DD).
    pub date: String,
    /// How.
    pub rule: String,
    /// The estimates.
    #[serde(default)]
    pub estimate: Vec<Estimate>,
}

/// Where the estimates of a case are.
#[must_use]
pub fn file(case: &str) -> PathBuf {
    Path::new(grainbench_reference::FOLDER).join("uncertainty").join(format!("{case}.toml"))
}

/// What is stored of a case; nothing where there is no file, or none that can be read.
fn load(case: &str) -> Stored {
    let text = std::fs::read_to_string(file(case)).unwrap_or_default();
    toml::from_str(&text).unwrap_or_default()
}

/// What is stored of a claim.
#[must_use]
pub fn find(case: &Case, claim: &Claim) -> Option<Estimate> {
    static CASES: OnceLock<BTreeMap<&'static str, Stored>> = OnceLock::new();
    let all = CASES.get_or_init(|| crate::registry::CASES.iter().map(|case| (case.name, load(case.name))).collect());
    let [run] = &claim.runs[..] else { return None };
    let (scene, resolution) = (run.scene_words(), run.resolution.to_string());
    let is_it = |of: &&Estimate| {
        of.variant == scene && of.solver == run.solver && of.resolution == resolution && of.quantity == claim.quantity
    };
    all.get(case.name)?.estimate.iter().find(is_it).cloned()
}
