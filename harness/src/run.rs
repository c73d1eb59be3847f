//! Runs that a claim reads: scene, solver and resolution.

use crate::reading::{Reading, Table};
use grainbench_scene::scene::Scene;
use grainbench_solver::record::{Record, Series};
use grainbench_solver::resolution::Resolution;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// A change of a scene in code.
pub type Change = Arc<dyn Fn(&mut Scene) + Send + Sync>;

/// A run that a claim reads.
#[derive(Clone)]
#[must_use]
pub struct Run {
    /// Variant of the scene.
    pub variant: &'static str,
    /// Third-party data from which the scene is made, instead of a variant.
    pub data: Option<&'static Data>,
    /// Name of the solver.
    pub solver: &'static str,
    /// Time step, substeps or cells of the run.
    pub resolution: Resolution,
    /// Change of the scene that belongs to the claim, such as another stiffness in a parameter study. The name of the
    /// change distinguishes runs.
    pub adjustment: Option<(String, Change)>,
    /// Expected outcome of a claim about this run.
    pub standing: ExpectedOutcome,
    /// Largest |error| of a known error, divided by the claim's scale. A larger error is red.
    pub known_up_to: f64,
    /// Tier of the run.
    pub set: Set,
    /// Reference run: negative controls are not applied to it.
    pub aside: bool,
    /// Evaluation of the snapshots during the run; none if the snapshots stay in the record.
    pub reading: Option<Reading>,
    /// True if the tables of the run are stored with the case. Smaller tiers then use the stored result.
    pub kept: bool,
}

/// A scene that is made from third-party data.
#[derive(Debug)]
pub struct Data {
    /// Name of the scene, which identifies its runs.
    pub name: &'static str,
    /// Required files, their origin and the way to supply them, in words.
    pub needs: &'static str,
    /// Makes the scene from the files in a directory.
    pub scene: fn(&Path) -> Result<Scene, SceneDataError>,
}

/// Reason why a scene cannot be made from data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneDataError {
    /// The directory lacks the files. The text names the expected files.
    Absent(String),
    /// The files in the directory cannot be used. The text states the reason.
    Wrong(String),
}

impl SceneDataError {
    /// Returns the text of the error.
    #[must_use]
    pub fn into_words(self) -> String {
        match self {
            Self::Absent(words) | Self::Wrong(words) => words,
        }
    }
}

/// Provenance of a stored result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultOrigin {
    /// Date, program and commit, in words.
    pub words: String,
    /// True if the solver's sources at the time of the result are those of this program.
    pub is_current: bool,
}

/// Tier of runs. Each tier includes all smaller tiers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Set {
    /// Quick tier: runs of at most a few seconds each.
    #[default]
    Main,
    /// Standard tier: runs of more than a few seconds. The tests and `run --levels all` include them.
    Tests,
    /// Long tier: runs that take minutes.
    Long,
    /// Full-scale tier: runs that take about an hour, with scenes as large as in a publication.
    Paper,
}

/// Expected outcome of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExpectedOutcome {
    /// The result passes.
    #[default]
    Passes,
    /// The solver rejects the scene, because it cannot represent it.
    Refused,
    /// A documented error of the method or program, with the reason. The result is amber as long as the error exceeds
    /// the tolerance.
    Known(&'static str),
}

impl Run {
    /// Returns a run of a variant without changes.
    pub fn new(variant: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self {
            variant,
            data: None,
            solver,
            resolution,
            adjustment: None,
            standing: ExpectedOutcome::Passes,
            known_up_to: f64::INFINITY,
            set: Set::Main,
            aside: false,
            reading: None,
            kept: false,
        }
    }

    /// Replaces the scene by one made from third-party data, which the user must supply.
    pub fn from_data(self, data: &'static Data) -> Self {
        Self { data: Some(data), ..self }
    }

    /// Adds a named change of the scene.
    pub fn adjusted(mut self, name: &str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        self.adjustment = Some((name.to_owned(), Arc::new(change)));
        self
    }

    /// Expects a documented error of the method, with its reason.
    pub fn known(self, reason: &'static str) -> Self {
        Self { standing: ExpectedOutcome::Known(reason), ..self }
    }

    /// Sets the largest |error| of a known error, divided by the claim's scale. A larger error is red.
    ///
    /// The limit is the documented error rounded up to 1, 2 or 5 in its leading digit. It follows from earlier results,
    /// so it detects changes but does not show that the value is correct.
    pub fn up_to(self, error: f64) -> Self {
        Self { known_up_to: error, ..self }
    }

    /// Assigns the run to the standard tier, which the tests and `run --levels all` include.
    pub fn slow(self) -> Self {
        Self { set: Set::Tests, ..self }
    }

    /// Assigns the run to the long tier.
    pub fn long(self) -> Self {
        Self { set: Set::Long, ..self }
    }

    /// Assigns the run to the full-scale tier.
    pub fn paper_size(self) -> Self {
        Self { set: Set::Paper, ..self }
    }

    /// Evaluates the snapshots during the run. The snapshots are then not stored.
    pub fn read_by(self, reading: Reading) -> Self {
        Self { reading: Some(reading), ..self }
    }

    /// Stores the tables with the case. Smaller tiers then judge the stored result, and the tier of the run repeats it.
    pub fn kept(self) -> Self {
        Self { kept: true, ..self }
    }

    /// Returns the smallest tier in which a claim about this run can be judged. For a stored run, this is the quick tier.
    #[must_use]
    pub fn judged_in(&self) -> Set {
        if self.kept { Set::Main } else { self.set }
    }

    /// Makes the run a reference run: negative controls are not applied to it.
    pub fn aside(self) -> Self {
        Self { aside: true, ..self }
    }

    /// Returns the same run at another resolution.
    pub fn at(&self, resolution: Resolution) -> Self {
        Self { resolution, ..self.clone() }
    }

    /// Returns the name of the variant or of the data, followed by the name of the scene change.
    #[must_use]
    pub fn scene_words(&self) -> String {
        let scene = self.data.map_or(self.variant, |data| data.name);
        match &self.adjustment {
            Some((name, _)) => format!("{scene}, {name}"),
            None => scene.to_owned(),
        }
    }

    /// Returns a key that distinguishes this run from all other runs of the case.
    #[must_use]
    pub fn key(&self) -> String {
        let adjustment = self.adjustment.as_ref().map(|(name, _)| name.as_str()).unwrap_or_default();
        let scene = self.data.map_or(self.variant, |data| data.name);
        format!("{scene}|{}|{:?}|{:?}|{adjustment}", self.solver, self.resolution, self.reading)
    }
}

/// Function that reads a value from a finished run.
pub type RunReader = fn(&FinishedRun) -> Result<f64, MissingData>;

/// A finished run: its scene and its output.
#[derive(Clone, Debug)]
pub struct FinishedRun {
    /// Scene as the case defines it. Under a negative control, the solver ran another scene.
    pub scene: Arc<Scene>,
    /// Output of the solver.
    pub record: Arc<Record>,
    /// Tables read from the snapshots.
    pub tables: Arc<Vec<Table>>,
    /// Provenance of a stored result; none if the run was done now.
    pub kept: Option<ResultOrigin>,
}

/// Name of a quantity that the records lack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingData(pub String);

impl From<&str> for MissingData {
    fn from(name: &str) -> Self {
        Self(name.to_owned())
    }
}

impl From<String> for MissingData {
    fn from(name: String) -> Self {
        Self(name)
    }
}

impl fmt::Display for MissingData {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the record has no {}", self.0)
    }
}

impl FinishedRun {
    /// Returns a finished run with a record and no tables.
    #[must_use]
    pub fn new(scene: Arc<Scene>, record: Arc<Record>) -> Self {
        Self { scene, record, tables: Arc::default(), kept: None }
    }

    /// Returns a table that was read from the snapshots.
    ///
    /// # Errors
    /// When no table has this name.
    pub fn table(&self, name: &str) -> Result<&Table, MissingData> {
        self.tables.iter().find(|table| table.name == name).ok_or_else(|| MissingData(format!("table `{name}`")))
    }

    /// Returns a column of a table that was read from the snapshots.
    ///
    /// # Errors
    /// When no table or no column has this name.
    pub fn column_of(&self, table: &str, name: &str) -> Result<&[f64], MissingData> {
        let column = self.table(table)?.column(name);
        Ok(column.ok_or_else(|| format!("column `{name}` of `{table}`"))?)
    }

    /// Returns the time series.
    #[must_use]
    pub fn series(&self) -> &Series {
        &self.record.series
    }

    /// Returns a column of the time series.
    ///
    /// # Errors
    /// When no column has this name, or the column is empty.
    pub fn column(&self, name: &str) -> Result<&[f64], MissingData> {
        match self.series().column(name) {
            Some(values) if !values.is_empty() => Ok(values),
            _ => Err(MissingData(format!("column `{name}`"))),
        }
    }

    /// Returns the last value of a column.
    ///
    /// # Errors
    /// When no column has this name, or the column is empty.
    pub fn last(&self, name: &str) -> Result<f64, MissingData> {
        Ok(self.column(name)?[self.column(name)?.len() - 1])
    }

    /// Returns the value of a column at a step.
    ///
    /// # Errors
    /// When no column has this name, or the step was not sampled.
    pub fn at_step(&self, name: &str, step: u64) -> Result<f64, MissingData> {
        let values = self.column(name)?;
        let at = self.series().step.iter().position(|&sampled| sampled == step);
        at.map(|at| values[at]).ok_or_else(|| MissingData(format!("sample of `{name}` at step {step}")))
    }
}
