//! Stored results of runs that take minutes or hours. Each case folder contains the results of its own runs: tables
//! computed from snapshots, time series and provenance. The main CI job evaluates claims on stored results. A run is
//! repeated only by commands that select its tier.

use crate::registry::CASES;
use crate::stored::{folder_name, is_program};
use flate2::read::GzDecoder;
use grainbench_harness::control::WrongPhysics;
use grainbench_harness::prelude::*;
use grainbench_harness::run::ResultOrigin;
use grainbench_reference::deck::Stepping;
use grainbench_reference::stored::{compressed, csv_of, is_scene_of, probe_series, scene_hash_by_bits};
use grainbench_solver::failure::Failure;
use grainbench_solver::record::{Cost, Provenance as RecordProvenance};
use grainbench_store::ReadError;
use grainbench_store::artifact::{hashes, read_listed, read_toml};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const PROVENANCE: &str = "provenance.toml";
const SERIES: &str = "series";
const ENDING: &str = ".csv.gz";
/// Significant digits of numbers in tables. The rounding error is at most 5e-6 of a value. It is negligible, because
/// tables contain averages over many grains.
const DIGITS: usize = 6;

/// Returns the hash of the source files of a solver in this build; `None` for an unknown solver. For LAMMPS and
/// LIGGGHTS it is the hash of the code that writes their input. Comments do not change the hash.
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
    /// Name and version of the program that computed the result.
    pub program: String,
    /// Commit that the program was built from.
    pub commit: String,
    /// Date (YYYY-MM-DD).
    pub date: String,
    /// Case, scene, solver and resolution of the run.
    pub title: String,
    /// Name of the evaluation of the snapshots; empty if the result has time series only.
    pub reading: String,
    /// BLAKE3 hash of all scene data that affect the run, by [`scene_hash_by_bits`]. In older results, the hash uses
    /// the decimal digits of the grains instead of their bits.
    pub scene: String,
    /// Hash of the solver's source files, by [`sources`]; absent for LAMMPS, for LIGGGHTS and in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sources: Option<String>,
    /// Command that repeats the run and stores its result.
    pub command: String,
    /// BLAKE3 hash of each table file, by file name.
    pub blake3: BTreeMap<String, String>,
    /// Solver, resolution, time step and options, as in the record of the run.
    pub run: RecordProvenance,
    /// Cost of the run.
    pub cost: Cost,
}

/// A run whose result is stored for a claim: the run of the claim, or the run of its negative control.
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

    /// Returns the origin of the stored result for this scene and the time step and evaluation of the run; `None` if there
    /// is no readable one.
    #[must_use]
    pub fn stored(&self, given: &Arc<Scene>) -> Option<ResultOrigin> {
        let control = self.wrong.then_some(self.claim.control.name);
        load(self.case, &self.run, given, control)?.ok()?.kept
    }
}

/// Returns all runs of a case whose results are stored in its folder, each once. Runs of negative controls are included
/// if the control changes the run.
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
    let is_stored = |case: &&'static Case| (case.claims)().iter().flat_map(|claim| &claim.runs).any(|run| run.kept);
    CASES.iter().copied().filter(is_stored).collect()
}

/// Returns the folder name of a run, or of its negative control with this name. Scene, solver, resolution and control
/// are joined by `-` in lower case, with letters, digits and `.` only.
fn id(run: &Run, control: Option<&str>) -> String {
    folder_name(&format!("{} {} {} {}", run.scene_words(), run.solver, run.resolution, control.unwrap_or_default()))
}

fn folder(case: &Case, id: &str) -> PathBuf {
    case.directory().join("kept").join(id)
}

/// Reads the stored result of a run, or of its negative control with this name; `None` if there is no stored result.
#[must_use]
pub(crate) fn load(
    case: &Case,
    run: &Run,
    scene: &Arc<Scene>,
    control: Option<&str>,
) -> Option<Result<FinishedRun, RunError>> {
    let folder = folder(case, &id(run, control));
    if !folder.is_dir() {
        return None;
    }
    Some(read(&folder, run, scene))
}

fn read(folder: &Path, run: &Run, scene: &Arc<Scene>) -> Result<FinishedRun, RunError> {
    let solver = run.solver.to_owned();
    let broken = |error: ReadError| {
        let failure = Failure::Output(error.to_string());
        RunError::Program { solver: solver.clone(), failure, last_lines: Vec::new() }
    };
    let list = folder.join(PROVENANCE);
    let provenance: Provenance = read_toml(&list).map_err(broken)?;
    let reading = run.reading.map_or("", |reading| reading.name);
    let stepping = Stepping::new(scene, &run.resolution)
        .map_err(|reason| RunError::Resolution { solver: solver.clone(), reason })?;
    if !is_scene_of(&provenance.scene, scene, &stepping) || reading != provenance.reading {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let reason = format!(
            "`{name}` belongs to another scene, time step or evaluation; `grainbench reference keep` computes it again"
        );
        return Err(RunError::Stale { solver, reason });
    }
    let mut tables = Vec::new();
    for (file, expected) in &provenance.blake3 {
        tables.push(table(&list, file, expected).map_err(broken)?);
    }
    let place = tables.iter().position(|table| table.name == SERIES);
    let series = place.map(|place| tables.remove(place)).unwrap_or_default();
    // Columns that the record of the scene lacks are dropped.
    let series = probe_series(scene, |name| series.column(name).map(<[f64]>::to_vec));
    let words = format!("{} ({}, {})", provenance.date, provenance.program, provenance.commit);
    let is_current = is_program(run.solver) || provenance.sources == sources(run.solver);
    let record = Record { provenance: provenance.run, series, snapshots: Vec::new(), cost: provenance.cost };
    let (tables, kept) = (Arc::new(tables), Some(ResultOrigin { words, is_current }));
    Ok(FinishedRun { tables, kept, ..FinishedRun::new(Arc::clone(scene), Arc::new(record)) })
}

/// Reads a table from a file that `list` lists with this hash. An empty field becomes NaN.
fn table(list: &Path, file: &str, hash: &str) -> Result<Table, ReadError> {
    let bytes = read_listed(list, file, hash)?;
    let wrong = |expected: &str, found: &str| ReadError::other(&list.with_file_name(file), expected, found);
    let name = file.strip_suffix(ENDING).ok_or_else(|| wrong("the name of a table", file))?;
    let damaged = |error: csv::Error| wrong("a table", &error.to_string());
    let mut reader = csv::Reader::from_reader(GzDecoder::new(&bytes[..]));
    let columns: Vec<String> = reader.headers().map_err(damaged)?.iter().map(str::to_owned).collect();
    let mut values = vec![Vec::new(); columns.len()];
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(damaged)? {
        for (column, field) in values.iter_mut().zip(&row) {
            let value = if field.is_empty() { Ok(f64::NAN) } else { field.parse() };
            column.push(value.map_err(|_| wrong("a number", &format!("`{field}`")))?);
        }
    }
    Ok(Table { name: name.to_owned(), columns, values })
}

/// Returns name and bytes of each file that stores a finished run. `made` contains the commit and the date.
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
    let mut files = vec![(format!("{SERIES}{ENDING}"), compressed(&csv_of(&record.series)))];
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
        blake3: hashes(&files),
        run: record.provenance.clone(),
        cost: record.cost,
    };
    files.push((PROVENANCE.to_owned(), toml::to_string(&provenance).map_err(|error| error.to_string())?.into_bytes()));
    Ok(files)
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// The smallest stored result with a table is read from a copy. Each of its files is then removed, emptied, truncated, and
    /// changed in one bit. The error names the file.
    #[test]
    fn a_damaged_result_is_named() {
        let size = |run: &StorableRun| {
            fs::read_dir(run.folder()).map_or(0, |files| {
                files.flatten().map(|file| file.metadata().map_or(0, |about| about.len())).sum::<u64>()
            })
        };
        let mut runs: Vec<StorableRun> = cases().into_iter().flat_map(all).collect();
        runs.retain(|run| !run.wrong && run.run.reading.is_some() && run.folder().is_dir());
        runs.sort_by_key(size);
        // The scenes of some runs need third-party data.
        let scene = |run: &StorableRun| crate::runner(run.case).given(&run.claim, &run.run, false).ok();
        let (stored, scene) = runs.iter().find_map(|run| Some((run, scene(run)?))).unwrap();
        let copy = tempfile::tempdir().unwrap();
        let mut paths = Vec::new();
        for entry in fs::read_dir(stored.folder()).unwrap().map(|entry| entry.unwrap()) {
            paths.push(copy.path().join(entry.file_name()));
            fs::copy(entry.path(), &paths[paths.len() - 1]).unwrap();
        }
        let message = || read(copy.path(), &stored.run, &scene).err().map(|error| error.to_string());
        assert_eq!(message(), None);
        for path in paths {
            let bytes = fs::read(&path).unwrap();
            let mut flipped = bytes.clone();
            flipped[bytes.len() / 2] ^= 0x80;
            fs::remove_file(&path).unwrap();
            let named = format!("{}:", path.display());
            assert!(message().unwrap().contains(&named), "{:?}", message());
            for damaged in [&[], &bytes[..bytes.len() / 2], &flipped] {
                fs::write(&path, damaged).unwrap();
                assert!(message().unwrap().contains(&named), "{:?}", message());
            }
            fs::write(&path, bytes).unwrap();
        }
    }
}
