//! Data of a report. With them, all output files can be written again without a solver.

use grainbench_harness::case::Physics;
use grainbench_harness::figure::Figure;
use grainbench_harness::verdict::{Control, Outcome, Verdict};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

use crate::judged::ExternalResults;
use crate::measured::Measurements;
use crate::stored_figure;

/// Report of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

impl Report {
    /// Returns a report with the given sections. It has no stored results of external solvers and no measurements.
    #[must_use]
    pub fn new(provenance: Provenance, sections: Vec<Section>) -> Self {
        let measured = Measurements::default();
        Self { provenance, sections, judged: Vec::new(), shown: Vec::new(), measured, red_because: Vec::new() }
    }

    /// Returns a report that contains only the results to be shown, and their controls.
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

/// Provenance of a run: version, machine, date and options.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of the harness.
    pub version: String,
    /// Commit of the harness. A mark shows that the working tree was modified.
    pub commit: String,
    /// Date and time of the run.
    pub date: String,
    /// Processor and operating system.
    pub machine: String,
    /// Version of the Rust compiler.
    pub rustc: String,
    /// Options of the run in words.
    pub options: Vec<String>,
    /// Wall-clock time of the run (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub wall_seconds: f64,
}

/// Results of one case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Name of the case, such as `nine-discs`.
    pub name: String,
    /// Title in words.
    pub title: String,
    /// Field of physics; `own` in reports without fields.
    #[serde(default)]
    pub physics: Physics,
    /// Claim of the case in words.
    pub claim: String,
    /// Derivation of the expected values, in Markdown without raw HTML. Formulas are text.
    pub derivation: String,
    /// Limitations of this test, in Markdown.
    pub weak: String,
    /// Figures in the order in which they are shown.
    #[serde(deserialize_with = "stored_figure::figures")]
    pub figures: Vec<Figure>,
    /// Results in the order of the claims.
    pub verdicts: Vec<Verdict>,
    /// Negative controls.
    pub controls: Vec<Control>,
    /// Computing cost of every run.
    pub runs: Vec<RunCost>,
}

/// Computing cost of a run of a claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunCost {
    /// Variant of the scene.
    pub variant: String,
    /// Solver and contact convention, such as `dem:lammps`.
    pub solver: String,
    /// Resolution in words, such as `dt=.1`.
    pub resolution: String,
    /// Number of steps.
    pub steps: u64,
    /// Number of steps times number of grains.
    pub particle_steps: u64,
    /// Number of evaluations of contact laws; absent if the program does not report it.
    pub contact_evaluations: Option<u64>,
    /// Wall-clock time of the stepping loop (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub wall_seconds: f64,
    /// Time step (s).
    #[serde(deserialize_with = "stored_figure::number")]
    pub time_step: f64,
    /// Time step as a fraction of the critical time step; absent if the method has none.
    pub fraction_of_critical: Option<f64>,
}
