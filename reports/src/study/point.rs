//! Points of a work–precision diagram: error and computing cost.

use grainbench_solver::record::Cost;
use serde::{Deserialize, Serialize};

/// Status of a point, or of a run at one level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PointStatus {
    /// The point has an error and a computing time. The quantities of a level are finite.
    Measured,
    /// The run crashed, or its error is not finite. The point is plotted at the time until the failure.
    #[default]
    Failed,
    /// The run was ended because it would exceed the time budget.
    OverBudget,
    /// The solver cannot represent the scene, or the record lacks the quantity.
    Unsupported,
    /// The program is not installed.
    NotAvailable,
}

impl PointStatus {
    /// Returns the status in words. `unsupported` stands for a solver that cannot represent the scene.
    pub(crate) const fn word(self, unsupported: &'static str) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Failed => "failed",
            Self::OverBudget => "over the budget",
            Self::Unsupported => unsupported,
            Self::NotAvailable => "not installed",
        }
    }
}

/// Operation counts of a run. They do not depend on the machine, and are equal in repeated runs. A count that a program
/// does not report is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Number of steps.
    pub steps: u64,
    /// Number of steps times number of grains, or of material points.
    pub particle_steps: u64,
    /// Number of evaluations of contact laws.
    pub contact_evaluations: Option<u64>,
    /// Number of listed pairs checked for contact.
    pub pair_tests: Option<u64>,
    /// Number of times that the neighbour list was built.
    pub neighbour_builds: Option<u64>,
    /// Number of grid nodes that were updated, over all steps.
    pub node_updates: Option<u64>,
    /// Largest memory of the solver's state (bytes).
    pub bytes: Option<u64>,
}

impl From<&Cost> for Counts {
    fn from(cost: &Cost) -> Self {
        let &Cost {
            steps, particle_steps, contact_evaluations, pair_tests, neighbour_builds, node_updates, bytes, ..
        } = cost;
        Self { steps, particle_steps, contact_evaluations, pair_tests, neighbour_builds, node_updates, bytes }
    }
}

impl Counts {
    /// Returns the name and the value of each count in a fixed order.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, Option<u64>); 7] {
        [
            ("steps", Some(self.steps)),
            ("particle_steps", Some(self.particle_steps)),
            ("contact_evaluations", self.contact_evaluations),
            ("pair_tests", self.pair_tests),
            ("neighbour_builds", self.neighbour_builds),
            ("node_updates", self.node_updates),
            ("bytes", self.bytes),
        ]
    }
}

/// Times of one repetition (s).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Wall-clock time of the stepping loop.
    pub wall: f64,
    /// Processor time of the whole run, including start-up. For another program, the time of a run with one step is
    /// subtracted. For a program that keeps running between runs, it is the wall-clock time of the stepping loop.
    pub cpu: f64,
    /// Wall-clock time of everything except the stepping loop.
    pub start_up: f64,
    /// Processor time of a fixed computation just before the run. It measures the present speed of the machine.
    pub reference: f64,
}

/// Point of a diagram: a setting of a solver, with error and computing cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Case, such as `backspin`.
    pub case: String,
    /// Variant of the scene.
    pub variant: String,
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Resolution in words, such as `dt=.1`.
    pub resolution: String,
    /// Values of further parameters, such as `overlap/R = 1e-3`; empty if there are none.
    pub knobs: String,
    /// Measured quantity.
    pub quantity: String,
    /// Unit of `value` and `expected`.
    pub unit: String,
    /// Status of the point.
    pub standing: PointStatus,
    /// Measured value.
    pub value: Option<f64>,
    /// Exact value.
    pub expected: Option<f64>,
    /// |value − expected|/scale.
    pub error: Option<f64>,
    /// Cause of the error, if a finer resolution does not reduce it further.
    pub floor: Option<String>,
    /// Median wall-clock time of the stepping loop (s). For a failed run, the time until the failure.
    pub wall_seconds: Option<f64>,
    /// Range of the wall-clock times divided by their median; none for a single repetition.
    pub wall_spread: Option<f64>,
    /// Median processor time of the whole run (s).
    pub cpu_seconds: Option<f64>,
    /// Median start-up time (s).
    pub start_up_seconds: Option<f64>,
    /// Timings of all repetitions.
    pub repetitions: Vec<Timing>,
    /// Operation counts of the run.
    pub counts: Counts,
    /// Reason why the point has no error.
    pub detail: Option<String>,
}

impl Point {
    /// Returns a key that identifies the point in all studies.
    #[must_use]
    pub fn key(&self) -> [&str; 6] {
        [&self.case, &self.variant, &self.quantity, &self.solver, &self.resolution, &self.knobs]
    }

    /// Returns the resolution and the further parameters in words.
    #[must_use]
    pub fn setting(&self) -> String {
        if self.knobs.is_empty() { self.resolution.clone() } else { format!("{}, {}", self.resolution, self.knobs) }
    }

    /// Returns the error and the wall-clock time (s); none if one of them is missing.
    pub(crate) fn place(&self) -> Option<(f64, f64)> {
        self.error.zip(self.wall_seconds).filter(|_| self.standing == PointStatus::Measured)
    }
}

/// Points of a target quantity with all solvers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagram {
    /// Name of the case.
    pub case: String,
    /// Variant of the scene.
    pub variant: String,
    /// Target quantity, in words.
    pub quantity: String,
    /// Source of the exact value.
    pub source: String,
    /// One point for each solver and setting.
    pub points: Vec<Point>,
}

/// Change since an earlier study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Point or solver that changed.
    pub what: String,
    /// Description of the change.
    pub how: String,
    /// True if the change is for the worse.
    pub worse: bool,
}
