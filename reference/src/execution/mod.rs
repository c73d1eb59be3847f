//! Runs of external programs: input files are written to a scratch folder, one process is started, and its output is
//! read.
//!
//! LAMMPS and LIGGGHTS ([`crate::live`]) and programs with a manifest ([`crate::outside`]) share this code. They differ
//! only in [`Launch`] and in the readers of their output.

pub(crate) mod process;
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
use serde::Deserialize;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tempfile::TempDir;

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

/// Answer of a program after its run. Workers print it as JSON.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Answer {
    /// The run succeeded.
    Ran(Times),
    /// The program cannot express the scene, for this reason.
    Cannot(String),
    /// The run failed.
    Failed(FailureReport),
    /// The run failed with this exit code.
    #[serde(skip)]
    Ended(i32),
}

/// Times in an answer.
#[derive(Deserialize)]
struct Times {
    /// Solution time (s); `None` if the program does not report it.
    seconds: Option<f64>,
}

/// Result of a program that ended without a signal and within its limits.
pub(crate) struct Execution {
    folder: TempDir,
    answer: Answer,
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
    let Execution { folder, answer, last_lines, seconds } = execute(launch)?;
    let fail = |failure| RunError::Program { solver: solver.clone(), failure, last_lines: last_lines.clone() };
    let reported = match answer {
        Answer::Ran(Times { seconds: Some(seconds) }) if !is_a_time(seconds) => {
            return Err(fail(Failure::Output(format!("expected seconds of zero or more, found {seconds}"))));
        }
        Answer::Ran(Times { seconds }) => seconds,
        Answer::Cannot(reason) => {
            return Err(RunError::Unsupported { solver: solver.clone(), reason: one_line(&reason) });
        }
        Answer::Failed(failed) => return Err(fail(Failure::Crash(failed.words()))),
        Answer::Ended(code) => return Err(fail(Failure::Crash(format!("exit status: {code}")))),
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
    let (answer, last_lines) = if let Protocol::Worker(idle) = protocol {
        let idle = || idle.lock().unwrap_or_else(PoisonError::into_inner);
        let waiting = idle().pop();
        let worker = waiting.map_or_else(|| Worker::start(executable, &arguments, *limits), Ok);
        let mut worker = worker.map_err(|failure| fail((failure, Vec::new())))?;
        // The start of the worker is not timed, because later runs do not need it.
        start = Instant::now();
        let answer = worker.ask(&scene, out, *limits);
        let last_lines = worker.last_lines();
        let answer = answer.map_err(|failure| fail((failure, last_lines.clone())))?;
        idle().push(worker);
        (answer, last_lines)
    } else {
        let errors_apart = matches!(protocol, Protocol::Report(_));
        let started = ProcessStart { executable, arguments: &arguments, folder: out, at: None, errors_apart };
        let ended = process::run(&started, *limits).map_err(fail)?;
        let answer = answer_of(&ended, protocol, out);
        (answer.map_err(|failure| fail((failure, ended.last_lines.clone())))?, ended.last_lines)
    };
    Ok(Execution { folder, answer, last_lines, seconds: start.elapsed().as_secs_f64() })
}

/// Returns the answer of a process from its exit code, its report and its standard output in the folder.
fn answer_of(ended: &ProcessEnd, protocol: &Protocol<'_>, folder: &Path) -> Result<Answer, Failure> {
    let report = match protocol {
        Protocol::Report(Some(name)) => read_report(&folder.join(name), name)?,
        _ => ProgramReport::default(),
    };
    if ended.code == CANNOT && matches!(protocol, Protocol::Report(_)) {
        let screen = fs::read(folder.join(SCREEN)).unwrap_or_default();
        let screen = String::from_utf8_lossy(&screen).into_owned();
        let reason = screen.lines().map(str::trim).find(|line| !line.is_empty()).map(str::to_owned);
        let none = || format!("it ended with exit code {CANNOT} and gave no reason");
        return Ok(Answer::Cannot(reason.unwrap_or_else(none)));
    }
    Ok(match report.failed {
        Some(failed) => Answer::Failed(failed),
        None if ended.code != 0 => Answer::Ended(ended.code),
        None => Answer::Ran(Times { seconds: report.seconds.map(|seconds| seconds.solve) }),
    })
}

/// Maximum size of a report (B).
const MOST_REPORTED: u64 = 1 << 20;

/// Report of a program. Unknown keys are ignored.
#[derive(Clone, Debug, Default, Deserialize)]
struct ProgramReport {
    /// Times that the program measured (s).
    seconds: Option<Seconds>,
    /// Description of a failure.
    failed: Option<FailureReport>,
}

/// Times in a report (s).
#[derive(Clone, Copy, Debug, Deserialize)]
struct Seconds {
    /// Solution time without start-up (s).
    solve: f64,
}

/// Returns true if a time (s) is finite and not negative.
fn is_a_time(seconds: f64) -> bool {
    seconds.is_finite() && seconds >= 0.0
}

/// Time, position and reason of a failure. Each value can be any JSON value.
#[derive(Clone, Debug, Deserialize)]
struct FailureReport {
    when: Option<Value>,
    #[serde(rename = "where")]
    place: Option<Value>,
    why: Option<Value>,
}

impl FailureReport {
    /// Returns the failure as text.
    fn words(&self) -> String {
        let text = |value: &Option<Value>| {
            value.as_ref().map_or_else(|| "unknown".to_owned(), |value| one_line(&value.to_string()))
        };
        let [when, place, why] = [&self.when, &self.place, &self.why].map(text);
        format!("the program reports: time {when}, place {place}, cause {why}")
    }
}

/// Reads a report. Returns an empty report if the file does not exist.
fn read_report(path: &Path, name: &str) -> Result<ProgramReport, Failure> {
    let wrong = |expected: &str, found: String| Failure::Output(format!("{name}: expected {expected}, found {found}"));
    match fs::symlink_metadata(path) {
        Err(_) => return Ok(ProgramReport::default()),
        Ok(found) if !found.is_file() || found.len() > MOST_REPORTED => {
            return Err(wrong("a plain file of at most a megabyte", "something else".to_owned()));
        }
        Ok(_) => {}
    }
    let text = fs::read(path).map_err(|error| wrong("a file that can be read", error.to_string()))?;
    let report: ProgramReport =
        serde_json::from_slice(&text).map_err(|error| wrong("a report", one_line(&error.to_string())))?;
    match report.seconds.filter(|seconds| !is_a_time(seconds.solve)) {
        Some(Seconds { solve }) => Err(wrong("seconds.solve of zero or more", solve.to_string())),
        None => Ok(report),
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
