//! Numerical uncertainties of claims. Each is estimated once from runs at three resolutions and stored with its
//! provenance. The command `grainbench reference uncertainty` computes them.

use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::uncertainty::Estimate;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::OnceLock;

/// Stored estimates of a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StoredEstimates {
    /// Name and version of the program that made the estimates.
    pub program: String,
    /// Commit that the program was built from; empty for old estimates.
    #[serde(default)]
    pub commit: String,
    /// Date (YYYY-MM-DD).
    pub date: String,
    /// Rule by which the estimates are computed from the three resolutions.
    pub rule: String,
    /// One estimate for each claim with an estimated tolerance.
    #[serde(default)]
    pub estimate: Vec<Estimate>,
}

/// Returns the path of the file with the estimates of a case.
#[must_use]
pub fn file(case: &str) -> PathBuf {
    grainbench_reference::data::reference().join("uncertainty").join(format!("{case}.toml"))
}

// Estimates of the build by case. They are small, and claims need them where the data are not installed.
include!(concat!(env!("OUT_DIR"), "/estimates.rs"));

/// Loads the stored estimates of a case; empty if there are none or the file is unreadable.
fn load(case: &str) -> StoredEstimates {
    let built = || ESTIMATES.iter().find(|(name, _)| *name == case).map(|(_, text)| (*text).to_owned());
    let text = std::fs::read_to_string(file(case)).ok().or_else(built).unwrap_or_default();
    toml::from_str(&text).unwrap_or_default()
}

/// Returns the stored estimate of a claim; `None` if none is stored or the claim reads more than one run.
#[must_use]
pub fn find(case: &Case, claim: &Claim) -> Option<Estimate> {
    static CASES: OnceLock<BTreeMap<&'static str, StoredEstimates>> = OnceLock::new();
    let all = CASES.get_or_init(|| crate::registry::CASES.iter().map(|case| (case.name, load(case.name))).collect());
    let [run] = &claim.runs[..] else { return None };
    let (scene, resolution) = (run.scene_words(), run.resolution.to_string());
    let is_it = |estimate: &&Estimate| {
        estimate.variant == scene
            && estimate.solver == run.solver
            && estimate.resolution == resolution
            && estimate.quantity == claim.quantity
    };
    all.get(case.name)?.estimate.iter().find(is_it).cloned()
}
