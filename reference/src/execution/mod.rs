//! Runs of external programs: input files are written to a scratch folder, one process is started, and its output is
//! read.
//!
//! LAMMPS and LIGGGHTS ([`crate::live`]) and programs with a manifest ([`crate::outside`]) share this code. They differ
//! only in [`Launch`] and in the readers of their output.

pub(crate) mod process;
mod report;
mod worker;

pub(crate) use worker::Worker;

use crate::deck::Stepping;
use crate::observer::DumpRecord;
use crate::read::read_error::{ReadError, one_line};
use grainbench_scene::scene::Scene;
use grainbench_solver::failure::{Failure, RunError};
use grainbench_solver::observer::{Observer, RunOutline};
use grainbench_solver::record::{Cost, Provenance, Record, Series};
use grainbench_solver::reduction::reduce;
use grainbench_solver::resolution::Resolution;
use process::{Deadline, Limits, ProcessEnd, ProcessStart, SCREEN};
use report::is_a_time;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tempfile::TempDir;
use worker::{Answer, Times};

/// Exit code of a program that cannot express a scene.
pub const CANNOT: i32 = 64;

pub(crate) struct Launch<'p> {
    pub(crate) solver: String,
    pub(crate) stepping: Stepping,
    /// Name and text of each input file.
    pub(crate) files: Vec<(String, String)>,
    pub(crate) executable: PathBuf,
    /// Command-line arguments. `{scene}` is replaced by the path of the first input file, and `{out}` by the path of
    /// the folder of the run.
    pub(crate) arguments: Vec<String>,
    /// Limits of the run. The time limit has already started.
    pub(crate) limits: Limits,
    pub(crate) protocol: Protocol<'p>,
}

pub(crate) enum Protocol<'p> {
    /// The exit code is 0 after a successful run.
    ExitCode,
    /// The exit code is 0 after a successful run, and [`CANNOT`] if the program cannot express the scene. If the name of
    /// a report is given, the program may write this file.
    Report(Option<&'p str>),
    /// A worker answers one request after the other. The list contains the workers that wait for a request.
    Worker(&'p Mutex<Vec<Worker>>),
}

/// Message of a program about its run.
enum ProgramMessage {
    /// The run succeeded. The solution time (s) is present if the program reports it.
    Ran(Option<f64>),
    /// The program cannot express the scene, for this reason.
    Cannot(String),
    Failed(Failure),
}

/// Result of a program that ended without a signal and within its limits.
pub(crate) struct Execution {
    folder: TempDir,
    message: ProgramMessage,
    last_lines: Vec<String>,
    /// Wall-clock time of the execution (s).
    pub(crate) seconds: f64,
}

/// Runs a program and returns its record.
///
/// `read` reads the output in the folder until the deadline and may return further data. `finish` returns the time of
/// the run (s) and the version of the program. The arguments of `finish` are the time that the program reports (s), the
/// elapsed time (s) and the further data.
pub(crate) fn run<T>(
    launch: &Launch<'_>,
    (scene, resolution): (&Scene, &Resolution),
    observer: &mut dyn Observer,
    read: impl FnOnce(&Path, Deadline) -> Result<(DumpRecord, T), Failure>,
    finish: impl FnOnce(Option<f64>, f64, T) -> (f64, Option<String>),
) -> Result<Record, RunError> {
    let Launch { solver, stepping, .. } = launch;
    let particles = scene.grains.len() as u64;
    observer.begin(RunOutline { time_step: stepping.time_step, steps: stepping.steps, particles });
    let Execution { folder, message, last_lines, seconds } = execute(launch)?;
    let fail = |failure| RunError::Program { solver: solver.clone(), failure, last_lines: last_lines.clone() };
    let reported = match message {
        ProgramMessage::Ran(seconds) => seconds,
        ProgramMessage::Cannot(reason) => return Err(RunError::Unsupported { solver: solver.clone(), reason }),
        ProgramMessage::Failed(failure) => return Err(fail(failure)),
    };
    let (mut observed, further) = read(folder.path(), launch.limits.deadline).map_err(fail)?;
    observed.snapshots.iter_mut().for_each(|snapshot| reduce(snapshot, &scene.columns));
    complete(&observed.series, *stepping).map_err(|missing| fail(Failure::Output(missing)))?;
    observer.progress(stepping.steps, stepping.steps);
    let (seconds, version) = finish(reported, seconds, further);
    let options = version.into_iter().collect();
    Ok(Record {
        provenance: Provenance::new(scene, solver.clone(), resolution, stepping.time_step, options),
        series: observed.series,
        snapshots: observed.snapshots,
        cost: Cost::of_program(stepping.steps, scene.grains.len(), seconds),
    })
}

/// Starts a program in a new folder with its input files, and waits for the end of the run.
pub(crate) fn execute(launch: &Launch<'_>) -> Result<Execution, RunError> {
    let Launch { solver, files, executable, limits, protocol, .. } = launch;
    let fail = |(failure, last_lines)| RunError::Program { solver: solver.clone(), failure, last_lines };
    let texts = files.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let folder = process::scratch(texts).map_err(|error| fail((Failure::NotRun(error.to_string()), Vec::new())))?;
    let (out, scene) = (folder.path(), folder.path().join(&files[0].0));
    let replaced =
        |word: &String| word.replace("{scene}", &scene.to_string_lossy()).replace("{out}", &out.to_string_lossy());
    let arguments: Vec<String> = launch.arguments.iter().map(replaced).collect();
    let mut start = Instant::now();
    let (message, last_lines) = if let Protocol::Worker(idle) = protocol {
        let idle = || idle.lock().unwrap_or_else(PoisonError::into_inner);
        let waiting = idle().pop();
        let worker = waiting.map_or_else(|| Worker::start(executable, &arguments, *limits), Ok);
        let mut worker = worker.map_err(|failure| fail((failure, Vec::new())))?;
        // The start of the worker is not timed, because later runs do not need it.
        start = Instant::now();
        let answer = worker.ask(&scene, out, *limits).map_err(fail)?;
        let last_lines = worker.last_lines();
        idle().push(worker);
        (ProgramMessage::from_answer(answer), last_lines)
    } else {
        let errors_apart = matches!(protocol, Protocol::Report(_));
        let started = ProcessStart { executable, arguments: &arguments, folder: out, at: None, errors_apart };
        let ended = process::run(&started, *limits).map_err(fail)?;
        let message = ProgramMessage::from_process(&ended, protocol, out);
        (message.map_err(|failure| fail((failure, ended.last_lines.clone())))?, ended.last_lines)
    };
    Ok(Execution { folder, message, last_lines, seconds: start.elapsed().as_secs_f64() })
}

impl ProgramMessage {
    /// Returns the message of a process from its exit code, its report and its standard output in the folder.
    fn from_process(ended: &ProcessEnd, protocol: &Protocol<'_>, folder: &Path) -> Result<Self, Failure> {
        let report = match protocol {
            Protocol::Report(Some(name)) => report::read(&folder.join(name), name)?,
            _ => report::ProgramReport::default(),
        };
        if ended.code == CANNOT && matches!(protocol, Protocol::Report(_)) {
            let screen = fs::read(folder.join(SCREEN)).unwrap_or_default();
            let screen = String::from_utf8_lossy(&screen).into_owned();
            let reason = screen.lines().map(str::trim).find(|line| !line.is_empty()).map(one_line);
            return Ok(Self::Cannot(
                reason.unwrap_or_else(|| format!("it ended with exit code {CANNOT} and gave no reason")),
            ));
        }
        Ok(match report.failed {
            Some(failed) => Self::Failed(Failure::Crash(failed.words())),
            None if ended.code != 0 => Self::Failed(Failure::Crash(format!("exit status: {}", ended.code))),
            None => Self::Ran(report.seconds.map(|seconds| seconds.solve)),
        })
    }

    /// Returns the message of a worker from its answer.
    fn from_answer(answer: Answer) -> Self {
        match answer {
            Answer::Ran(Times { seconds: Some(seconds) }) if !is_a_time(seconds) => {
                Self::Failed(Failure::Output(format!("expected seconds of zero or more, found {seconds}")))
            }
            Answer::Ran(Times { seconds }) => Self::Ran(seconds),
            Answer::Cannot(reason) => Self::Cannot(one_line(&reason)),
            Answer::Failed(failed) => Self::Failed(Failure::Crash(failed.words())),
        }
    }
}

/// Returns the maximum size of the files of a run (B).
///
/// The size is 64 MiB plus 4 KiB per sample and grain. This is four times the size of the columns of a grain and of a
/// dozen contacts.
pub(crate) fn most_bytes(scene: &Scene, stepping: Stepping) -> u64 {
    let samples = stepping.steps / stepping.interval + 2;
    (64 << 20) + samples.saturating_mul(4096).saturating_mul(scene.grains.len() as u64)
}

/// Checks that a series has all samples of its run and only finite values.
fn complete(series: &Series, stepping: Stepping) -> Result<(), String> {
    let mut found = series.step.iter().copied();
    for step in stepping.samples() {
        match found.next() {
            Some(at) if at == step => {}
            Some(at) => return Err(format!("expected a sample at step {step}, found step {at}")),
            None => {
                let (last, steps) = (series.step.last().copied().unwrap_or_default(), stepping.steps);
                return Err(format!("expected samples to step {steps}, found the last sample at step {last}"));
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

/// Returns the failure of a run with an unreadable output file.
pub(crate) fn output(error: ReadError) -> Failure {
    Failure::Output(error.to_string())
}

/// Returns the path of an output file in the folder of a run. Links are refused, also among the folders in `name`.
/// Pipes are refused too, because reading from them could block forever.
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
        Ok(found) if !found.is_file() => {
            Err(Failure::Output(format!("{name}: expected a plain file, found something else")))
        }
        // A missing file is reported when it is opened.
        _ => Ok(path),
    }
}
