//! Reports of the three studies: what accuracy costs, what stays stable, what each effect is worth.

pub mod cost;
pub mod effects;
pub mod load;
mod page;
pub mod point;
pub mod stability;
pub mod step;
mod store;

use self::effects::Entry;
use self::load::Load;
use self::point::{Change, Diagram};
use self::stability::{Hard, Limit};
use self::step::Model;
use crate::report::Provenance;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use store::{STUDY_FILE, kept_text, load_study, points_of, study_json, write_study};

/// What a study left: enough to redo every output without a solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// What ran, where and when.
    pub provenance: Provenance,
    /// What accuracy costs, quantity by quantity.
    #[serde(default)]
    pub diagrams: Vec<Diagram>,
    /// What a step costs, piece by piece.
    #[serde(default)]
    pub model: Option<Model>,
    /// What a step costs of few grains and of many.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// What changed since another session.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// The session that this one was compared with.
    #[serde(default)]
    pub against: Option<String>,
    /// Largest stable steps.
    #[serde(default)]
    pub limits: Vec<Limit>,
    /// Hard cases.
    #[serde(default)]
    pub hard: Vec<Hard>,
    /// The ledger of effects.
    #[serde(default)]
    pub ledger: Vec<Entry>,
    /// Hashes of the sources of the solvers that were measured, by their names.
    #[serde(default)]
    pub sources: BTreeMap<String, String>,
}

impl Study {
    /// An empty one.
    #[must_use]
    pub const fn new(provenance: Provenance) -> Self {
        Self {
            provenance,
            diagrams: Vec::new(),
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
