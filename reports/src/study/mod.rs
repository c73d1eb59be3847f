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
mod text;

use self::effects::Entry;
use self::estimate::SceneCost;
use self::load::Load;
use self::point::{Change, Diagram};
use self::stability::{HardCaseResult, Hardness, Limit};
use self::step::Model;
use crate::section::Provenance;
use grainbench_harness::verdict::Severity;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use store::{STUDY_FILE, kept_text, named_figures, points_of, study_json, write_study};

/// Data of a study. With them, all output files can be written again without a solver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    pub model: Option<Model>,
    /// Cost of a step against the number of grains.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Changes since an earlier study.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Name of the earlier study with which this study was compared.
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
    pub fn new(provenance: Provenance) -> Self {
        Self { provenance, ..Self::default() }
    }

    /// Returns true if the study is unfinished or measured nothing, a value has become worse since an earlier study, or a result
    /// is red.
    #[must_use]
    pub fn is_red(&self) -> bool {
        let is_unfinished = self.provenance.options.iter().any(|words| words.split(": ").next() == Some("unfinished"));
        let mut points = self.diagrams.iter().flat_map(|diagram| &diagram.points);
        let mut quantities = self.scenes.iter().flat_map(|scene| &scene.quantities);
        let holds = |row: &HardCaseResult| matches!(row.standing, Hardness::Holds | Hardness::HoldsAtASmallerStep);
        // In a study of the cost of one scene, limits and effects are additions.
        let measures = if self.scenes.is_empty() {
            points.any(|point| point.error.is_some())
                || self.limits.iter().any(|limit| limit.found.is_some())
                || self.hard.iter().any(holds)
                || !self.ledger.is_empty()
        } else {
            quantities.any(|quantity| !quantity.estimates.is_empty())
        };
        let hard = self.hard.iter().filter_map(HardCaseResult::severity);
        let mut severities = hard.chain(self.ledger.iter().map(|entry| entry.worth.severity()));
        is_unfinished
            || !measures
            || self.changes.iter().any(|change| change.worse)
            || severities.any(|severity| severity == Severity::Red)
    }
}

#[cfg(test)]
mod tests {
    use super::Study;
    use super::effects::EffectResult;
    use super::stability::Hardness;
    use crate::sample;

    /// Each study of the sample is green; one change of each makes it red.
    #[test]
    fn a_study_is_red_for_a_stated_reason() {
        let is_red = |mut study: Study, change: fn(&mut Study)| {
            assert!(!study.is_red());
            change(&mut study);
            study.is_red()
        };
        let mut stable = sample::stability();
        stable.hard.retain(|row| row.standing != Hardness::QuietlyWrong);
        assert!(is_red(stable.clone(), |study| study.provenance.options.push("unfinished: 1 of 2 tasks".to_owned())));
        assert!(is_red(stable, |study| (study.limits, study.hard) = Default::default()));
        let wrong = |solver: &str| {
            let mut study = sample::stability();
            study.hard.truncate(1);
            (study.hard[0].solver, study.hard[0].standing) = (solver.to_owned(), Hardness::QuietlyWrong);
            study.is_red()
        };
        assert!(wrong("dem") && !wrong("lammps"));
        assert!(is_red(sample::effects(), |study| study.ledger[0].worth = EffectResult::NotInert));
        assert!(is_red(sample::costs(), |study| {
            study.diagrams.iter_mut().flat_map(|diagram| &mut diagram.points).for_each(|point| point.error = None);
        }));
    }

    /// Numbers end at the same column, and each row has its scene.
    #[test]
    fn a_study_has_tables_as_text() {
        let mut study = sample::stability();
        study.ledger = sample::effects().ledger;
        insta::assert_snapshot!(study.text());
    }
}
