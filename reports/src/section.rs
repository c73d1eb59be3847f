//! Results of one case: claims, controls, figures and costs. Origin of results.

use grainbench_harness::case::Physics;
use grainbench_harness::figure::{Figure, number};
use grainbench_harness::verdict::{ControlResult, Verdict};
use serde::{Deserialize, Serialize};

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
    pub figures: Vec<Figure>,
    /// Error message if the figures could not be drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub omitted: Option<String>,
    /// Results in the order of the claims.
    pub verdicts: Vec<Verdict>,
    /// Negative controls.
    pub controls: Vec<ControlResult>,
    /// Computing cost of every run.
    pub runs: Vec<RunCost>,
}

impl Section {
    /// Adds the results of a task of the same case.
    pub fn add(&mut self, task: Self) {
        self.figures.extend(task.figures);
        self.omitted = self.omitted.take().or(task.omitted);
        self.verdicts.extend(task.verdicts);
        self.controls.extend(task.controls);
        self.runs.extend(task.runs);
    }

    /// Returns the quantity and the line of each red result, and of each negative control that did not fail as required.
    pub(crate) fn failures(
        &self,
        verdict: fn(&Verdict) -> String,
        control: fn(&ControlResult) -> String,
    ) -> impl Iterator<Item = (&str, String)> {
        let red = self.verdicts.iter().filter(|row| row.outcome.is_red());
        let green = self.controls.iter().filter(|control| !control.turned_red);
        let red = red.map(move |row| (row.quantity.as_str(), verdict(row)));
        red.chain(green.map(move |row| (row.quantity.as_str(), control(row))))
    }

    /// Sorts the runs by their keys, keeps each run once and removes the keys.
    pub fn finish_runs(&mut self) {
        self.runs.sort_by(|a, b| a.key.cmp(&b.key));
        self.runs.dedup_by(|later, first| later.key == first.key);
        self.runs.iter_mut().for_each(|run| run.key.clear());
    }
}

/// Computing cost of a run of a claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunCost {
    /// Key of the run among the runs of its case; empty in a finished report.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub key: String,
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
    #[serde(deserialize_with = "number")]
    pub wall_seconds: f64,
    /// Time step (s).
    #[serde(deserialize_with = "number")]
    pub time_step: f64,
    /// Time step as a fraction of the critical time step; absent if the method has none.
    pub fraction_of_critical: Option<f64>,
}

/// Provenance of a run: version, machine, date and options.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    #[serde(deserialize_with = "number")]
    pub wall_seconds: f64,
}

impl Provenance {
    /// Returns the date of the run, without the time.
    #[must_use]
    pub fn day(&self) -> &str {
        self.date.split(' ').next().unwrap_or_default()
    }
}
