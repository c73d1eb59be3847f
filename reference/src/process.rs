//! Running a program in a scratch folder, with a limit of time.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use grainbench_scene::solver::Failure;
use tempfile::TempDir;

use crate::deadline::Deadline;

/// What a program prints.
pub(crate) const SCREEN: &str = "screen";
/// What it prints as errors, where that is kept apart.
pub(crate) const ERRORS: &str = "errors";
/// Variable of the environment that names the folder of a run.
const FOLDER: &str = "GRAINBENCH_FOLDER";
/// How often processes of a run are looked for at most: those that end start new ones.
const SWEEPS: u32 = 20;
/// How many of its last lines are told.
const LAST_LINES: usize = 4;
/// How much of the end is looked at for them.
const END: u64 = 4096;

/// A folder with files of these names and texts, which goes when it is dropped.
pub(crate) fn scratch<'f>(files: impl IntoIterator<Item = (&'f str, &'f str)>) -> io::Result<TempDir> {
    let folder = tempfile::Builder::new().prefix("grainbench-").tempdir()?;
    for (name, text) in files {
        fs::write(folder.path().join(name), text)?;
    }
    Ok(folder)
}

/// How a program is started.
pub(crate) struct Started<'s> {
    /// The program.
    pub(crate) executable: &'s Path,
    /// Its words.
    pub(crate) arguments: &'s [String],
    /// The folder in which it leaves its files, and what it prints.
    pub(crate) folder: &'s Path,
    /// Where it is started, if not there.
    pub(crate) at: Option<&'s Path>,
    /// Whether errors that it prints go to [`ERRORS`] and not to [`SCREEN`].
    pub(crate) errors_apart: bool,
}

/// How a program ended that no signal ended.
pub(crate) struct Ended {
    /// The code that it gave back.
    pub(crate) code: i32,
    /// The last lines that it printed, errors where it printed any apart.
    pub(crate) last_lines: Vec<String>,
}

/// What a program may take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// When it must have ended.
    pub(crate) deadline: Deadline,
    /// All that it may leave in its folder (B).
    pub(crate) bytes: u64,
    /// Address space of each of its processes (KiB); any where none is named.
    pub(crate) memory: Option<u64>,
    /// Threads.
    pub(crate) threads: u16,
}

/// Runs a program, and ends it with all that it has started when its own standard input closes: when we close it, and
/// when we end, however that comes about. Where nothing was said before it closed we are no more, and the folder goes too.
/// Its process group is that of the shell, which keeps its number in use.
const GUARD: &str = "exec 3<&0 </dev/null
\"$0\" \"$@\" 3<&- & program=$!
(read -r _ <&3 || rm -rf \"$GRAINBENCH_FOLDER\"; kill -9 -$$) &
wait $program";
/// What the guard is told before its standard input closes and we go on.
const WE_ARE_ALIVE: &[u8] = b"alive\n";

/// Runs a program to its end.
pub(crate) fn run(started: &Started<'_>, limits: Limits) -> Result<Ended, (Failure, Vec<String>)> {
    let Started { executable, arguments, folder, at, errors_apart } = *started;
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
            Ok(None) => match limits.deadline.check() {
                Err(time_out) => time_out,
                Ok(()) => {
                    // What is lost by looking late is a twentieth of what it takes.
                    sleep((start.elapsed() / 20).clamp(Duration::from_micros(500), Duration::from_millis(20)));
                    continue;
                }
            },
        };
        // The guard ends the program; it may have ended by itself in the meantime.
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
        // What a shell says of a program that it could not start.
        Some(126 | 127) => Err((Failure::NotRun(executable.display().to_string()), last_lines)),
        // And of one that a signal ended.
        Some(code @ 129..=192) => Err((Failure::Crash(format!("signal {}", code - 128)), last_lines)),
        Some(code) => Ok(Ended { code, last_lines }),
        None => Err((Failure::Crash(status.to_string()), last_lines)),
    }
}

/// A shell that guards a program by a script, in the folder and within what it may take.
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
        // Of ours: sums in another order would end in other digits.
        .env("OMP_NUM_THREADS", limits.threads.to_string())
        // Spares each start the daemon that would watch over several processes.
        .env("OMPI_MCA_ess_singleton_isolated", "1")
        // And the search for fabrics between machines, three quarters of the time of a start.
        .env("OMPI_MCA_pml", "ob1")
        .stdin(Stdio::piped());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
}

/// Ends processes that a program started in sessions of their own (`setsid`): the guard ends the process group of the program
/// alone, which `guard` leads. They are found by the folder in their environment, where `/proc` shows it.
pub(crate) fn end_sessions(folder: &Path, guard: u32) {
    let mut mark = format!("{FOLDER}=").into_bytes();
    mark.extend(folder.as_os_str().as_encoded_bytes());
    for _ in 0..SWEEPS {
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
        // The group is left to the guard, which ends processes with another environment too. One that has ended has none.
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

/// The process group of a process, as `/proc` shows it.
fn group(process: u32) -> Option<u32> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the program, in parentheses, may have blanks: state, parent and group follow.
    text.rsplit_once(')')?.1.split_ascii_whitespace().nth(2)?.parse().ok()
}

/// The failure of a run that left more bytes than it may.
pub(crate) fn too_much(most: u64) -> Failure {
    Failure::Output(format!("expected at most {} MB for the samples of this scene, found more", most / 1_000_000))
}

/// Closes the standard input of the guard, which is told that the folder is still looked at. It may have ended.
fn close(child: &mut Child) {
    if let Some(mut input) = child.stdin.take() {
        say_alive(&mut input);
    }
}

/// Tells a guard that we are still there. It may have ended.
pub(crate) fn say_alive(input: &mut ChildStdin) {
    let _ = input.write_all(WE_ARE_ALIVE);
}

/// All that is in a folder, and in those inside it (B); links are not followed.
pub(crate) fn size(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let of = |entry: fs::DirEntry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    };
    entries.map(of).sum()
}

/// The last lines of what was printed: errors where there are some apart.
pub(crate) fn last_lines(folder: &Path) -> Vec<String> {
    let of_errors = last_lines_of(&folder.join(ERRORS));
    if of_errors.is_empty() { last_lines_of(&folder.join(SCREEN)) } else { of_errors }
}

/// The last lines of a file; LIGGGHTS prints bytes that are not UTF-8.
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
