//! Runs of external programs: input files in a scratch folder, one process, its output and the record.
//!
//! LAMMPS and LIGGGHTS ([`crate::live`]) and programs with a manifest ([`crate::outside`]) have the same run. They
//! differ in their files, in the protocol of their processes and in the readers of their output ([`PreparedRun`]).

mod deadline;
pub(crate) mod process;
mod report;
mod worker;

pub(crate) use deadline::Deadline;
pub(crate) use worker::Worker;

use crate::deck::Stepping;
use crate::observer::DumpRecord;
use crate::read::log::Log;
use crate::read::read_error::{ReadError, one_line};
use grainbench_scene::record::{Cost, Provenance, Record, Series};
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Failure, Observer, Resolution, RunError, RunOutline};
use process::{Limits, ProcessEnd, ProcessStart, SCREEN};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tempfile::TempDir;
use worker::Answer;

/// Exit code of a program that cannot express a scene.
pub const CANNOT: i32 = 64;

/// Run of a program that can express the scene.
pub(crate) trait PreparedRun {
    /// Returns the time steps and the samples.
    fn stepping(&self) -> Stepping;
    /// Returns the name and the text of each input file.
    ///
    /// # Errors
    /// If a file cannot be written, with the reason.
    fn files(&self) -> Result<Vec<(String, String)>, String>;
    /// Returns the process of the run in a folder with the input files.
    ///
    /// # Errors
    /// If the program is not available.
    fn launch(&self, folder: &Path, files: &[(String, String)]) -> Result<Launch<'_>, RunError>;
    /// Reads the output of the program in a folder, and its log if it has one.
    ///
    /// # Errors
    /// If the output is not valid, or the time limit has expired.
    fn read(&self, folder: &Path, deadline: Deadline) -> Result<(DumpRecord, Option<Log>), Failure>;
    /// Returns the time of a run with zero steps (s), for programs without a log.
    fn start_up(&self) -> f64 {
        0.0
    }
    /// Returns the version, for programs without a log.
    fn version(&self) -> Option<String> {
        None
    }
}

/// Process of a run.
pub(crate) struct Launch<'p> {
    /// Path of the program.
    pub(crate) executable: PathBuf,
    /// Command-line arguments.
    pub(crate) arguments: Vec<String>,
    /// Limits, including the time limit, which has started.
    pub(crate) limits: Limits,
    /// Protocol of the process.
    pub(crate) protocol: Protocol<'p>,
}

/// Protocol of a process.
pub(crate) enum Protocol<'p> {
    /// The exit code is 0 after a run.
    ExitCode,
    /// The exit code is 0 after a run and [`CANNOT`] if the program cannot express the scene. The program may write a
    /// report with this name.
    Report(Option<&'p str>),
    /// Workers answer one request after the other. The list contains those that wait for a run, and the path is the
    /// file with the scene.
    Worker(&'p Mutex<Vec<Worker>>, PathBuf),
}

/// Message of a program about its run.
enum ProgramMessage {
    /// The run succeeded. The time (s) is present if the program reports it.
    Ran(Option<f64>),
    /// The program cannot express the scene, for this reason.
    Cannot(String),
    Failed(Failure),
}

/// Execution that ended regularly.
pub(crate) struct Execution {
    folder: TempDir,
    deadline: Deadline,
    message: ProgramMessage,
    last_lines: Vec<String>,
    /// Elapsed time (s).
    pub(crate) seconds: f64,
}

/// Runs a program and returns the record of a solver with this name.
pub(crate) fn run(
    prepared: &dyn PreparedRun,
    solver: String,
    scene: &Scene,
    resolution: &Resolution,
    observer: &mut dyn Observer,
) -> Result<Record, RunError> {
    let stepping = prepared.stepping();
    let particles = scene.grains.len() as u64;
    observer.begin(RunOutline { time_step: stepping.time_step, steps: stepping.steps, particles });
    let Execution { folder, deadline, message, last_lines, seconds } = execute(prepared, &solver)?;
    let fail = |failure| RunError::Program { solver: solver.clone(), failure, last_lines: last_lines.clone() };
    let reported = match message {
        ProgramMessage::Ran(seconds) => seconds,
        ProgramMessage::Cannot(reason) => return Err(RunError::Unsupported { solver, reason }),
        ProgramMessage::Failed(failure) => return Err(fail(failure)),
    };
    let (mut observed, log) = prepared.read(folder.path(), deadline).map_err(fail)?;
    observed.snapshots.iter_mut().for_each(|snapshot| scene.columns.keep(snapshot));
    complete(&observed.series, stepping).map_err(|missing| fail(Failure::Output(missing)))?;
    observer.progress(stepping.steps, stepping.steps);
    let (seconds, version) = match log {
        Some(log) => (log.seconds(), log.version),
        None => {
            let seconds = reported.unwrap_or_else(|| (seconds - prepared.start_up()).max(0.0));
            (seconds, prepared.version())
        }
    };
    let options = version.into_iter().collect();
    Ok(Record {
        provenance: Provenance::new(scene, solver, resolution, stepping.time_step, options),
        series: observed.series,
        snapshots: observed.snapshots,
        cost: Cost::of_program(stepping.steps, scene.grains.len(), seconds),
    })
}

/// Starts a program in a new folder with its files, and waits until its run ends.
pub(crate) fn execute(prepared: &dyn PreparedRun, solver: &str) -> Result<Execution, RunError> {
    let fail = |(failure, last_lines)| RunError::Program { solver: solver.to_owned(), failure, last_lines };
    let not_run = |reason: String| fail((Failure::NotRun(reason), Vec::new()));
    let files = prepared.files().map_err(not_run)?;
    let texts = files.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let folder = process::scratch(texts).map_err(|error| not_run(error.to_string()))?;
    let Launch { executable, arguments, limits, protocol } = prepared.launch(folder.path(), &files)?;
    let mut start = Instant::now();
    let (message, last_lines) = match protocol {
        Protocol::Worker(idle, scene) => {
            let idle = || idle.lock().unwrap_or_else(PoisonError::into_inner);
            let waiting = idle().pop();
            let worker = waiting.map_or_else(|| Worker::start(&executable, &arguments, limits), Ok);
            let mut worker = worker.map_err(|failure| fail((failure, Vec::new())))?;
            // The start of the worker does not count, because later runs do not need it.
            start = Instant::now();
            let answer = worker.ask(&scene, folder.path(), limits).map_err(fail)?;
            let last_lines = worker.last_lines();
            idle().push(worker);
            (ProgramMessage::from_answer(answer), last_lines)
        }
        Protocol::ExitCode | Protocol::Report(_) => {
            let errors_apart = matches!(protocol, Protocol::Report(_));
            let (executable, arguments) = (executable.as_path(), arguments.as_slice());
            let started = ProcessStart { executable, arguments, folder: folder.path(), at: None, errors_apart };
            let ended = process::run(&started, limits).map_err(fail)?;
            let message = ProgramMessage::from_process(&ended, &protocol, folder.path());
            (message.map_err(|failure| fail((failure, ended.last_lines.clone())))?, ended.last_lines)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    Ok(Execution { folder, deadline: limits.deadline, message, last_lines, seconds })
}

impl ProgramMessage {
    /// Returns the message that follows from the exit code, the report and the printed text in the folder.
    fn from_process(ended: &ProcessEnd, protocol: &Protocol<'_>, folder: &Path) -> Result<Self, Failure> {
        let report = match protocol {
            Protocol::Report(Some(name)) => report::read(&folder.join(name), name)?,
            _ => report::ProgramReport::default(),
        };
        if ended.code == CANNOT && matches!(protocol, Protocol::Report(_)) {
            let screen = fs::read(folder.join(SCREEN)).unwrap_or_default();
            let screen = String::from_utf8_lossy(&screen).into_owned();
            let reason = screen.lines().map(str::trim).find(|line| !line.is_empty()).map(one_line);
            return Ok(Self::Cannot(reason.unwrap_or_else(|| format!("it ended with {CANNOT} without a reason"))));
        }
        Ok(match report.failed {
            Some(failed) => Self::Failed(Failure::Crash(failed.words())),
            None if ended.code != 0 => Self::Failed(Failure::Crash(format!("exit status: {}", ended.code))),
            None => Self::Ran(report.seconds.map(|seconds| seconds.solve)),
        })
    }

    /// Returns the message that follows from the answer of a worker.
    fn from_answer(answer: Answer) -> Self {
        match answer {
            Answer::Ran(times) => match times.seconds() {
                Ok(seconds) => Self::Ran(seconds.map(|seconds| seconds.solve)),
                Err(failure) => Self::Failed(failure),
            },
            Answer::Cannot(reason) => Self::Cannot(one_line(&reason)),
            Answer::Failed(failed) => Self::Failed(Failure::Crash(failed.words())),
        }
    }
}

/// Returns the maximum size of the files of a run (B).
///
/// It contains 64 MiB for the start and 4 KiB per sample and grain. This is four times the size of its columns and a
/// dozen contacts.
pub(crate) fn most_bytes(scene: &Scene, stepping: Stepping) -> u64 {
    let samples = stepping.steps / stepping.interval + 2;
    (64 << 20) + samples.saturating_mul(4096).saturating_mul(scene.grains.len() as u64)
}

/// Returns an error if a series lacks a sample of its deck or has a value that is not finite.
pub(crate) fn complete(series: &Series, stepping: Stepping) -> Result<(), String> {
    let mut found = series.step.iter().copied();
    for step in stepping.samples() {
        match found.next() {
            Some(at) if at == step => {}
            Some(at) => return Err(format!("expected a sample at step {step}, found step {at}")),
            None => {
                let (last, steps) = (series.step.last().copied().unwrap_or_default(), stepping.steps);
                return Err(format!("expected samples to step {steps}, found the last at step {last}"));
            }
        }
    }
    for (column, values) in series.columns.iter().zip(&series.values) {
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let (name, step, value) = (&column.name, series.step[at], values[at]);
            return Err(format!("expected finite numbers, found {name} = {value} at step {step}"));
        }
    }
    Ok(())
}

/// Returns the failure of a run whose file cannot be read.
pub(crate) fn output(error: ReadError) -> Failure {
    Failure::Output(error.to_string())
}

/// Returns the path of a file that a run wrote in a folder. Links are refused, including those to parent folders.
/// Pipes are refused, because reading them could block forever.
pub(crate) fn plain_file(folder: &Path, name: &str) -> Result<PathBuf, Failure> {
    let path = folder.join(name);
    let between = Path::new(name).ancestors().skip(1).filter(|part| !part.as_os_str().is_empty());
    for part in between {
        if fs::symlink_metadata(folder.join(part)).is_ok_and(|found| !found.is_dir()) {
            let part = part.display();
            return Err(Failure::Output(format!("{name}: expected the folder {part}, found a link or a file")));
        }
    }
    match fs::symlink_metadata(&path) {
        Ok(found) if !found.is_file() => Err(Failure::Output(format!("{name}: expected a plain file, found none"))),
        // A missing file is reported when it is opened.
        _ => Ok(path),
    }
}
