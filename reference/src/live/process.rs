//! Running a program in a scratch folder, with a limit of time.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use grainbench_scene::solver::Failure;
use tempfile::TempDir;

use crate::deck::Deck;

/// The log that a run leaves in its folder.
pub(crate) const LOG: &str = "log.run";
/// What the program prints.
const SCREEN: &str = "screen";
/// How many of its last lines are told.
const LAST_LINES: usize = 4;
/// How much of the end is looked at for them.
const END: u64 = 4096;

/// A folder with the files of a deck, which goes when it is dropped.
pub(crate) fn scratch(deck: &Deck) -> io::Result<TempDir> {
    let folder = tempfile::Builder::new().prefix("grainbench-").tempdir()?;
    for (name, text) in &deck.files {
        fs::write(folder.path().join(name), text)?;
    }
    Ok(folder)
}

/// Runs the program to its end and gives the last lines that it printed.
pub(crate) fn run(
    executable: &Path,
    input: &str,
    folder: &Path,
    time_limit: Duration,
) -> Result<Vec<String>, (Failure, Vec<String>)> {
    let not_run = |error: io::Error| (Failure::NotRun(error.to_string()), Vec::new());
    let screen = File::create(folder.join(SCREEN)).map_err(not_run)?;
    let errors = screen.try_clone().map_err(not_run)?;
    let mut child = Command::new(executable)
        .args(["-in", input, "-log", LOG])
        .current_dir(folder)
        // One process, one thread: sums in another order would end in other digits.
        .env("OMP_NUM_THREADS", "1")
        // Spares each start the daemon that would watch over several processes.
        .env("OMPI_MCA_ess_singleton_isolated", "1")
        // And the search for fabrics between machines, three quarters of the time of a start.
        .env("OMPI_MCA_pml", "ob1")
        .stdin(Stdio::null())
        .stdout(screen)
        .stderr(errors)
        .spawn()
        .map_err(|error| (Failure::NotRun(format!("{}: {error}", executable.display())), Vec::new()))?;
    let start = Instant::now();
    let mut pause = Duration::from_millis(1);
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if start.elapsed() < time_limit => {
                sleep(pause);
                pause = (pause * 2).min(Duration::from_millis(20));
            }
            other => {
                // It may have ended by itself in the meantime.
                let _ = child.kill();
                let _ = child.wait();
                let failure = match other {
                    Err(error) => Failure::NotRun(error.to_string()),
                    Ok(_) => Failure::TimeOut(time_limit.as_secs()),
                };
                return Err((failure, last_lines(folder)));
            }
        }
    };
    let last_lines = last_lines(folder);
    if status.success() { Ok(last_lines) } else { Err((Failure::Crash(status.to_string()), last_lines)) }
}

/// The last lines of what was printed; LIGGGHTS prints bytes that are not UTF-8.
fn last_lines(folder: &Path) -> Vec<String> {
    let read = || -> io::Result<Vec<u8>> {
        let mut file = File::open(folder.join(SCREEN))?;
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
