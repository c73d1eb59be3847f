//! Stored results of runs that take minutes or hours, in the folder of their case. They are the tables read from
//! snapshots, the time series and their provenance. The main CI job evaluates claims on them without the run. Commands
//! that select the tier of a run repeat the run.

use crate::registry::CASES;
use crate::solvers::is_program;
use flate2::read::GzDecoder;
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::control::WrongPhysics;
use grainbench_harness::reading::Table;
use grainbench_harness::run::{FinishedRun, ResultOrigin, Run, Set};
use grainbench_harness::solvers::StoredResult;
use grainbench_reference::deck::Stepping;
use grainbench_reference::stored::{compressed, is_scene_of, scene_hash_by_bits};
use grainbench_scene::record::{Cost, Provenance as RecordProvenance, Record, Series};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Failure, RunError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const PROVENANCE: &str = "provenance.toml";
const SERIES: &str = "series";
const ENDING: &str = ".csv.gz";
/// Significant digits of numbers in tables. Tables average many grains, so a rounding error of 1e-6 is negligible.
const DIGITS: usize = 6;

/// Returns the hash of the sources of a solver that this program is built from. For an external program it is the hash of
/// the sources that write its input. Comments do not count.
#[must_use]
pub fn sources(solver: &str) -> Option<String> {
    let hash = match solver.split([':', '+']).next() {
        Some("dem") => env!("GRAINBENCH_SOURCES_DEM"),
        Some("mpm") => env!("GRAINBENCH_SOURCES_MPM"),
        Some("rigid") => env!("GRAINBENCH_SOURCES_RIGID"),
        Some("lammps" | "liggghts") => env!("GRAINBENCH_SOURCES_PROGRAMS"),
        _ => return None,
    };
    Some(hash.to_owned())
}

/// Provenance of a stored result.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Name and version of the program that made it.
    pub program: String,
    /// Commit that the program was built from.
    pub commit: String,
    /// Date (YYYY-MM-DD).
    pub date: String,
    /// Description of the run.
    pub title: String,
    /// Description of the reading of its snapshots.
    pub reading: String,
    /// BLAKE3 hash of everything in the scene that the run depends on, by [`scene_hash_by_bits`]. Older results have a
    /// hash over the decimal digits of the grains.
    pub scene: String,
    /// Hash of the sources of the solver, by [`sources`]. Older results have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sources: Option<String>,
    /// Command that makes the result again.
    pub command: String,
    /// BLAKE3 hash of each file, by file name.
    pub blake3: BTreeMap<String, String>,
    /// Summary of the run.
    pub run: RecordProvenance,
    /// Cost of the run.
    pub cost: Cost,
}

/// A run of a claim whose tables are stored: the run itself or its negative control.
#[derive(Clone)]
pub struct StorableRun {
    /// Case of the claim.
    pub case: &'static Case,
    /// Claim that reads the run.
    pub claim: Claim,
    /// Run whose result is stored.
    pub run: Run,
    /// True for the run of the negative control.
    pub wrong: bool,
    /// Name of the folder of the stored result.
    pub id: String,
}

impl StorableRun {
    /// Returns the lowest tier that includes this run.
    #[must_use]
    pub fn set(&self) -> Set {
        if self.wrong { self.run.set.max(self.claim.control.set) } else { self.run.set }
    }

    /// Returns the folder of the stored result.
    #[must_use]
    pub fn folder(&self) -> PathBuf {
        folder(self.case, &self.id)
    }

    /// Returns true if the stored result belongs to the present scene.
    #[must_use]
    pub fn is_there(&self, given: &Scene) -> bool {
        let control = self.wrong.then_some(self.claim.control.name);
        matches!(load(self.case, &self.run, given, control), Some(Ok(_)))
    }
}

/// Returns all stored runs that claims of a case read, each once.
#[must_use]
pub fn all(case: &'static Case) -> Vec<StorableRun> {
    let mut all: Vec<StorableRun> = Vec::new();
    for claim in (case.claims)() {
        for run in claim.runs.iter().filter(|run| run.kept) {
            let changes = match claim.control.wrong {
                WrongPhysics::Scene(_) => true,
                WrongPhysics::Ours(_) => !is_program(run.solver),
                _ => false,
            };
            for wrong in [false, true] {
                let control = wrong.then_some(claim.control.name);
                let id = id(run, control);
                if (!wrong || (changes && !run.aside)) && all.iter().all(|known| known.id != id) {
                    all.push(StorableRun { case, claim: claim.clone(), run: run.clone(), wrong, id });
                }
            }
        }
    }
    all
}

/// Returns the cases that have stored results.
#[must_use]
pub fn cases() -> Vec<&'static Case> {
    CASES
        .iter()
        .copied()
        .filter(|case| (case.claims)().iter().any(|claim| claim.runs.iter().any(|run| run.kept)))
        .collect()
}

/// Returns the folder name of a run under a control of this name: scene, solver, resolution and control in letters,
/// digits, `.` and `-`.
fn id(run: &Run, control: Option<&str>) -> String {
    let words = format!("{} {} {} {}", run.scene_words(), run.solver, run.resolution, control.unwrap_or_default());
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '-' };
    let words: String = words.chars().map(plain).collect();
    words.split('-').filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-").to_lowercase()
}

fn folder(case: &Case, id: &str) -> PathBuf {
    case.directory().join("kept").join(id)
}

/// Reads the stored result of a run of a scene, under a control of this name; `None` if there is none.
#[must_use]
pub(crate) fn load(
    case: &Case,
    run: &Run,
    scene: &Scene,
    control: Option<&str>,
) -> Option<Result<StoredResult, RunError>> {
    let folder = folder(case, &id(run, control));
    if !folder.is_dir() {
        return None;
    }
    let broken = |reason: String| RunError::Program {
        solver: run.solver.to_owned(),
        failure: Failure::Output(format!("{}: {reason}", folder.display())),
        last_lines: Vec::new(),
    };
    Some(read(&folder, run, scene).map_err(|error| match error {
        StoredResultError::Stale(reason) => RunError::Stale { solver: run.solver.to_owned(), reason },
        StoredResultError::Broken(reason) => broken(reason),
    }))
}

/// Reason why a stored result cannot be used.
enum StoredResultError {
    /// The result belongs to another scene or another reading.
    Stale(String),
    /// A file is missing, damaged or changed.
    Broken(String),
}

fn read(folder: &Path, run: &Run, scene: &Scene) -> Result<StoredResult, StoredResultError> {
    let text =
        fs::read_to_string(folder.join(PROVENANCE)).map_err(|error| StoredResultError::Broken(error.to_string()))?;
    let provenance: Provenance = toml::from_str(&text).map_err(|error| StoredResultError::Broken(error.to_string()))?;
    let reading = run.reading.map_or("", |reading| reading.name);
    let stepping = Stepping::new(scene, &run.resolution).map_err(StoredResultError::Broken)?;
    if !is_scene_of(&provenance.scene, scene, &stepping) || reading != provenance.reading {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let reason = format!(
            "`{name}` belongs to another scene, time step or evaluation; `grainbench reference keep` computes \
                     it again"
        );
        return Err(StoredResultError::Stale(reason));
    }
    let mut tables = Vec::new();
    for (file, expected) in &provenance.blake3 {
        tables.push(table(folder, file, expected).map_err(StoredResultError::Broken)?);
    }
    let place = tables.iter().position(|table| table.name == SERIES);
    let series = place.map(|place| series(scene, &tables.remove(place))).unwrap_or_default();
    let words = format!("{} ({}, {})", provenance.date, provenance.program, provenance.commit);
    let is_current = is_program(run.solver) || provenance.sources == sources(run.solver);
    Ok(StoredResult {
        record: Record { provenance: provenance.run, series, snapshots: Vec::new(), cost: provenance.cost },
        tables,
        made: ResultOrigin { words, is_current },
    })
}

/// Reads a table from a file with the expected hash. An empty field becomes NaN.
fn table(folder: &Path, file: &str, expected: &str) -> Result<Table, String> {
    let name = file.strip_suffix(ENDING).filter(|name| name.bytes().all(|byte| byte.is_ascii_alphanumeric()));
    let name = name.ok_or_else(|| format!("expected the name of a table, found `{file}`"))?;
    let bytes = fs::read(folder.join(file)).map_err(|error| format!("{file}: {error}"))?;
    let found = blake3::hash(&bytes).to_hex().to_string();
    if found != expected {
        return Err(format!("{file}: expected the hash {expected}, found {found}"));
    }
    let mut reader = csv::Reader::from_reader(GzDecoder::new(&bytes[..]));
    let columns: Vec<String> =
        reader.headers().map_err(|error| format!("{file}: {error}"))?.iter().map(str::to_owned).collect();
    let mut values = vec![Vec::new(); columns.len()];
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(|error| format!("{file}: {error}"))? {
        for (column, field) in values.iter_mut().zip(&row) {
            let value = if field.is_empty() { Ok(f64::NAN) } else { field.parse() };
            column.push(value.map_err(|_| format!("{file}: expected a number, found `{field}`"))?);
        }
    }
    Ok(Table { name: name.to_owned(), columns, values })
}

/// Returns the time series of a record from its table.
fn series(scene: &Scene, table: &Table) -> Series {
    let values = |name: &str| table.column(name).map(<[f64]>::to_vec).unwrap_or_default();
    let mut series = Series {
        step: values("step").iter().map(|step| *step as u64).collect(),
        time: values("time"),
        ..Series::default()
    };
    for column in Recorder::new(scene, 1.0, 1).finish().0.columns {
        if let Some(of_column) = table.column(&column.name) {
            series.values.push(of_column.to_vec());
            series.columns.push(column);
        }
    }
    series
}

/// Returns name and bytes of each file that stores a finished run.
///
/// # Errors
/// When the provenance cannot be serialised. The error is a message.
pub fn files(
    wanted: &StorableRun,
    done: &FinishedRun,
    given: &Scene,
    made: [&str; 2],
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let record = &done.record;
    let mut files = vec![(format!("{SERIES}{ENDING}"), compressed(&text_of_series(&record.series)))];
    for table in done.tables.iter() {
        files.push((format!("{}{ENDING}", table.name), compressed(&text(&table.columns, &table.values))));
    }
    let program = match record.provenance.options.first().filter(|_| is_program(wanted.run.solver)) {
        Some(version) => version.clone(),
        None => format!("grainbench {}", env!("CARGO_PKG_VERSION")),
    };
    let paper_size = if wanted.set() == Set::Paper { " --paper-size" } else { "" };
    let control = if wanted.wrong { format!(", {}", wanted.claim.control.name) } else { String::new() };
    let provenance = Provenance {
        program,
        commit: made[0].to_owned(),
        date: made[1].to_owned(),
        title: format!(
            "{}/{}{control}, {}, {}",
            wanted.case.name,
            wanted.run.scene_words(),
            wanted.run.solver,
            wanted.run.resolution
        ),
        reading: wanted.run.reading.map_or("", |reading| reading.name).to_owned(),
        scene: scene_hash_by_bits(given, &Stepping::new(given, &wanted.run.resolution)?),
        sources: sources(wanted.run.solver).filter(|_| !is_program(wanted.run.solver)),
        command: format!("grainbench reference keep {}{paper_size}", wanted.case.name),
        blake3: files.iter().map(|(name, bytes)| (name.clone(), blake3::hash(bytes).to_hex().to_string())).collect(),
        run: record.provenance.clone(),
        cost: record.cost,
    };
    files.push((PROVENANCE.to_owned(), toml::to_string(&provenance).map_err(|error| error.to_string())?.into_bytes()));
    Ok(files)
}

/// Returns a time series as text with all digits.
fn text_of_series(series: &Series) -> String {
    let mut lines =
        format!("step,time{}\n", series.columns.iter().map(|column| format!(",{}", column.name)).collect::<String>());
    for (at, (step, time)) in series.step.iter().zip(&series.time).enumerate() {
        let values: String = series.values.iter().map(|values| format!(",{:?}", values[at])).collect();
        lines.push_str(&format!("{step},{time:?}{values}\n"));
    }
    lines
}

/// Returns a table as text with [`DIGITS`] digits. NaN becomes an empty field.
fn text(columns: &[String], values: &[Vec<f64>]) -> String {
    let rows = values.first().map_or(0, Vec::len);
    let mut lines = columns.join(",") + "\n";
    for row in 0..rows {
        let fields: Vec<String> = values.iter().map(|column| rounded(column[row])).collect();
        lines.push_str(&(fields.join(",") + "\n"));
    }
    lines
}

fn rounded(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let short: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    format!("{short}")
}
