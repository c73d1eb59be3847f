//! The file `claims.toml`: claims about the scene in the same folder.

use serde::Deserialize;

/// Contents of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClaimsFile {
    /// Title of the case.
    pub(super) title: String,
    /// Claim of the case as a whole.
    #[serde(default)]
    pub(super) claim: String,
    /// Limitations of the test.
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
    /// Variant of the scene.
    pub(super) variant: Option<String>,
    /// Name of the solver.
    #[serde(default = "dem")]
    pub(super) solver: String,
    /// Resolution of the solver.
    #[serde(default)]
    pub(super) resolution: ResolutionParameters,
    /// Tier of the claim: `quick`, or `standard` if its run takes more than a few seconds.
    #[serde(default)]
    pub(super) tier: Tier,
    /// Expression over columns of the record.
    pub(super) value: String,
    /// Time (s) at which the value is read; the end of the run by default.
    pub(super) at: Option<f64>,
    /// Reduction over the samples, instead of the value at one time.
    pub(super) over: Option<SampleReduction>,
    /// Expected value, which may contain the time `t`. A claim has exactly one of `equals`, `follows`, `at_least`,
    /// `at_most` and `between`.
    pub(super) equals: Option<Formula>,
    /// Expected curve in a table.
    pub(super) follows: Option<CourseFile>,
    /// Lower bound.
    pub(super) at_least: Option<Formula>,
    pub(super) at_most: Option<Formula>,
    pub(super) between: Option<[Formula; 2]>,
    /// Scale that divides the difference; the expected value by default.
    pub(super) scale: Option<Formula>,
    /// Equation or law of the expected value. A claim has exactly one of `derived`, `printed` and `measured`.
    pub(super) derived: Option<String>,
    /// Printed work and place in it.
    pub(super) printed: Option<Place>,
    /// Measurement on real grains.
    pub(super) measured: Option<Place>,
    /// Result of an independent program other than the solver.
    pub(super) prototype: Option<Place>,
    /// Largest error that passes, in units of the scale.
    pub(super) allowed: Formula,
    /// Reason for the tolerance.
    pub(super) because: String,
    /// Negative control.
    pub(super) control: ControlEntry,
}

/// Solver of claims that name none.
pub(super) const DEM: &str = "dem";

fn dem() -> String {
    DEM.to_owned()
}

/// Number, or arithmetic over numbers of the scene.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum Formula {
    Number(f64),
    Text(String),
}

/// Tier of a claim.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Tier {
    /// `run` judges the claim.
    #[default]
    Quick,
    /// The tests and `run --levels all` judge the claim.
    Standard,
}

/// Parameters of the resolution.
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

/// Reduction over the samples.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum SampleReduction {
    /// Each sample is compared. The sample with the largest error decides.
    Course,
    /// Largest sample.
    Max,
    /// Smallest sample.
    Min,
    /// Mean over time.
    Mean,
}

/// Curve in a table.
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

/// Place in a work.
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
    /// Keys of the scene with the wrong values.
    pub(super) set: toml::Table,
}
