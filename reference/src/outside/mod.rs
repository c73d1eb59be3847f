//! External programs as solvers. A manifest describes a program. A run is a process, or a request to a running worker,
//! with input and output files.
//!
//! The program is started in a new folder with a scene file, in which all values are explicit ([`Resolved`]). The exit
//! code is 0 after a successful run. If the program cannot express the scene, the exit code is [`CANNOT`], and standard
//! output contains the reason. Any other exit code is a failure.
//!
//! The program writes the grains at every sample. Claims, negative controls, conformance tests and studies apply to it
//! as to any other solver.

mod can;
mod manifest;
mod resolved;

pub use can::{inexpressible, named_features};
pub use manifest::{Capabilities, GrainFormat, Grains, Limits, Manifest, Output, ParameterValues, SceneFormat, Wall};
pub use resolved::{DiscretizedScene, Resolved, schema};

pub use crate::execution::CANNOT;

use crate::deck::Stepping;
use crate::execution::process::{self, Deadline, ERRORS, ProcessStart, SCREEN, on_path};
use crate::execution::{self, Launch, Protocol, Worker, most_bytes, output, plain_file};
use crate::observer::{DumpObserver, DumpRecord, Names};
use crate::outputs::{Outputs, Sources};
use crate::read::number_table::{Table, quoted_names};
use crate::read::read_error::{ReadError, one_line};
use crate::read::snapshot::DumpSnapshot;
use crate::read::table::read_table;
use grainbench_scene::contact_law::SpringsKind;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::terms::Terms;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// Name of the scene file in the folder of the run, without its extension.
const SCENE: &str = "scene";
/// Time limit for the command that prints the version.
const FOR_VERSION: Duration = Duration::from_secs(20);
/// Time limit for the command `prepare`.
const FOR_PREPARATION: Duration = Duration::from_secs(1800);
/// Maximum size of a program's standard output (B).
const MOST_PRINTED: u64 = 16 << 20;
/// File of stored results next to the manifest, which `run --update-stored` writes.
pub const STORED: &str = "judged.json";
/// Maximum number of files in the folder of a manifest and its subfolders.
const MOST_FILES: usize = 10_000;
/// Default resolution of the conformance tests: 1/50 of the critical time step.
const CONFORMING: Resolution = Resolution::CriticalFraction(0.02);

/// External program with its manifest.
#[derive(Debug)]
pub struct ExternalProgram {
    manifest: Manifest,
    /// Folder of the manifest.
    folder: PathBuf,
    prepared: OnceLock<Result<(), String>>,
    version: OnceLock<Option<String>>,
    edition: OnceLock<Result<String, String>>,
    /// Worker processes that wait for a request.
    idle: Mutex<Vec<Worker>>,
    /// Wall-clock time of a run without steps (s), by number of grains.
    start_up: Mutex<BTreeMap<usize, f64>>,
}

impl ExternalProgram {
    /// Reads the manifest at a path.
    ///
    /// # Errors
    /// If the manifest is not valid.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let manifest = Manifest::read(path)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        Ok(Self {
            manifest,
            folder,
            prepared: OnceLock::new(),
            version: OnceLock::new(),
            edition: OnceLock::new(),
            idle: Mutex::default(),
            start_up: Mutex::default(),
        })
    }

    /// Returns the manifest.
    #[must_use]
    pub const fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Returns the solver-independent conformance properties that the program must satisfy. They are tested with the
    /// smallest time step in the manifest, by default with 1/50 of the critical time step.
    #[must_use]
    pub fn terms(&self) -> Terms {
        let finest = self.manifest.knobs.critical_fraction.iter().copied().reduce(f64::min);
        let terms = Terms::at(finest.map_or(CONFORMING, Resolution::CriticalFraction));
        if self.manifest.can.dimension.contains(&3) { terms } else { terms.in_the_plane() }
    }

    /// Returns the path of an executable, which is a file beside the manifest or on `PATH`.
    fn executable(&self, name: &str) -> Result<PathBuf, String> {
        let beside = self.folder.join(name);
        if name.contains('/') || beside.is_file() {
            return if beside.is_file() { Ok(beside) } else { Err(format!("{} is not a file", beside.display())) };
        }
        on_path(name).ok_or_else(|| format!("there is no `{}` next to the manifest or on PATH", one_line(name)))
    }

    /// Returns the arguments of a command. Placeholders in braces and names of files beside the manifest are replaced
    /// by paths.
    fn words(&self, command: &[String], scene: &Path, out: &Path) -> Vec<String> {
        let word = |word: &String| {
            let beside = self.folder.join(word);
            if !word.contains('{') && !Path::new(word).is_absolute() && beside.is_file() {
                return beside.to_string_lossy().into_owned();
            }
            [("{scene}", scene), ("{out}", out), ("{here}", self.folder.as_path())]
                .iter()
                .fold(word.clone(), |word, (name, path)| word.replace(name, &path.to_string_lossy()))
        };
        command.iter().skip(1).map(word).collect()
    }

    fn limits(&self, time: Duration, bytes: u64) -> process::Limits {
        let limits = &self.manifest.limits;
        let memory = limits.memory_mib.map(|most| most.saturating_mul(1024));
        process::Limits { deadline: Deadline::after(time), bytes, memory, threads: limits.threads }
    }

    /// Executes a command that is not a run, in the folder of the manifest. Returns standard output, or standard error
    /// if it is empty.
    fn aside(&self, command: &[String], time: Duration) -> Result<String, String> {
        let Some(name) = command.first() else { return Ok(String::new()) };
        let executable = self.executable(name)?;
        let scratch = process::scratch([]).map_err(|error| error.to_string())?;
        let arguments = self.words(command, Path::new(""), &self.folder);
        let started = ProcessStart {
            executable: &executable,
            arguments: &arguments,
            folder: scratch.path(),
            errors_apart: true,
            at: Some(&self.folder),
        };
        let failed = |what: String, lines: Vec<String>| {
            let last_words =
                if lines.is_empty() { String::new() } else { format!("; it said last: {}", lines.join(" | ")) };
            format!("`{}` {what}{last_words}", one_line(&command.join(" ")))
        };
        let ended = process::run(&started, self.limits(time, MOST_PRINTED))
            .map_err(|(failure, lines)| failed(failure.to_string(), lines))?;
        let printed = |name: &str| fs::read(scratch.path().join(name)).unwrap_or_default();
        if ended.code != 0 {
            return Err(failed(format!("ended with {}", ended.code), ended.last_lines));
        }
        let (screen, errors) = (printed(SCREEN), printed(ERRORS));
        Ok(String::from_utf8_lossy(if screen.is_empty() { &errors } else { &screen }).into_owned())
    }

    /// Executes the command `prepare` once.
    fn prepare(&self) -> Result<(), RunError> {
        let done = self.prepared.get_or_init(|| self.aside(&self.manifest.prepare, FOR_PREPARATION).map(drop));
        done.clone().map_err(|reason| RunError::NotAvailable { solver: self.name(), reason })
    }

    /// Returns the folder of the manifest.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns a hash of the adapter, which is the same on every machine. It covers the files in the folder of the
    /// manifest and its subfolders, and the files that the manifest lists. The file of stored results is excluded.
    ///
    /// # Errors
    /// If a file cannot be read or the folder has too many files.
    pub fn fingerprint(&self) -> io::Result<String> {
        self.hash(&self.own_files()?)
    }

    /// Returns a hash of the adapter, and of the executables and other files that its commands name.
    ///
    /// The command `prepare` is executed first, because it may write some of these files.
    ///
    /// # Errors
    /// If a file cannot be read or the folder of the manifest has too many files. The error is a message.
    pub fn edition(&self) -> Result<String, String> {
        let ask = || {
            // Errors of `prepare` are reported by the runs.
            let _ = self.prepare();
            let hash = self.files().and_then(|files| self.hash(&files));
            hash.map_err(|error| format!("{}: {error}", self.folder.display()))
        };
        self.edition.get_or_init(ask).clone()
    }

    /// Returns the files that [`Self::edition`] covers.
    ///
    /// # Errors
    /// If a folder cannot be read or the folder of the manifest has too many files.
    pub fn files(&self) -> io::Result<Vec<PathBuf>> {
        let mut files = self.own_files()?;
        for command in [&self.manifest.prepare, &self.manifest.run, &self.manifest.worker] {
            let Some(name) = command.first() else { continue };
            files.extend(self.executable(name));
            let words = self.words(command, Path::new(""), Path::new("")).into_iter().map(PathBuf::from);
            files.extend(words.filter(|path| path.is_absolute() && path.is_file()));
        }
        Ok(files)
    }

    /// Returns the files in the folder of the manifest and its subfolders, and the files that the manifest lists.
    fn own_files(&self) -> io::Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        let mut open = vec![self.folder.clone()];
        while let Some(folder) = open.pop() {
            for entry in fs::read_dir(&folder)? {
                let path = entry?.path();
                if path.is_file() {
                    files.push(path);
                } else if path.is_dir() && !is_derived(&path) {
                    open.push(path);
                }
            }
            if files.len() > MOST_FILES {
                let message = format!("expected at most {MOST_FILES} files in the folder of the manifest, found more");
                return Err(io::Error::other(message));
            }
        }
        files.retain(|path| path.file_name().is_none_or(|name| name != STORED));
        files.sort();
        files.extend(self.manifest.files.iter().map(|file| self.folder.join(file)));
        Ok(files)
    }

    /// Returns the hash of the names and contents of files.
    fn hash(&self, files: &[PathBuf]) -> io::Result<String> {
        let mut hash = blake3::Hasher::new();
        for path in files {
            let within = path.strip_prefix(&self.folder).ok().filter(|path| !path.starts_with(".."));
            let name = within.unwrap_or(Path::new(path.file_name().unwrap_or_default())).to_string_lossy();
            let text = fs::read(path)?;
            hash.update(format!("{name} {}\n", text.len()).as_bytes()).update(&text);
        }
        Ok(hash.finalize().to_hex()[..32].to_owned())
    }

    /// Returns the first line that the version command prints, or `None` if there is no such command or it fails.
    #[must_use]
    pub fn version(&self) -> Option<String> {
        let ask = || {
            let printed = self.aside(&self.manifest.version, FOR_VERSION).ok()?;
            printed.lines().map(str::trim).find(|line| !line.is_empty()).map(one_line)
        };
        self.version.get_or_init(ask).clone()
    }

    /// Returns the path of the executable of a run or a worker.
    fn program(&self) -> Result<PathBuf, RunError> {
        let found = self.executable(&self.manifest.command()[0]);
        found.map_err(|reason| RunError::NotAvailable { solver: self.name(), reason })
    }

    /// Returns the input files, command and limits for the run of a scene.
    fn launch(&self, given: &DiscretizedScene<'_>) -> Result<Launch<'_>, RunError> {
        let Manifest { scene: format, worker, limits, output, .. } = &self.manifest;
        let not_run = |reason: String| {
            let (failure, last_lines) = (Failure::NotRun(reason), Vec::new());
            RunError::Program { solver: self.name(), failure, last_lines }
        };
        let text = Resolved::new(given).text(*format).map_err(not_run)?;
        let bytes = text.len() as u64 + MOST_PRINTED + most_bytes(given.scene, given.stepping);
        let ending = if *format == SceneFormat::Json { "json" } else { "toml" };
        let report = Protocol::Report(output.report.as_deref());
        Ok(Launch {
            solver: self.name(),
            stepping: given.stepping,
            files: vec![(format!("{SCENE}.{ending}"), text)],
            executable: self.program()?,
            arguments: self.words(self.manifest.command(), Path::new("{scene}"), Path::new("{out}")),
            limits: self.limits(Duration::from_secs(limits.seconds), bytes),
            protocol: if worker.is_empty() { report } else { Protocol::Worker(&self.idle) },
        })
    }

    /// Returns the wall-clock time of a run without steps (s), or 0 if this run fails. It is measured once per number
    /// of grains.
    fn start_up(&self, given: &DiscretizedScene<'_>) -> f64 {
        let grains = given.scene.grains.len();
        let times = || self.start_up.lock().unwrap_or_else(PoisonError::into_inner);
        let known = times().get(&grains).copied();
        known.unwrap_or_else(|| {
            let stepping = Stepping { steps: 0, interval: 1, ..given.stepping };
            let launch = self.launch(&DiscretizedScene { stepping, ..*given });
            let run = launch.and_then(|launch| execution::execute(&launch));
            let seconds = run.map_or(0.0, |finished| finished.seconds);
            times().insert(grains, seconds);
            seconds
        })
    }

    fn observe(&self, scene: &Scene, stepping: &Stepping, folder: &Path) -> Result<DumpRecord, Failure> {
        let Output { grains, contacts, series, .. } = &self.manifest.output;
        let mut observed = match grains.as_ref().filter(|_| !scene.grains.is_empty()) {
            Some(grains) => observe_grains(scene, stepping, folder, (grains, contacts.as_deref()))?,
            None => DumpRecord::without_grains(stepping),
        };
        if let Some(name) = series {
            let table = read_table(&plain_file(folder, name)?).map_err(output)?;
            let wrong = |expected: String, found: String| {
                Failure::Output(format!("{name}: expected {expected}, found {found}"))
            };
            if table.rows() != observed.series.time.len() {
                let samples = observed.series.time.len();
                return Err(wrong(format!("a row for each of {samples} samples"), table.rows().to_string()));
            }
            for (at, column) in table.columns.iter().enumerate() {
                observed.add(scene, &column.name, table.values(at).collect());
            }
        }
        Ok(observed)
    }
}

/// Returns true for a folder that contains no sources of the adapter: hidden folders, caches, Python environments, and
/// outputs and plans of this program.
fn is_derived(folder: &Path) -> bool {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let has = |file: &str| folder.join(file).is_file();
    name.starts_with('.')
        || name == "__pycache__"
        || has("CACHEDIR.TAG")
        || has("pyvenv.cfg")
        || has("plan.toml") && has("tasks.jsonl")
        || has("index.html") && has("manifest.json")
}

/// Reads the grains of a run, and their contacts if the program writes them.
fn observe_grains(
    scene: &Scene,
    stepping: &Stepping,
    folder: &Path,
    (grains, contacts): (&Grains, Option<&str>),
) -> Result<DumpRecord, Failure> {
    let names = Names(grains.map.clone().into_iter().collect());
    let observed = match grains.format {
        GrainFormat::Csv => {
            let path = plain_file(folder, &grains.path)?;
            observe_table(scene, &path, &grains.path, &names, stepping).map_err(|error| error.to_string())
        }
        GrainFormat::Lammps | GrainFormat::Npz | GrainFormat::Vtk => {
            let mut files = if grains.format == GrainFormat::Vtk {
                of_pattern(folder, &grains.path)?
            } else {
                vec![plain_file(folder, &grains.path)?]
            };
            files.extend(contacts.map(|name| plain_file(folder, name)).transpose()?);
            let rows = scene.grains.len() * (16 + scene.walls.len());
            let time_step = Some(stepping.time_step);
            let most_rows = Some(rows as u64);
            let recorder = Recorder::new(scene, stepping.time_step, stepping.steps);
            let snapshot_steps = recorder.snapshot_steps().to_vec();
            let sources = Sources { files, names, time_step, most_rows, snapshot_steps, ..Sources::default() };
            Outputs::survey(sources).and_then(|outputs| outputs.observe(scene)).map_err(|error| error.to_string())
        }
    };
    // The path of the folder is removed from the reason, because the folder is temporary.
    observed.map_err(|reason| Failure::Output(reason.replace(&format!("{}/", folder.display()), "")))
}

/// Returns the quantities of a scene from the table at a path, and the snapshots that the scene requests. `name` is the
/// name of the table in error messages.
fn observe_table(
    scene: &Scene,
    path: &Path,
    name: &str,
    names: &Names,
    stepping: &Stepping,
) -> Result<DumpRecord, ReadError> {
    let table = read_table(path)?;
    refuse_other_spins(&table, name, names)?;
    let time_step = stepping.time_step;
    let steps = steps(&table, name, names, time_step)?;
    let recorder = Recorder::new(scene, time_step, stepping.steps);
    let mut observer = DumpObserver::new(scene, recorder.snapshot_steps());
    let (mut row, mut last) = (0, None);
    while row < table.rows() {
        let step = steps[row];
        let rows = steps[row..].iter().take_while(|other| **other == step).count();
        if let Some(before) = last.filter(|before| step <= *before) {
            let expected = format!("a step after {before}");
            return Err(ReadError::at(name, row as u64 + 2, expected, step.to_string()));
        }
        let snapshot =
            DumpSnapshot { step, table: table.part(row, rows), first_line: row as u64 + 2, ..DumpSnapshot::default() };
        observer.take(name, &snapshot, names, step as f64 * time_step, None)?;
        (row, last) = (row + rows, Some(step));
    }
    Ok(observer.finish())
}

/// Refuses columns that have usual names of spins, if the columns of spins are absent. Otherwise the spins would count as
/// not written.
fn refuse_other_spins(table: &Table, name: &str, names: &Names) -> Result<(), ReadError> {
    for axis in ["x", "y", "z"] {
        let right = format!("omega{axis}");
        let usual = ["w", "omega_", "w_", "spin", "spin_"].map(|start| format!("{start}{axis}"));
        let found = usual.iter().find(|usual| table.column(usual).is_some());
        if let (None, Some(found)) = (table.column(names.in_file(&right)), found) {
            let expected = format!("the column `{right}`, or its name in `output.grains.map`");
            return Err(ReadError::at(name, 1, expected, format!("`{found}`")));
        }
    }
    Ok(())
}

/// Returns the step of every row, from a column `step` or from the times.
fn steps(table: &Table, name: &str, names: &Names, time_step: f64) -> Result<Vec<u64>, ReadError> {
    if let Some(column) = table.column(names.in_file("step")) {
        let whole = |step: f64| if step >= 0.0 && step.fract() == 0.0 { Ok(step as u64) } else { Err(step) };
        let steps: Result<Vec<u64>, f64> = table.values(column).map(whole).collect();
        return steps.map_err(|step| ReadError::at(name, 1, "whole numbers of steps, zero or more", step.to_string()));
    }
    let Some(column) = ["time", "t"].into_iter().find_map(|time| table.column(names.in_file(time))) else {
        return Err(ReadError::at(name, 1, "a column `step` or `time`", quoted_names(&table.columns)));
    };
    let step = |time: f64| {
        let step = (time / time_step).round();
        // If a program adds up its time steps, its times have a rounding error.
        if (time - step * time_step).abs() <= 1e-3 * time_step { Ok(step as u64) } else { Err(time) }
    };
    let steps: Result<Vec<u64>, f64> = table.values(column).map(step).collect();
    steps.map_err(|time| {
        ReadError::at(name, 1, format!("times that are multiples of the time step {time_step} s"), format!("{time} s"))
    })
}

/// Returns the files in the folder that match a pattern with `*`, or the single file of a path without `*`.
fn of_pattern(folder: &Path, pattern: &str) -> Result<Vec<PathBuf>, Failure> {
    let Some((before, after)) = pattern.split_once('*') else { return Ok(vec![plain_file(folder, pattern)?]) };
    let entries = fs::read_dir(folder).map_err(|error| Failure::Output(error.to_string()))?;
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let is_one =
        |name: &String| name.len() > before.len() + after.len() && name.starts_with(before) && name.ends_with(after);
    let files: Result<Vec<PathBuf>, Failure> = names.filter(is_one).map(|name| plain_file(folder, &name)).collect();
    match files? {
        files if files.is_empty() => Err(Failure::Output(format!("{pattern}: expected a file, found none"))),
        files => Ok(files),
    }
}

impl Solver for ExternalProgram {
    fn name(&self) -> String {
        self.manifest.name.clone()
    }

    fn has_springs(&self) -> bool {
        self.manifest.can.laws.iter().any(|law| *law != SpringsKind::Coulomb)
    }

    fn deforms(&self) -> bool {
        !self.manifest.can.deformable.is_empty()
    }

    fn available(&self) -> Result<(), RunError> {
        self.prepare()?;
        self.program().map(drop)
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let cannot = |reason: String| RunError::Unsupported { solver: self.name(), reason };
        if let Some(reason) = can::lacks(&self.manifest, scene, resolution) {
            return Err(cannot(reason));
        }
        let given = DiscretizedScene::new(scene, resolution)
            .map_err(|reason| RunError::Resolution { solver: self.name(), reason })?;
        self.prepare()?;
        let stepping = given.stepping;
        let read = |folder: &Path, _| Ok((self.observe(scene, &stepping, folder)?, ()));
        let finish = |reported: Option<f64>, elapsed: f64, ()| {
            (reported.unwrap_or_else(|| (elapsed - self.start_up(&given)).max(0.0)), self.version())
        };
        execution::run(&self.launch(&given)?, (scene, resolution), observer, read, finish)
    }
}
