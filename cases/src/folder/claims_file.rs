//! The file `claims.toml`: claims about the scene in the same folder.

use grainbench_harness::case::Physics;
use serde::Deserialize;

/// Contents of `claims.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClaimsFile {
    /// Title of the case.
    pub(super) title: String,
    /// Field of physics under which the report counts the case; `own` by default.
    #[serde(default)]
    pub(super) physics: Physics,
    /// Statement that the case tests as a whole; empty by default.
    #[serde(default)]
    pub(super) claim: String,
    /// Limitations of the test; empty by default.
    #[serde(default)]
    pub(super) weakness: String,
    /// Tables `[[claims]]` of the file.
    pub(super) claims: Vec<ClaimEntry>,
}

/// Table `[[claims]]`: value, expectation, source, tolerance and control of one claim.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClaimEntry {
    /// Measured quantity.
    pub(super) quantity: String,
    /// Unit of the quantity.
    pub(super) unit: String,
    /// Variant of the scene; the scene without a variant by default.
    pub(super) variant: Option<String>,
    /// Name of the solver, or a list of names with one claim for each; `dem` by default.
    #[serde(default)]
    pub(super) solver: SolverNames,
    /// Parameters of the resolution; defaults for parameters that are not given.
    #[serde(default)]
    pub(super) resolution: ResolutionParameters,
    /// Tier of the claim: `quick`, or `standard` if its run takes more than a few seconds.
    #[serde(default)]
    pub(super) tier: Tier,
    /// Arithmetic expression over columns of the record and numbers of the scene, with at least one column.
    pub(super) value: String,
    /// Time (s) at which the value is read; the end of the run by default.
    pub(super) at: Option<f64>,
    /// Reduction over the samples, instead of the value at one time.
    pub(super) over: Option<SampleReduction>,
    /// Expected value, which may contain the time `t`. A claim has exactly one of `equals`, `follows`, `at_least`,
    /// `at_most` and `between`.
    pub(super) equals: Option<Formula>,
    /// Expected curve, given as a table in a file.
    pub(super) follows: Option<CourseFile>,
    /// Lower bound of the value.
    pub(super) at_least: Option<Formula>,
    /// Upper bound of the value.
    pub(super) at_most: Option<Formula>,
    /// Lower and upper bound of the value.
    pub(super) between: Option<[Formula; 2]>,
    /// Scale that divides the error. Default: the absolute expected value; for a curve, its largest absolute value.
    pub(super) scale: Option<Formula>,
    /// Equation or law from which the expected value is derived. A claim has exactly one of `derived`, `printed`,
    /// `measured` and `prototype`.
    pub(super) derived: Option<String>,
    /// Publication that prints the expected value, and the place in it.
    pub(super) printed: Option<Place>,
    /// Publication of a measurement on real grains, and the place in it.
    pub(super) measured: Option<Place>,
    /// Independent program, other than the solver, that gives the expected value, and the place in its results.
    pub(super) prototype: Option<Place>,
    /// Largest error that passes, in units of the scale.
    pub(super) allowed: Formula,
    /// Reason for the tolerance.
    pub(super) because: String,
    /// Negative control.
    pub(super) control: ControlEntry,
}

/// Solver of claims that do not name one.
pub(super) const DEM: &str = "dem";

/// Names of the solvers for which a claim is made.
#[derive(Deserialize)]
#[serde(untagged, expecting = "another value, expected the name of a solver or a list of names")]
pub(super) enum SolverNames {
    One(String),
    Several(Vec<String>),
}

impl Default for SolverNames {
    fn default() -> Self {
        Self::One(DEM.to_owned())
    }
}

impl SolverNames {
    /// Returns the names as a list.
    pub(super) fn list(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names,
        }
    }
}

/// Number, or arithmetic expression over numbers of the scene. In `equals` the expression may contain the time `t`.
#[derive(Clone, Deserialize)]
#[serde(untagged, expecting = "another value, expected a number or an expression")]
pub enum Formula {
    /// Number.
    Number(f64),
    /// Arithmetic expression.
    Text(String),
}

/// Tier of a claim.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Tier {
    /// The command `run` evaluates the claim without options.
    #[default]
    Quick,
    /// Only the tests and `run --levels all` evaluate the claim.
    Standard,
}

/// Parameters of the resolution. Each method accepts only its own: DEM `time_step_fraction` or `time_step` (s), MPM
/// `cells`, `points` and `courant`, rigid bodies `substeps` and `iterations`.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct ResolutionParameters {
    pub(super) time_step_fraction: Option<f64>,
    pub(super) time_step: Option<f64>,
    pub(super) cells: Option<f64>,
    pub(super) points: Option<u32>,
    pub(super) courant: Option<f64>,
    pub(super) substeps: Option<u32>,
    pub(super) iterations: Option<u32>,
}

/// Reduction of the samples of a run to one number or one comparison.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum SampleReduction {
    /// Each sample is compared. The sample with the largest error decides.
    Course,
    /// Largest sample.
    Max,
    /// Smallest sample.
    Min,
    /// Time average.
    Mean,
}

/// Expected curve in a table, a file in the folder of the claims.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CourseFile {
    /// File name, in the folder of the claims.
    pub(super) file: String,
    /// Name of the column of times (s).
    pub(super) time: String,
    /// Name of the column of expected values.
    pub(super) value: String,
}

/// Cited statement: a work and a place in the work.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    /// Author, year, title.
    pub(super) work: String,
    /// Place in the work, with the statement found there.
    pub(super) place: String,
}

/// Negative control: wrong physics for which the claim must fail.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ControlEntry {
    /// Description of the wrong physics.
    pub(super) name: String,
    /// Keys of the scene file and their wrong values.
    pub(super) set: toml::Table,
}
