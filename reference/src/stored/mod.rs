//! Stored runs of external programs, for comparisons on machines where these programs are not installed.
//!
//! A stored run consists of the deck, the output in full precision, the output with half the time step, and the
//! provenance.

mod scene_hash;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use flate2::{Compression, GzBuilder};
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::perturbed::{PARTED, move_one};
use grainbench_solver::record::{self, Cost, Record, Series};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::refined::refined;
use grainbench_solver::resolution::Resolution;
use grainbench_store::ReadError;
use grainbench_store::artifact::{hashes, read_listed, read_toml};
use serde::{Deserialize, Serialize};

use crate::deck::{Program, Stepping, write_deck};
use crate::live::LiveProgram;
use crate::read::number_table::Table;
use crate::read::read_error;
use crate::read::table::read_table;
pub use scene_hash::{is_scene_of, scene_hash, scene_hash_by_bits};

const PROVENANCE: &str = "provenance.toml";
const SERIES: &str = "series.csv.gz";
const HALF_STEP_SERIES: &str = "series-half-step.csv.gz";

/// Error of a stored run that is missing, incomplete or changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoredError {
    /// A file of the run is missing, damaged or changed.
    #[error(transparent)]
    File(#[from] ReadError),
    /// A series of the run is damaged.
    #[error(transparent)]
    Series(#[from] read_error::ReadError),
}

/// Content of `provenance.toml` of a stored run.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Program that made the run.
    pub program: String,
    /// Line in which the program prints its version.
    pub version: String,
    /// Day of the run (YYYY-MM-DD).
    pub date: String,
    /// Short description of the run.
    pub title: String,
    /// BLAKE3 hash of all data of the scene that affect the run. See [`scene_hash()`].
    pub scene: String,
    /// Last stored step up to which the run is predictable; `None` if it is predictable until the end.
    ///
    /// A perturbed run starts with one position changed by one unit in the last place. Up to this step, the perturbed
    /// run differs from the stored run by at most 1e-9 of the scale of each column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predictable_steps: Option<u64>,
    /// Shell commands that repeat the run in its folder, and the command that creates all files of the stored run.
    pub commands: Vec<String>,
    /// BLAKE3 hashes of all files of the run, by name.
    pub blake3: BTreeMap<String, String>,
}

/// Stored run. Its files have been verified by their hashes.
#[derive(Debug, Clone)]
pub struct StoredRun {
    /// Folder of the run.
    pub directory: PathBuf,
    /// Provenance of the run.
    pub provenance: Provenance,
    series: Table,
    half_step: Table,
}

/// Returns the folder of the stored run `id` of a program.
#[must_use]
pub fn folder(program: Program, id: &str) -> PathBuf {
    crate::data::reference().join(program.name()).join(id)
}

impl StoredRun {
    /// Loads the run in `directory`: its `provenance.toml`, every file that it lists, and both series.
    ///
    /// # Errors
    /// If a file is missing, changed or damaged. See [`StoredError`].
    pub fn load(directory: &Path) -> Result<Self, StoredError> {
        let list = directory.join(PROVENANCE);
        let provenance: Provenance = read_toml(&list)?;
        for (name, hash) in &provenance.blake3 {
            read_listed(&list, name, hash)?;
        }
        let listed = |name: &str| {
            if provenance.blake3.contains_key(name) {
                return Ok(directory.join(name));
            }
            Err(ReadError::other(&list, format!("the hash of `{name}`"), "none"))
        };
        let (series, half_step) = (read_table(&listed(SERIES)?)?, read_table(&listed(HALF_STEP_SERIES)?)?);
        check_half_step(directory, &series, &half_step)?;
        Ok(Self { directory: directory.to_owned(), provenance, series, half_step })
    }

    /// Returns true if the run was made from this scene at this resolution.
    #[must_use]
    pub fn is_of(&self, scene: &Scene, resolution: &Resolution) -> bool {
        Stepping::new(scene, resolution).is_ok_and(|stepping| scene_hash(scene, &stepping) == self.provenance.scene)
    }

    /// Returns the values of the scene's probes in the run.
    #[must_use]
    pub fn series(&self, scene: &Scene) -> Series {
        series(scene, &self.series)
    }

    /// Returns the values of the scene's probes in the run with half the time step, at the times of the stored run.
    ///
    /// The difference of the two runs is an estimate of the time-step error of the stored run. The steps are numbered
    /// as in the stored run.
    #[must_use]
    pub fn half_step(&self, scene: &Scene) -> Series {
        Series { step: self.series(scene).step, ..series(scene, &self.half_step) }
    }

    /// Returns the record of the run.
    ///
    /// # Errors
    /// [`RunError::Stale`] if the run was made from another scene or time step.
    pub fn record(&self, scene: &Scene, resolution: &Resolution, program: Program) -> Result<Record, RunError> {
        let solver = program.name().to_owned();
        let is_same = |stepping: &Stepping| scene_hash(scene, stepping) == self.provenance.scene;
        let Some(stepping) = Stepping::new(scene, resolution).ok().filter(is_same) else {
            let reason = format!(
                "`{}` belongs to another scene or time step; `grainbench reference build` computes it again",
                self.directory.file_name().unwrap_or_default().to_string_lossy()
            );
            return Err(RunError::Stale { solver, reason });
        };
        let options = vec![self.provenance.version.clone(), format!("stored run of {}", self.provenance.date)];
        Ok(Record {
            provenance: record::Provenance::new(scene, solver, resolution, stepping.time_step, options),
            series: self.series(scene),
            snapshots: Vec::new(),
            cost: Cost::of_program(stepping.steps, scene.grains.len(), f64::NAN),
        })
    }
}

/// Largest difference of one column between a rerun and a stored run.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// Name of the column.
    pub name: String,
    /// Unit of the column.
    pub unit: String,
    /// Stored value at the time of the largest difference.
    pub stored: f64,
    /// Value of the rerun at the time of the largest difference.
    pub rerun: f64,
    /// Scale by which the difference is divided: the largest magnitude in all columns with this unit; for lengths (m),
    /// the largest change since the start.
    pub scale: f64,
    /// Time of the largest difference (s).
    pub time: f64,
}

impl Drift {
    /// Returns the relative difference (rerun − stored)/scale.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.rerun - self.stored) / self.scale
    }
}

/// Returns the largest difference of each column at the stored steps up to `last_step`. If the rerun lacks a value,
/// [`Drift::rerun`] is NaN, which counts as the largest difference.
#[must_use]
pub fn drift(stored: &Series, rerun: &Series, last_step: u64) -> Vec<Drift> {
    let moved = |values: &[f64], unit: &str| -> f64 {
        let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
        values.iter().map(|value| (value - start).abs()).fold(0.0, f64::max)
    };
    let all = || stored.columns.iter().zip(&stored.values);
    let mut found = Vec::new();
    for (column, values) in all() {
        let same_unit = all().filter(|(other, _)| other.unit == column.unit);
        let scale = same_unit.map(|(other, values)| moved(values, &other.unit)).fold(0.0, f64::max);
        let mut worst = Drift {
            name: column.name.clone(),
            unit: column.unit.clone(),
            stored: values.first().copied().unwrap_or(f64::NAN),
            rerun: values.first().copied().unwrap_or(f64::NAN),
            scale: if scale > 0.0 { scale } else { 1.0 },
            time: 0.0,
        };
        let of_rerun = rerun.column(&column.name);
        for ((step, time), value) in stored.step.iter().zip(&stored.time).zip(values) {
            if *step > last_step {
                break;
            }
            let place = rerun.step.binary_search(step).ok();
            let again = place.and_then(|at| of_rerun?.get(at)).copied().unwrap_or(f64::NAN);
            let is_worse = again.is_nan() || (again - value).abs() > (worst.rerun - worst.stored).abs();
            if is_worse && !worst.rerun.is_nan() {
                (worst.stored, worst.rerun, worst.time) = (*value, again, *time);
            }
        }
        found.push(worst);
    }
    found
}

/// Returns the error of a run whose stored files are damaged.
#[must_use]
pub fn unusable(program: Program, error: &StoredError) -> RunError {
    let failure = Failure::Output(error.to_string());
    RunError::Program { solver: program.name().to_owned(), failure, last_lines: Vec::new() }
}

/// Returns the probes of a scene in a table of a stored run.
fn series(scene: &Scene, table: &Table) -> Series {
    probe_series(scene, |name| Some(table.values(table.column(name)?).collect()))
}

/// Returns the columns of a table that belong to the scene's probes, with the steps and times. `values` returns a column.
pub fn probe_series(scene: &Scene, values: impl Fn(&str) -> Option<Vec<f64>>) -> Series {
    let step = values("step").unwrap_or_default().iter().map(|step| *step as u64).collect();
    let mut series = Series { step, time: values("time").unwrap_or_default(), ..Series::default() };
    for column in Recorder::new(scene, 1.0, 1).finish().0.columns {
        if let Some(of_column) = values(&column.name) {
            series.values.push(of_column);
            series.columns.push(column);
        }
    }
    series
}

/// Checks that both series have times, that these times are equal, and that the series of the run has steps.
fn check_half_step(directory: &Path, run: &Table, half: &Table) -> Result<(), ReadError> {
    let column = |table: &Table, file: &str, name: &str| -> Result<Vec<f64>, ReadError> {
        let missing = || ReadError::other(&directory.join(file), format!("a column `{name}`"), "none");
        Ok(table.values(table.column(name).ok_or_else(missing)?).collect())
    };
    column(run, SERIES, "step")?;
    let (of_run, of_half) = (column(run, SERIES, "time")?, column(half, HALF_STEP_SERIES, "time")?);
    let differing =
        |found: String| ReadError::other(&directory.join(HALF_STEP_SERIES), format!("the times of `{SERIES}`"), found);
    if of_run.len() != of_half.len() {
        return Err(differing(format!("{} rows instead of {}", of_half.len(), of_run.len())));
    }
    // The programs sum up time steps, so equal times differ in their last digits.
    match of_run.iter().zip(&of_half).find(|(run, half)| (**run - **half).abs() > 1e-9 * run.max(**half)) {
        Some((run, half)) => Err(differing(format!("{half:?} instead of {run:?}"))),
        None => Ok(()),
    }
}

/// Maximum number of stored samples of a run, without the last sample.
const MOST_SAMPLES: usize = 100;
/// Size from which a file of the deck is compressed (B).
const LARGE: usize = 1 << 14;

/// Runs a scene three times: as it is, with half the time step, and with a perturbed initial state. Returns the files of
/// the stored run by name and content, with `provenance.toml` last.
///
/// `id` is the name of the run in `reference build`. `title` describes the run, and `date` is the day (YYYY-MM-DD).
///
/// # Errors
/// If the program cannot express the scene, is not installed or fails, or if a value is not finite.
pub fn make(
    program: Program,
    id: &str,
    title: &str,
    date: &str,
    scene: &Scene,
    resolution: &Resolution,
) -> Result<Vec<(String, Vec<u8>)>, RunError> {
    let live = LiveProgram::find(program);
    let fail = |reason: String| RunError::Resolution { solver: program.name().to_owned(), reason };
    let stepping = Stepping::new(scene, resolution).map_err(fail)?;
    let run = live.run(scene, resolution, &mut ())?;
    let (half_scene, half_resolution) = refined(scene, stepping.time_step, [stepping.steps, stepping.interval], 2);
    let half = live.run(&half_scene, &half_resolution, &mut ())?;
    let mut moved_scene = scene.clone();
    move_one(&mut moved_scene);
    let moved = live.run(&moved_scene, resolution, &mut ())?;
    let deck = write_deck(scene, resolution, program).map_err(|error| fail(error.to_string()))?;
    let mut files = Vec::new();
    for (name, text) in deck.files {
        if text.len() < LARGE {
            files.push((name, text.into_bytes()));
        } else {
            files.push((format!("{name}.gz"), compressed(&text)));
        }
    }
    files.push((SERIES.to_owned(), compressed(&table(&run, program)?)));
    files.push((HALF_STEP_SERIES.to_owned(), compressed(&table(&half, program)?)));
    let mut commands =
        vec![program.command().to_owned(), format!("grainbench reference build {}/{id}", program.name())];
    let packed = files.iter().filter_map(|(name, _)| name.strip_suffix(".gz")).filter(|name| !name.ends_with(".csv"));
    for name in packed {
        commands.insert(0, format!("gzip -dk {name}.gz"));
    }
    let provenance = Provenance {
        program: program.to_string(),
        version: run.provenance.options.first().cloned().unwrap_or_default(),
        date: date.to_owned(),
        title: title.to_owned(),
        scene: scene_hash(scene, &stepping),
        predictable_steps: predictable_steps(&thinned(&run.series), &moved.series),
        commands,
        blake3: hashes(&files),
    };
    let text = toml::to_string(&provenance).map_err(|error| fail(error.to_string()))?;
    files.push((PROVENANCE.to_owned(), text.into_bytes()));
    Ok(files)
}

/// Returns about 100 samples of a run as CSV in full precision.
fn table(record: &Record, program: Program) -> Result<String, RunError> {
    let series = thinned(&record.series);
    for (column, values) in series.columns.iter().zip(&series.values) {
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let failure = Failure::Output(format!("`{}` is {} at step {}", column.name, values[at], series.step[at]));
            return Err(RunError::Program { solver: program.name().to_owned(), failure, last_lines: Vec::new() });
        }
    }
    Ok(csv_of(&series))
}

/// Returns a time series as CSV in full precision.
#[must_use]
pub fn csv_of(series: &Series) -> String {
    let names: String = series.columns.iter().map(|column| format!(",{}", column.name)).collect();
    let mut lines = format!("step,time{names}\n");
    for (at, (step, time)) in series.step.iter().zip(&series.time).enumerate() {
        let values: String = series.values.iter().map(|values| format!(",{:?}", values[at])).collect();
        lines.push_str(&format!("{step},{time:?}{values}\n"));
    }
    lines
}

/// Returns the last stored step up to which the perturbed run differs from `run` by at most [`PARTED`] of the scale of
/// each column, or `None` if this is true until the end.
fn predictable_steps(run: &Series, perturbed: &Series) -> Option<u64> {
    let parted = |step: u64| {
        drift(run, perturbed, step).iter().any(|column| column.error().is_nan() || column.error().abs() > PARTED)
    };
    let first = run.step.partition_point(|&step| !parted(step));
    (first < run.step.len()).then(|| run.step[first.saturating_sub(1)])
}

/// Returns at most [`MOST_SAMPLES`] evenly spaced samples of a series, and the last sample.
fn thinned(series: &Series) -> Series {
    let stride = series.step.len().div_ceil(MOST_SAMPLES).max(1);
    let keep: Vec<usize> =
        (0..series.step.len()).filter(|at| at % stride == 0 || at + 1 == series.step.len()).collect();
    let pick = |values: &[f64]| keep.iter().map(|&at| values[at]).collect::<Vec<f64>>();
    Series {
        step: keep.iter().map(|&at| series.step[at]).collect(),
        time: pick(&series.time),
        columns: series.columns.clone(),
        values: series.values.iter().map(|values| pick(values)).collect(),
    }
}

/// Returns a text compressed by gzip. File name and time are omitted, so that equal texts give equal files.
#[must_use]
pub fn compressed(text: &str) -> Vec<u8> {
    let mut encoder = GzBuilder::new().mtime(0).write(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let _ = encoder.write_all(text.as_bytes());
    encoder.finish().unwrap_or_default()
}
