//! Everything a report is made from: enough to redo every output without a solver.

use grainbench_harness::figure::Figure;
use grainbench_harness::verdict::{Control, Outcome, Verdict};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

use crate::judged::Judged;
use crate::measured::Measurements;
use crate::stored_figure;

/// A whole run of the harness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// What ran, where and when.
    pub provenance: Provenance,
    /// One section a case, in the order of the registry.
    pub sections: Vec<Section>,
    /// Programs that were judged before, by their manifests.
    #[serde(default)]
    pub judged: Vec<Judged>,
    /// Outcomes that the page and the terminal show; all where none is named. Every file holds all results.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shown: Vec<Outcome>,
    /// What accuracy costs and what stays stable, as it was measured before.
    #[serde(default)]
    pub measured: Measurements,
}

impl Report {
    /// The sections with the results that are shown and their controls.
    #[must_use]
    pub fn view(&self) -> Cow<'_, Self> {
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

/// What ran, where and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of the harness.
    pub version: String,
    /// Commit of the harness, with a mark when the tree was changed.
    pub commit: String,
    /// Date and time.
    pub date: String,
    /// Processor and operating system.
    pub machine: String,
    /// Compiler.
    pub rustc: String,
    /// Options of the run in words.
    pub options: Vec<String>,
    /// Wall-clock time of the whole run (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub wall_seconds: f64,
}

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Name of the case, such as `nine-discs`.
    pub name: String,
    /// Title in words.
    pub title: String,
    /// What the case claims, in one paragraph.
    pub claim: String,
    /// Derivation of the expected answer: Markdown without raw HTML, formulas as text.
    pub derivation: String,
    /// Where this test is weak: Markdown.
    pub weak: String,
    /// Figures in the order in which they are shown.
    #[serde(deserialize_with = "stored_figure::figures")]
    pub figures: Vec<Figure>,
    /// Rows in the order of the gates.
    pub verdicts: Vec<Verdict>,
    /// Negative controls.
    pub controls: Vec<Control>,
    /// What every run cost.
    pub runs: Vec<RunCost>,
}

/// What one run cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunCost {
    /// Variant of the case's scene.
    pub variant: String,
    /// Solver and convention.
    pub solver: String,
    /// Resolution level.
    pub resolution: String,
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains.
    pub particle_steps: u64,
    /// Contact laws evaluated; absent of a program, which does not tell.
    pub contact_evaluations: Option<u64>,
    /// Wall-clock time of the stepping loop (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub wall_seconds: f64,
    /// Time step (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub time_step: f64,
    /// Time step over the critical one; absent where the method has none.
    pub fraction_of_critical: Option<f64>,
}
