//! Worker: a program that keeps running. It is started once, reads one request per line from standard input and writes
//! one answer per line. This avoids the start of an interpreter for each run.
//!
//! A request is `{"scene": FILE, "out": FOLDER}`. The answer is `{"ran": {"seconds": …}}` with an optional solution
//! time (s), `{"cannot": REASON}`, or `{"failed": {"when": …, "where": …, "why": …}}`. The worker writes arrays to
//! files in the folder.

use super::Answer;
use super::process::{self, ERRORS, Limits};
use crate::read::read_error::{one_line, quoted};
use grainbench_solver::failure::Failure;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// Maximum length of an answer (B).
const LONGEST: u64 = 1 << 16;
/// Interval between checks of the limits while a run is in progress.
const LOOK: Duration = Duration::from_millis(20);

/// Shell script that guards a worker and passes lines of its own standard input to it. It ends the worker and all child
/// processes when it reads the line `alive`, when its standard input closes, or when the worker ends.
///
/// If standard input closes without the line `alive`, our process has ended, and the script deletes the folder.
const GUARD: &str = "exec 3<&0 4>&1 </dev/null >/dev/null
{ while IFS= read -r line <&3; do
    [ \"$line\" = alive ] && kill -9 -$$
    printf '%s\\n' \"$line\"
  done
  rm -rf \"$GRAINBENCH_FOLDER\"; kill -9 -$$; } 4>&- | { \"$0\" \"$@\" >&4 3<&- 4>&-; kill -9 -$$; } &
exec 4>&-
wait";

/// Request to a worker.
#[derive(Serialize)]
struct Request<'r> {
    scene: &'r Path,
    out: &'r Path,
}

#[derive(Debug)]
pub(crate) struct Worker {
    guard: Child,
    requests: ChildStdin,
    answers: Receiver<String>,
    /// Folder of the worker, with its standard error.
    folder: TempDir,
}

impl Worker {
    /// Starts a worker process.
    pub(super) fn start(executable: &Path, arguments: &[String], limits: Limits) -> Result<Self, Failure> {
        let not_run = |error: io::Error| Failure::NotRun(format!("{}: {error}", executable.display()));
        let folder = process::scratch([]).map_err(not_run)?;
        let errors = File::create(folder.path().join(ERRORS)).map_err(not_run)?;
        let mut command = process::guard(GUARD, executable, arguments, folder.path(), limits);
        let mut guard = command.stdout(Stdio::piped()).stderr(errors).spawn().map_err(not_run)?;
        let piped = || not_run(io::Error::other("no pipe"));
        let (requests, lines) = (guard.stdin.take().ok_or_else(piped)?, guard.stdout.take().ok_or_else(piped)?);
        let (send, answers) = sync_channel(1);
        // The thread ends when the worker ends or the receiver is dropped.
        thread::spawn(move || {
            let mut lines = BufReader::new(lines);
            loop {
                let mut line = Vec::new();
                let read = lines.by_ref().take(LONGEST).read_until(b'\n', &mut line);
                let is_over = read.is_ok_and(|count| count == 0) || line.is_empty();
                if is_over || send.send(String::from_utf8_lossy(&line).into_owned()).is_err() {
                    break;
                }
            }
        });
        Ok(Self { guard, requests, answers, folder })
    }

    /// Requests a run and waits for the answer. After an error the worker must not be used again.
    pub(super) fn ask(&mut self, scene: &Path, out: &Path, limits: Limits) -> Result<Answer, Failure> {
        let request = serde_json::to_string(&Request { scene, out }).unwrap_or_default();
        let ended = || Failure::Crash("the worker ended".to_owned());
        writeln!(self.requests, "{request}").and_then(|()| self.requests.flush()).map_err(|_| ended())?;
        let answer = loop {
            match self.answers.recv_timeout(LOOK) {
                Ok(line) => break parsed(&line)?,
                Err(RecvTimeoutError::Disconnected) => return Err(ended()),
                Err(RecvTimeoutError::Timeout) => {
                    if process::size(out) > limits.bytes || process::size(self.folder.path()) > limits.bytes {
                        return Err(process::too_much(limits.bytes));
                    }
                    limits.check()?;
                }
            }
        };
        if process::size(out) <= limits.bytes { Ok(answer) } else { Err(process::too_much(limits.bytes)) }
    }

    /// Returns the last lines of standard error.
    pub(super) fn last_lines(&self) -> Vec<String> {
        process::last_lines(self.folder.path())
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        process::say_alive(&mut self.requests);
        let _ = self.guard.wait();
        process::end_sessions(self.folder.path(), self.guard.id());
        let _ = fs::remove_dir_all(self.folder.path());
    }
}

/// Parses an answer from a line of the worker's standard output.
fn parsed(line: &str) -> Result<Answer, Failure> {
    let text = line.trim();
    serde_json::from_str(text).map_err(|error| {
        let expected =
            "`{\"ran\": {}}`, `{\"cannot\": REASON}` or `{\"failed\": {…}}` on the standard output of the worker";
        Failure::Output(format!("expected {expected}, found {} ({})", quoted(text), one_line(&error.to_string())))
    })
}
