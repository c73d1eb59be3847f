//! Execution of a program in a scratch folder within a time limit.

use std::env;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::sleep;
use std::time::{Duration, Instant};

use grainbench_solver::failure::Failure;
use tempfile::TempDir;

/// File with the standard output of a program.
pub(crate) const SCREEN: &str = "screen";
/// File with the standard error of a program, if it is separate from the standard output.
pub(crate) const ERRORS: &str = "errors";
/// Environment variable with the folder of a run, which identifies its processes.
const FOLDER: &str = "GRAINBENCH_FOLDER";
/// Maximum number of searches for processes of a run. Processes may start further processes while they are being
/// killed.
const SWEEPS: u32 = 20;
/// Number of last lines in a report.
const LAST_LINES: usize = 4;
/// Size of the end of a file that is searched for its last lines (B).
const END: u64 = 4096;

/// Returns the path of a program on `PATH`.
pub(crate) fn on_path(name: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    env::split_paths(&path).map(|folder| folder.join(name)).find(|path| path.is_file())
}

/// Creates a temporary folder with files of given names and texts. The folder is deleted when the value is dropped.
pub(crate) fn scratch<'f>(files: impl IntoIterator<Item = (&'f str, &'f str)>) -> io::Result<TempDir> {
    let folder = tempfile::Builder::new().prefix("grainbench-").tempdir()?;
    for (name, text) in files {
        fs::write(folder.path().join(name), text)?;
    }
    Ok(folder)
}

/// Program to start.
pub(crate) struct ProcessStart<'s> {
    pub(crate) executable: &'s Path,
    pub(crate) arguments: &'s [String],
    /// Folder of the output files, including standard output.
    pub(crate) folder: &'s Path,
    /// Working directory; `None` for `folder`.
    pub(crate) at: Option<&'s Path>,
    /// True to write standard error to [`ERRORS`] instead of [`SCREEN`].
    pub(crate) errors_apart: bool,
}

/// Regular end of a program, without a signal.
pub(crate) struct ProcessEnd {
    pub(crate) code: i32,
    /// Last lines of standard error, or of standard output if there are none.
    pub(crate) last_lines: Vec<String>,
}

/// Start and duration of a time limit. Reading of the output counts too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    start: Instant,
    limit: Duration,
}

impl Deadline {
    /// Returns a limit that starts now.
    pub(crate) fn after(limit: Duration) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// Returns an error if the limit has expired.
    pub(crate) fn check(self) -> Result<(), Failure> {
        if self.start.elapsed() >= self.limit { Err(Failure::TimeOut(self.limit.as_secs())) } else { Ok(()) }
    }
}

/// Limits of a program run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Time at which the program must have ended.
    pub(crate) deadline: Deadline,
    /// Maximum size of all files in the folder (B).
    pub(crate) bytes: u64,
    /// Maximum address space of each process (KiB); `None` for no limit.
    pub(crate) memory: Option<u64>,
    /// Number of threads of the program.
    pub(crate) threads: u16,
}

impl Limits {
    /// Returns an error if the time limit has expired or our process was interrupted.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if INTERRUPT.get().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            HAS_ENDED.store(true, Ordering::Relaxed);
            return Err(Failure::Interrupted);
        }
        self.deadline.check()
    }
}

/// Flag that ends all running programs if it is set.
static INTERRUPT: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// True if a program was ended because of the flag.
static HAS_ENDED: AtomicBool = AtomicBool::new(false);

/// Registers the flag that ends running programs. Only the first call in a process counts.
pub fn end_programs_at(interrupt: Arc<AtomicBool>) {
    let _ = INTERRUPT.set(interrupt);
}

/// Returns true if an interrupt has ended a program. Later errors may be due to the interrupt.
#[must_use]
pub fn has_ended_programs() -> bool {
    HAS_ENDED.load(Ordering::Relaxed)
}

/// Shell script that guards a program. It ends the program and all child processes when its own standard input closes,
/// which happens when we close it or our process ends for any reason.
///
/// If standard input closes without a message, our process has ended, and the script deletes the folder. The shell
/// leads the process group, so the number of the group is not reused.
const GUARD: &str = "exec 3<&0 </dev/null
\"$0\" \"$@\" 3<&- & program=$!
(read -r _ <&3 || rm -rf \"$GRAINBENCH_FOLDER\"; kill -9 -$$) &
wait $program";
/// Message to the guard, sent before its standard input closes while our process continues.
const WE_ARE_ALIVE: &[u8] = b"alive\n";

/// Runs a program until it ends or exceeds a limit.
pub(crate) fn run(started: &ProcessStart<'_>, limits: Limits) -> Result<ProcessEnd, (Failure, Vec<String>)> {
    let ProcessStart { executable, arguments, folder, at, errors_apart } = *started;
    let not_run = |error: io::Error| (Failure::NotRun(format!("{}: {error}", executable.display())), Vec::new());
    fs::metadata(executable).map_err(not_run)?;
    let screen = File::create(folder.join(SCREEN)).map_err(not_run)?;
    let errors = if errors_apart { File::create(folder.join(ERRORS)) } else { screen.try_clone() };
    let errors = errors.map_err(not_run)?;
    let mut command = guard(GUARD, executable, arguments, folder, limits);
    command.current_dir(at.unwrap_or(folder)).stdout(screen).stderr(errors);
    let mut child = command.spawn().map_err(not_run)?;
    let start = Instant::now();
    let status = loop {
        let failure = match child.try_wait() {
            Ok(Some(status)) => break status,
            Err(error) => Failure::NotRun(error.to_string()),
            Ok(None) if size(folder) > limits.bytes => too_much(limits.bytes),
            Ok(None) => match limits.check() {
                Err(failure) => failure,
                Ok(()) => {
                    // The pause is 1/20 of the elapsed time, but at least 0.5 ms and at most 20 ms.
                    sleep((start.elapsed() / 20).clamp(Duration::from_micros(500), Duration::from_millis(20)));
                    continue;
                }
            },
        };
        // The guard ends the program. The program may have ended already.
        close(&mut child);
        let _ = child.wait();
        end_sessions(folder, child.id());
        return Err((failure, last_lines(folder)));
    };
    close(&mut child);
    end_sessions(folder, child.id());
    let last_lines = last_lines(folder);
    match status.code() {
        Some(0) if size(folder) > limits.bytes => Err((too_much(limits.bytes), last_lines)),
        // Exit codes of a shell that could not start the program.
        Some(126 | 127) => Err((Failure::NotRun(executable.display().to_string()), last_lines)),
        // Exit codes of a shell whose program was ended by a signal.
        Some(code @ 129..=192) => Err((Failure::Crash(format!("signal {}", code - 128)), last_lines)),
        Some(code) => Ok(ProcessEnd { code, last_lines }),
        None => Err((Failure::Crash(status.to_string()), last_lines)),
    }
}

/// Returns the shell command that runs a script as the guard of a program. It sets the memory limit and the number of
/// threads; the working directory is `folder`.
pub(crate) fn guard(script: &str, executable: &Path, arguments: &[String], folder: &Path, limits: Limits) -> Command {
    let guarded = match limits.memory {
        Some(most) => format!("ulimit -v {most} || exit 126\n{script}"),
        None => script.to_owned(),
    };
    let mut command = Command::new("sh");
    command
        .args(["-c", &guarded])
        .arg(executable)
        .args(arguments)
        .current_dir(folder)
        .env(FOLDER, folder)
        // The number of threads is set, because another order of summation changes the last digits.
        .env("OMP_NUM_THREADS", limits.threads.to_string())
        // Avoids one daemon per start for monitoring several processes.
        .env("OMPI_MCA_ess_singleton_isolated", "1")
        // Avoids the search for networks between machines, which takes 3/4 of the start time.
        .env("OMPI_MCA_pml", "ob1")
        .stdin(Stdio::piped());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
}

/// Ends processes that a program started in separate sessions (`setsid`). The guard ends only its own process group.
///
/// These processes are found in `/proc` by the folder in their environment.
pub(crate) fn end_sessions(folder: &Path, guard: u32) {
    let mut mark = format!("{FOLDER}=").into_bytes();
    mark.extend(folder.as_os_str().as_encoded_bytes());
    for _ in 0..SWEEPS {
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
        // Processes in the group of the guard are ended by the guard. A process without a group has ended.
        let is_marked = |process: &u32| {
            if group(*process).is_none_or(|group| group == guard) {
                return false;
            }
            let environment = fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
            environment.split(|byte| *byte == 0).any(|variable| variable == mark)
        };
        let found: Vec<String> = numbers.filter(is_marked).map(|process| process.to_string()).collect();
        if found.is_empty() {
            return;
        }
        let _ = Command::new("kill").arg("-9").args(&found).stdout(Stdio::null()).stderr(Stdio::null()).status();
        sleep(Duration::from_millis(1));
    }
}

/// Returns the process group of a process, or `None` if `/proc` does not list the process.
fn group(process: u32) -> Option<u32> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The program name in parentheses may contain blanks. State, parent process and group follow it.
    text.rsplit_once(')')?.1.split_ascii_whitespace().nth(2)?.parse().ok()
}

/// Returns the failure of a run whose files are larger than the limit `most` (B).
pub(crate) fn too_much(most: u64) -> Failure {
    Failure::Output(format!("expected at most {} MB for the samples of this scene, found more", most / 1_000_000))
}

/// Closes the standard input of the guard after the message that makes the guard keep the folder. The guard may have
/// ended already.
fn close(child: &mut Child) {
    if let Some(mut input) = child.stdin.take() {
        say_alive(&mut input);
    }
}

/// Sends the message `WE_ARE_ALIVE` to the guard, which may have ended already.
pub(crate) fn say_alive(input: &mut ChildStdin) {
    let _ = input.write_all(WE_ARE_ALIVE);
}

/// Returns the size of all files in a folder and its subfolders (B). Links are not followed.
pub(crate) fn size(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let entry_size = |entry: fs::DirEntry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    };
    entries.map(entry_size).sum()
}

/// Returns the last lines of standard error, or of standard output if there are none.
pub(crate) fn last_lines(folder: &Path) -> Vec<String> {
    let of_errors = last_lines_of(&folder.join(ERRORS));
    if of_errors.is_empty() { last_lines_of(&folder.join(SCREEN)) } else { of_errors }
}

/// Returns the last lines of a file. The text may have bytes that are not UTF-8, for example from LIGGGHTS.
fn last_lines_of(path: &Path) -> Vec<String> {
    let read = || -> io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(END)))?;
        let mut bytes = Vec::new();
        file.take(END).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let text = String::from_utf8_lossy(&read().unwrap_or_default()).into_owned();
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let skipped = lines.len().saturating_sub(LAST_LINES);
    lines[skipped..].iter().map(|line| crate::read::read_error::one_line(line)).collect()
}
