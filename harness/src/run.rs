//! The runs that a claim reads: which scene, which solver, how finely.

use crate::data::Data;
use crate::reading::{Reading, Table};
use grainbench_scene::record::{Record, Series};
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Resolution;
use std::fmt;
use std::sync::Arc;

/// A change of a scene, by code.
pub type Change = Arc<dyn Fn(&mut Scene) + Send + Sync>;

/// One run that a claim reads.
#[derive(Clone)]
pub struct Run {
    /// Variant of the scene.
    pub variant: &'static str,
    /// Data of others that the scene is made from in place of a variant.
    pub data: Option<&'static Data>,
    /// Solver, by name.
    pub solver: &'static str,
    /// Resolution.
    pub resolution: Resolution,
    /// A change of the scene that belongs to the claim, such as another stiffness in a sweep: its name, which tells
    /// runs apart, and what it does.
    pub adjustment: Option<(String, Change)>,
    /// What is expected of the row.
    pub standing: Standing,
    /// Largest |error| of a known error, in units of the claim's scale; a larger one is red.
    pub known_up_to: f64,
    /// The smallest set that it belongs to.
    pub set: Set,
    /// Whether it is there to judge by, and no negative control touches it.
    pub aside: bool,
    /// What is read of its snapshots, where they are not kept.
    pub reading: Option<Reading>,
    /// Whether what it leaves is kept with the case: sets that it does not belong to judge that.
    pub kept: bool,
}

/// Provenance of a stored result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Made {
    /// Date, program and commit, in words.
    pub words: String,
    /// True if the sources of the solver are those of this program.
    pub is_current: bool,
}

/// Sets of runs, each with all of those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Set {
    /// What the main job does: at most a few seconds a run.
    #[default]
    Main,
    /// What the tests do beside it.
    Tests,
    /// What takes minutes.
    Long,
    /// What takes an hour: scenes of the size that a paper has.
    Paper,
}

/// What is expected of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Standing {
    /// It passes.
    #[default]
    Passes,
    /// The solver refuses the scene, because it cannot express it.
    Refused,
    /// The error of a method or program that is known to be off here, with the reason: shown amber for as long as it is
    /// outside what is allowed.
    Known(&'static str),
}

impl Run {
    /// A run of a variant as it stands.
    #[must_use]
    pub fn new(variant: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self {
            variant,
            data: None,
            solver,
            resolution,
            adjustment: None,
            standing: Standing::Passes,
            known_up_to: f64::INFINITY,
            set: Set::Main,
            aside: false,
            reading: None,
            kept: false,
        }
    }

    /// The run of a scene that is made from data of others: only where the user gives it.
    #[must_use]
    pub fn from_data(self, data: &'static Data) -> Self {
        Self { data: Some(data), ..self }
    }

    /// The run with a change of the scene.
    #[must_use]
    pub fn adjusted(mut self, name: &str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        self.adjustment = Some((name.to_owned(), Arc::new(change)));
        self
    }

    /// The run of a method that is known to be off here.
    #[must_use]
    pub fn known(self, reason: &'static str) -> Self {
        Self { standing: Standing::Known(reason), ..self }
    }

    /// The run of a known error with a second bound: a larger |error|, in units of the claim's scale, is red.
    ///
    /// The bound is the documented error rounded up to 1, 2 or 5 in its leading digit. It holds what was found before, so it is
    /// evidence of a change and not of an answer.
    #[must_use]
    pub fn up_to(self, error: f64) -> Self {
        Self { known_up_to: error, ..self }
    }

    /// The run as one that only the tests do, not the main job.
    #[must_use]
    pub fn slow(self) -> Self {
        Self { set: Set::Tests, ..self }
    }

    /// The run as one of the long set.
    #[must_use]
    pub fn long(self) -> Self {
        Self { set: Set::Long, ..self }
    }

    /// The run as one of scenes as large as those of a paper.
    #[must_use]
    pub fn paper_size(self) -> Self {
        Self { set: Set::Paper, ..self }
    }

    /// The run with a reading of its snapshots, which it does not keep then.
    #[must_use]
    pub fn read_by(self, reading: Reading) -> Self {
        Self { reading: Some(reading), ..self }
    }

    /// The run as one whose tables are kept with the case, so that it is judged in every set and done in its own.
    #[must_use]
    pub fn kept(self) -> Self {
        Self { kept: true, ..self }
    }

    /// The smallest set in which a claim of it can be judged.
    #[must_use]
    pub fn judged_in(&self) -> Set {
        if self.kept { Set::Main } else { self.set }
    }

    /// The run as one that judges and is not judged: negative controls leave it alone.
    #[must_use]
    pub fn aside(self) -> Self {
        Self { aside: true, ..self }
    }

    /// The same run at another resolution.
    #[must_use]
    pub fn at(&self, resolution: Resolution) -> Self {
        Self { resolution, ..self.clone() }
    }

    /// Variant, or data, and adjustment in words.
    #[must_use]
    pub fn scene_words(&self) -> String {
        let scene = self.data.map_or(self.variant, |data| data.name);
        match &self.adjustment {
            Some((name, _)) => format!("{scene}, {name}"),
            None => scene.to_owned(),
        }
    }

    /// What tells this run from others of its case.
    #[must_use]
    pub fn key(&self) -> String {
        let adjustment = self.adjustment.as_ref().map(|(name, _)| name.as_str()).unwrap_or_default();
        let scene = self.data.map_or(self.variant, |data| data.name);
        format!("{scene}|{}|{:?}|{:?}|{adjustment}", self.solver, self.resolution, self.reading)
    }
}

/// A run that was done: what the scene was meant to be, and what the solver left.
#[derive(Clone, Debug)]
pub struct Done {
    /// The scene as the case means it. In a negative control the solver was given a wrong one.
    pub scene: Arc<Scene>,
    /// The record.
    pub record: Arc<Record>,
    /// What was read of its snapshots.
    pub tables: Arc<Vec<Table>>,
    /// Of a run that is kept and was not done now: when and by what it was done, in words.
    pub kept: Option<Made>,
}

/// A quantity that the records do not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing(pub String);

impl fmt::Display for Missing {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the record has no {}", self.0)
    }
}

impl Done {
    /// A run that left a record and nothing else.
    #[must_use]
    pub fn new(scene: Arc<Scene>, record: Arc<Record>) -> Self {
        Self { scene, record, tables: Arc::default(), kept: None }
    }

    /// A table that was read of its snapshots.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn table(&self, name: &str) -> Result<&Table, Missing> {
        self.tables.iter().find(|table| table.name == name).ok_or_else(|| Missing(format!("table `{name}`")))
    }

    /// The time series.
    #[must_use]
    pub fn series(&self) -> &Series {
        &self.record.series
    }

    /// A column of the time series.
    ///
    /// # Errors
    /// When there is no such column or it is empty.
    pub fn column(&self, name: &str) -> Result<&[f64], Missing> {
        match self.series().column(name) {
            Some(values) if !values.is_empty() => Ok(values),
            _ => Err(Missing(format!("column `{name}`"))),
        }
    }

    /// The last value of a column.
    ///
    /// # Errors
    /// When there is no such column or it is empty.
    pub fn last(&self, name: &str) -> Result<f64, Missing> {
        Ok(self.column(name)?[self.column(name)?.len() - 1])
    }

    /// The value of a column at a step.
    ///
    /// # Errors
    /// When the column is missing or was not sampled at that step.
    pub fn at_step(&self, name: &str, step: u64) -> Result<f64, Missing> {
        let values = self.column(name)?;
        let at = self.series().step.iter().position(|&sampled| sampled == step);
        at.map(|at| values[at]).ok_or_else(|| Missing(format!("sample of `{name}` at step {step}")))
    }
}
