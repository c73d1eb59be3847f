//! Contents of `SWEEP.toml`: a design over scene keys, solvers and levels, and the quantities to evaluate.

use grainbench_cases::folder::{Formula, SampleReduction};
use indexmap::IndexMap;
use serde::Deserialize;
use toml::{Table, Value};

/// Sweep file.
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
    /// Number of points of a random or Latin hypercube design; absent for a grid.
    pub(super) points: Option<u32>,
    /// Seed of the random numbers of the design.
    #[serde(default)]
    pub(super) seed: u64,
    /// Number of runs of each point with each solver and level; above 1 only for timed sweeps.
    #[serde(default = "once")]
    pub(super) repetitions: u32,
    /// True to measure times. No other program may then run at the same time.
    #[serde(default)]
    pub(super) timed: bool,
    /// Factors that are varied.
    #[serde(default)]
    pub(super) factors: IndexMap<String, Factor>,
    /// Scene keys with values that are the same at all points.
    #[serde(default)]
    pub(super) set: Table,
    /// Scene keys whose values are arithmetic expressions of the factors.
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
    /// Factors on the horizontal and the vertical axis of the map, a figure of the report.
    pub(super) map: Option<[String; 2]>,
    /// Curve on the map, such as the limit between two types of motion.
    pub(super) line: Option<Line>,
}

/// Curve on the map.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Line {
    /// Arithmetic expression that gives the second factor of the map as a function of the first factor.
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
    /// Full factorial grid: all combinations of the values of the factors.
    #[default]
    Grid,
    /// Independent random values of all factors.
    Random,
    /// Latin hypercube: the range of each factor is divided into as many equal slices as there are points. Each slice
    /// contains one random value.
    LatinHypercube,
}

/// Factor of the design.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Factor {
    /// Scene key that takes the value; `None` if only formulas use the factor.
    pub(super) key: Option<String>,
    /// Label in figures; `None` for the name of the factor.
    pub(super) label: Option<String>,
    /// List of values; exclusive with `from`, `to` and `count`.
    pub(super) values: Option<Vec<Value>>,
    /// Lower end of a range of values.
    pub(super) from: Option<f64>,
    /// Upper end of a range of values.
    pub(super) to: Option<f64>,
    /// Number of values in a range, at least 2; only for a grid.
    pub(super) count: Option<u32>,
    /// Spacing of the values in a range.
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

/// Solver with its resolution levels.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SolverEntry {
    /// Solver name, or the path of the manifest of an external program.
    pub(super) solver: String,
    /// Resolution levels as text, such as `dt=.1`.
    pub(super) levels: Vec<String>,
    /// Scene keys with values for this solver only.
    #[serde(default)]
    pub(super) set: Table,
    /// Scene keys whose values are arithmetic expressions of the factors, for this solver only.
    #[serde(default)]
    pub(super) formulas: Table,
}

/// Claim of the case that the sweep evaluates.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepClaim {
    /// Quantity by which the claim is found in the case.
    pub(super) quantity: String,
    /// Largest error that passes; `None` for the tolerance of the claim.
    pub(super) allowed: Option<f64>,
}

/// Quantity that the sweep file defines.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuantityEntry {
    /// Name of the quantity in the report.
    pub(super) quantity: String,
    pub(super) unit: String,
    /// Arithmetic expression of record columns and numbers of the scene.
    pub(super) value: String,
    /// Time of the sample (s); `None` for the end of the run.
    pub(super) at: Option<f64>,
    /// Reduction of all samples to one value; `None` for a single sample.
    pub(super) over: Option<SampleReduction>,
    /// Expected value as an expression of the factors, numbers of the scene and the time `t` (s).
    pub(super) equals: Option<Formula>,
    /// Scale by which the error is divided; `None` for the absolute expected value.
    pub(super) scale: Option<Formula>,
    /// Largest relative error (error divided by the scale) that passes; required with `equals`.
    pub(super) allowed: Option<f64>,
}
