//! Contents of `SWEEP.toml`: a design over scene keys, solvers and levels, and the quantities to evaluate.

use grainbench_cases::folder::SampleReduction;
use indexmap::IndexMap;
use serde::Deserialize;
use toml::{Table, Value};

/// A sweep file.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    /// Title of the report.
    pub(super) title: String,
    /// Description in one or two sentences.
    #[serde(default)]
    pub(super) about: String,
    /// `CASE`, `CASE/VARIANT`, or the path of a scene file relative to the sweep file.
    pub(super) scene: String,
    /// Kind of design.
    #[serde(default)]
    pub(super) design: Design,
    /// Number of points of a random design.
    pub(super) points: Option<u32>,
    /// Random seed.
    #[serde(default)]
    pub(super) seed: u64,
    /// Number of runs of each point; above 1 only for timed sweeps.
    #[serde(default = "once")]
    pub(super) repetitions: u32,
    /// True to measure times. Nothing else may then run at the same time.
    #[serde(default)]
    pub(super) timed: bool,
    /// Factors that are varied.
    #[serde(default)]
    pub(super) factors: IndexMap<String, Factor>,
    /// Scene keys that are changed in all points.
    #[serde(default)]
    pub(super) set: Table,
    /// Scene keys that are computed from the factors by arithmetic over factor names.
    #[serde(default)]
    pub(super) formulas: Table,
    /// Solvers with their levels.
    pub(super) solvers: Vec<SolverEntry>,
    /// Claims of the case to evaluate.
    #[serde(default)]
    pub(super) gates: Vec<SweepClaim>,
    /// Further quantities to evaluate.
    #[serde(default)]
    pub(super) record: Vec<QuantityEntry>,
    /// The two factors that are the axes of the map.
    pub(super) map: Option<[String; 2]>,
    /// Curve on the map, for example the limit between two kinds of motion.
    pub(super) line: Option<Line>,
}

/// Curve on the map.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Line {
    /// The second factor of the map as arithmetic over the first.
    pub(super) formula: String,
    /// Label of the curve.
    pub(super) label: String,
}

const fn once() -> u32 {
    1
}

/// Kind of design.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Design {
    /// Full factorial grid: every value of a factor with every value of the other factors.
    #[default]
    Grid,
    /// Independent random points.
    Random,
    /// Latin hypercube: each factor has exactly one random value in each of n equal slices of its range.
    LatinHypercube,
}

/// A factor of the design.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    /// Scene key that takes the value; `None` if only formulas use the factor.
    pub(super) key: Option<String>,
    /// Label in figures.
    pub(super) label: Option<String>,
    /// List of values; exclusive with `from`, `to` and `count`.
    pub(super) values: Option<Vec<Value>>,
    /// Lower end of a range of values.
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    pub(super) count: Option<u32>,
    #[serde(default)]
    pub(super) spacing: Spacing,
}

/// Spacing of values in a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Spacing {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

/// A solver with its levels.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SolverEntry {
    /// Solver name, or the manifest of an external program.
    pub(super) solver: String,
    /// Levels as text.
    pub(super) levels: Vec<String>,
    /// Scene keys that are changed for this solver only.
    #[serde(default)]
    pub(super) set: Table,
    /// Scene keys that are computed from the factors, for this solver only.
    #[serde(default)]
    pub(super) formulas: Table,
}

/// A claim of the case.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepClaim {
    /// Name of the claim's quantity.
    pub(super) quantity: String,
    /// Largest error that passes, if it differs from the tolerance of the claim.
    pub(super) allowed: Option<f64>,
}

/// A quantity of the sweep file.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuantityEntry {
    /// Name of the recorded quantity, in words.
    pub(super) quantity: String,
    /// Unit of `value`, such as `m/s`.
    pub(super) unit: String,
    /// Arithmetic over record columns and numbers of the scene.
    pub(super) value: String,
    /// Time of the sample (s); the end of the run if `None`.
    pub(super) at: Option<f64>,
    /// Reduction over samples, if the value is not a single sample.
    pub(super) over: Option<SampleReduction>,
    /// Expected value: arithmetic over the factors, numbers of the scene and the time `t`.
    pub(super) equals: Option<Formula>,
    /// Scale by which the error is divided; |expected| by default.
    pub(super) scale: Option<Formula>,
    /// Largest error that passes.
    pub(super) allowed: Option<f64>,
}

/// Number, or arithmetic expression as text.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Formula {
    Number(f64),
    Text(String),
}

impl Formula {
    /// Returns the formula as text.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Text(text) => text.clone(),
        }
    }
}
