//! `claims.toml`: what is claimed of the scene beside it.

use serde::Deserialize;

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClaimsFile {
    /// Title of the case.
    pub(super) title: String,
    /// What is claimed as a whole.
    #[serde(default)]
    pub(super) claim: String,
    /// Where the test is weak.
    #[serde(default)]
    pub(super) weakness: String,
    /// The claims.
    pub(super) claims: Vec<Claimed>,
}

/// One claim.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Claimed {
    /// What is measured, in words.
    pub(super) quantity: String,
    /// Its unit.
    pub(super) unit: String,
    /// The variant of the scene.
    pub(super) variant: Option<String>,
    /// Whose row it is.
    #[serde(default = "dem")]
    pub(super) solver: String,
    /// How finely it works.
    #[serde(default)]
    pub(super) resolution: Knobs,
    /// Over columns of the record.
    pub(super) value: String,
    /// The moment at which it is read (s); the end where none is named.
    pub(super) at: Option<f64>,
    /// How samples are read, where it is not one of them.
    pub(super) over: Option<Over>,
    /// What is expected: one of these. A value, which may contain the time `t`,
    pub(super) equals: Option<Formula>,
    /// a course in a table,
    pub(super) follows: Option<CourseFile>,
    /// or a bound.
    pub(super) at_least: Option<Formula>,
    pub(super) at_most: Option<Formula>,
    pub(super) between: Option<[Formula; 2]>,
    /// What the difference is divided by; what is expected where nothing is said.
    pub(super) scale: Option<Formula>,
    /// Where what is expected comes from: one of these. An equation or a law, in words,
    pub(super) derived: Option<String>,
    /// a work and the place in it,
    pub(super) printed: Option<Place>,
    /// or a measurement on real grains.
    pub(super) measured: Option<Place>,
    /// How far it may be off, in units of the scale.
    pub(super) allowed: Formula,
    /// Why.
    pub(super) because: String,
    /// What it must refuse.
    pub(super) control: Controlled,
}

/// The solver of claims that name none.
pub(super) const DEM: &str = "dem";

fn dem() -> String {
    DEM.to_owned()
}

/// A number, or arithmetic over the scene.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum Formula {
    Number(f64),
    Text(String),
}

/// How finely a solver works.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Knobs {
    pub(super) time_step_fraction: Option<f64>,
    pub(super) time_step: Option<f64>,
    pub(super) cells: Option<f64>,
    pub(super) points: Option<u32>,
    pub(super) courant: Option<f64>,
    pub(super) substeps: Option<u32>,
    pub(super) iterations: Option<u32>,
}

/// How samples are read.
#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// Each of them: the worst counts.
    Course,
    /// The largest.
    Max,
    /// The smallest.
    Min,
    /// Their mean in time.
    Mean,
}

/// A course in a table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CourseFile {
    /// The file, beside the claims.
    pub(super) file: String,
    /// The column of times (s).
    pub(super) time: String,
    /// The column of what is expected.
    pub(super) value: String,
}

/// A place in a work.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    /// Author, year, title.
    pub(super) work: String,
    /// Where in it, and what stands there.
    pub(super) place: String,
}

/// Wrong physics that the claim must refuse.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Controlled {
    /// What is wrong, in words.
    pub(super) name: String,
    /// Keys of the scene with the wrong values.
    pub(super) set: toml::Table,
}
