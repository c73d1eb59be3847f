//! Reports of the three studies: cost of accuracy, stability and effects.

pub mod cost;
pub mod effects;
pub mod estimate;
pub mod load;
mod page;
pub mod point;
pub mod stability;
pub(crate) mod stability_page;
pub mod step;
mod store;

use self::effects::Entry;
use self::estimate::SceneCost;
use self::load::Load;
use self::point::{Change, Diagram};
use self::stability::{HardCaseResult, Limit};
use self::step::Model;
use crate::provenance::Provenance;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use store::{STUDY_FILE, kept_text, load_study, named_figures, points_of, study_json, write_study};

/// Data of a study. With them, all output files can be written again without a solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Version, date, machine and options of the measurement.
    pub provenance: Provenance,
    /// Cost of accuracy, one diagram per quantity.
    #[serde(default)]
    pub diagrams: Vec<Diagram>,
    /// Cost of accuracy of scenes without an exact solution.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scenes: Vec<SceneCost>,
    /// Cost of the parts of a step.
    #[serde(default)]
    pub model: Option<Model>,
    /// Cost of a step against the number of grains.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Changes since an earlier study.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Name of the earlier study with which this study was compared.
    #[serde(default)]
    pub against: Option<String>,
    /// Largest stable time steps.
    #[serde(default)]
    pub limits: Vec<Limit>,
    /// One result for each hard case and solver.
    #[serde(default)]
    pub hard: Vec<HardCaseResult>,
    /// One entry for each scene and effect.
    #[serde(default)]
    pub ledger: Vec<Entry>,
    /// Hashes of the solvers' sources at the time of the measurement, by solver name.
    #[serde(default)]
    pub sources: BTreeMap<String, String>,
}

impl Study {
    /// Returns an empty study.
    #[must_use]
    pub const fn new(provenance: Provenance) -> Self {
        Self {
            provenance,
            diagrams: Vec::new(),
            scenes: Vec::new(),
            model: None,
            loads: Vec::new(),
            changes: Vec::new(),
            against: None,
            limits: Vec::new(),
            hard: Vec::new(),
            ledger: Vec::new(),
            sources: BTreeMap::new(),
        }
    }
}
