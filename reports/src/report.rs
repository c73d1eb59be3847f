//! Data of a report. With them, all output files can be written again without a solver.

use grainbench_harness::verdict::{ControlResult, Outcome, Verdict, passes};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

use crate::headline::Headline;
use crate::judged::ExternalResults;
use crate::measured::Measurements;
pub use crate::section::{Provenance, RunCost, Section};

/// Report of one run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version, date, machine and options of the run.
    pub provenance: Provenance,
    /// One section per case, in the order of the registry.
    pub sections: Vec<Section>,
    /// Stored results of external solvers.
    #[serde(default)]
    pub judged: Vec<ExternalResults>,
    /// Outcomes that the page and the terminal show; empty to show all. Files always contain all results.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shown: Vec<Outcome>,
    /// Stored measurements of cost, stability and effects.
    #[serde(default)]
    pub measured: Measurements,
    /// Further reasons why the run is red, such as `interrupted: 3 checks left out`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub red_because: Vec<String>,
}

impl Headline {
    /// Counts the results and controls of a report.
    #[must_use]
    pub fn of_report(report: &Report) -> Self {
        Self::from_results(report.verdicts(), report.controls())
    }
}

impl Report {
    /// Returns a report with the given sections. It has no stored results of external solvers and no measurements.
    #[must_use]
    pub fn new(provenance: Provenance, sections: Vec<Section>) -> Self {
        Self { provenance, sections, ..Self::default() }
    }

    /// Returns true if the results and controls pass, and no other reason makes the report red.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.red_because.is_empty() && passes(self.verdicts().map(|row| row.outcome), self.controls())
    }

    /// Returns the results of all sections.
    pub fn verdicts(&self) -> impl Iterator<Item = &Verdict> + Clone {
        self.sections.iter().flat_map(|section| &section.verdicts)
    }

    /// Returns the negative controls of all sections.
    pub fn controls(&self) -> impl Iterator<Item = &ControlResult> {
        self.sections.iter().flat_map(|section| &section.controls)
    }

    /// Returns a report that contains only the results to be shown, and their controls.
    pub(crate) fn view(&self) -> Cow<'_, Self> {
        if self.shown.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut view = self.clone();
        for section in &mut view.sections {
            section.verdicts.retain(|row| self.shown.contains(&row.outcome));
            let verdicts = &section.verdicts;
            section.controls.retain(|control| {
                verdicts.iter().any(|row| row.variant == control.variant && row.quantity == control.quantity)
            });
        }
        view.sections.retain(|section| !section.verdicts.is_empty());
        Cow::Owned(view)
    }
}
