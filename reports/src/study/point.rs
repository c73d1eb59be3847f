//! One point of a work–precision diagram: an error, and what it cost.

use grainbench_scene::record::Cost;
use serde::{Deserialize, Serialize};

/// How a point ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// It has an error and a time.
    Measured,
    /// The run broke, or its error is not finite: it is drawn where it failed.
    Failed,
    /// The solver cannot express the scene.
    Unsupported,
    /// A program that is not installed.
    NotAvailable,
}

/// What a run did, whatever the machine: equal from run to run. What a program did not count is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Steps taken.
    pub steps: u64,
    /// Steps times grains, or times material points.
    pub particle_steps: u64,
    /// Contact laws evaluated.
    pub contact_evaluations: Option<u64>,
    /// Listed pairs tested for touching.
    pub pair_tests: Option<u64>,
    /// Neighbour lists built.
    pub neighbour_builds: Option<u64>,
    /// Nodes of a grid that took a step, in all steps.
    pub node_updates: Option<u64>,
    /// Memory that the state takes up at its largest (B).
    pub bytes: Option<u64>,
}

impl From<&Cost> for Counts {
    fn from(cost: &Cost) -> Self {
        Self {
            steps: cost.steps,
            particle_steps: cost.particle_steps,
            contact_evaluations: cost.contact_evaluations,
            pair_tests: cost.pair_tests,
            neighbour_builds: cost.neighbour_builds,
            node_updates: cost.node_updates,
            bytes: cost.bytes,
        }
    }
}

impl Counts {
    /// Names and values, in one order.
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
    /// Processor time of the whole run, start-up included; of a program, that of its process less that of a run of one
    /// step.
    pub cpu: f64,
    /// Wall-clock time of everything but the stepping loop.
    pub start_up: f64,
    /// Processor time of a fixed piece of arithmetic, timed just before: how fast the machine was at that moment.
    pub reference: f64,
}

/// One point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Case, such as `backspin`.
    pub case: String,
    /// Variant of its scene.
    pub variant: String,
    /// Solver.
    pub solver: String,
    /// Resolution in words, such as `dt=.1`.
    pub resolution: String,
    /// The other knobs in words, such as `overlap/R = 1e-3`; empty where there are none.
    pub knobs: String,
    /// What is measured.
    pub quantity: String,
    /// Unit of `value` and `expected`.
    pub unit: String,
    /// How it ended.
    pub standing: Standing,
    /// What came out.
    pub value: Option<f64>,
    /// The exact answer.
    pub expected: Option<f64>,
    /// |value − expected|/scale.
    pub error: Option<f64>,
    /// What the error is made of, where a finer resolution no longer makes it smaller.
    pub floor: Option<String>,
    /// Median wall-clock time of the stepping loop (s); of a run that failed, until then.
    pub wall_seconds: Option<f64>,
    /// Largest less smallest of the repetitions over the median; none of one repetition.
    pub wall_spread: Option<f64>,
    /// Median processor time of the run (s).
    pub cpu_seconds: Option<f64>,
    /// Median time of start-up (s).
    pub start_up_seconds: Option<f64>,
    /// Every repetition.
    pub repetitions: Vec<Timing>,
    /// What it did.
    pub counts: Counts,
    /// Why it has no error.
    pub detail: Option<String>,
}

impl Point {
    /// What tells a point from others: the same in two sessions.
    #[must_use]
    pub fn key(&self) -> [&str; 6] {
        [&self.case, &self.variant, &self.quantity, &self.solver, &self.resolution, &self.knobs]
    }

    /// Resolution and other knobs in words.
    #[must_use]
    pub fn setting(&self) -> String {
        if self.knobs.is_empty() { self.resolution.clone() } else { format!("{}, {}", self.resolution, self.knobs) }
    }

    /// Error and wall-clock time, of a point that has both.
    #[must_use]
    pub fn place(&self) -> Option<(f64, f64)> {
        match (self.standing, self.error, self.wall_seconds) {
            (Standing::Measured, Some(error), Some(wall)) => Some((error, wall)),
            _ => None,
        }
    }
}

/// The points of one quantity, over all solvers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagram {
    /// Case.
    pub case: String,
    /// Variant of its scene.
    pub variant: String,
    /// Quantity.
    pub quantity: String,
    /// What its exact answer is taken from.
    pub source: String,
    /// The points.
    pub points: Vec<Point>,
}

/// Difference between two sessions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// What changed: a point or a solver.
    pub what: String,
    /// How, in words.
    pub how: String,
    /// Whether it counts as worse.
    pub worse: bool,
}
