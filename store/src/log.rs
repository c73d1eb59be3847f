//! Result file of one worker. Only this worker writes to it. The first line describes the worker, and each further line
//! is the result of one task.
//!
//! The line of a task is `ID STATE SECONDS LOAD SUM JSON`. `SUM` is a checksum of the other fields. Tasks whose lines
//! are truncated or damaged are repeated.

use crate::key::Id;
use crate::write::WriteError;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Beginning of the first line, which the description of the worker follows.
const MAGIC: &str = "grainbench-results 1 ";
/// File extension of result files.
pub const ENDING: &str = "log";
/// Minimum time between two syncs to the disk when lines are added.
const SYNC: Duration = Duration::from_secs(5);
/// Number of hexadecimal digits of a checksum.
const DIGITS: usize = 16;

/// Process that runs tasks of a plan, with its machine and job.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Worker {
    /// Unique name.
    pub name: String,
    /// Name of the machine, or of the node of a batch system.
    pub host: String,
    /// Process number on the machine.
    pub process: u32,
    /// Processor, cores and operating system.
    pub machine: String,
    /// Number of cores available to the worker.
    pub cores: usize,
    /// Job of a batch system; `None` outside one.
    #[serde(default)]
    pub job: Option<String>,
    /// Cores that the batch system granted, or all cores of an exclusive node; `None` outside a batch system.
    #[serde(default)]
    pub granted: Option<usize>,
    /// Start time as text.
    pub began: String,
}

/// Final state of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The run ended without an error.
    Done,
    /// The run ended with an error, which is stored as its result.
    Failed,
    /// Our program panicked. The line has a message instead of a result.
    Crashed,
}

impl State {
    const fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Crashed => "crashed",
        }
    }
}

/// Result of a task, and its line in a result file.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Final state of the task.
    pub state: State,
    /// Duration (s).
    pub seconds: f64,
    /// Average number of runnable processes on the machine when the task ended; `None` if the task is not timed or the
    /// system reports no load.
    pub load: Option<f64>,
    /// Result as JSON; for a crashed task, the error message as a JSON string. Empty if results were not requested.
    pub json: Box<str>,
    /// Index of the worker among all workers of a directory. It is not part of the line.
    pub worker: usize,
    /// Number of further results, which are ignored because the first result was successful. It is not part of the line.
    pub repeats: usize,
}

impl Entry {
    /// Returns the result of a task that has just ended.
    #[must_use]
    pub fn new(state: State, seconds: f64, load: Option<f64>, json: &str) -> Self {
        Self { state, seconds, load, json: json.into(), worker: 0, repeats: 0 }
    }

    /// Returns the line of task `id`, with its newline.
    #[must_use]
    pub fn written(&self, id: Id) -> String {
        let load = self.load.map_or_else(|| "-".to_owned(), |load| load.to_string());
        let head = format!("{id} {} {:.6} {load}", self.state.word(), self.seconds);
        format!("{head} {} {}\n", sum(&head, &self.json), self.json)
    }

    /// Reads a line without its newline; returns `None` if it is damaged. The JSON is kept only if `with_result` is set.
    #[must_use]
    pub fn read(text: &str, with_result: bool) -> Option<(Id, Self)> {
        let mut ends = text.match_indices(' ').map(|(at, _)| at);
        let head = &text[..ends.nth(3)?];
        let end = ends.next()?;
        let (entry_text, json) = (&text[head.len() + 1..end], &text[end + 1..]);
        if entry_text != sum(head, json) {
            return None;
        }
        let mut words = head.split(' ');
        let (id, state) = (words.next()?.parse().ok()?, words.next()?);
        let state = [State::Done, State::Failed, State::Crashed].into_iter().find(|known| known.word() == state)?;
        let (seconds, load) = (words.next()?.parse().ok()?, words.next()?.parse().ok());
        Some((id, Self::new(state, seconds, load, if with_result { json } else { "" })))
    }
}

fn sum(head: &str, json: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(head.as_bytes()).update(b" ").update(json.as_bytes());
    hasher.finalize().to_hex()[..DIGITS].to_owned()
}

/// Reads the description of the worker from the first line of a file. Returns `None` if the line is damaged.
#[must_use]
pub fn worker(line: &str) -> Option<Worker> {
    serde_json::from_str(line.strip_prefix(MAGIC)?).ok()
}

/// Open result file of a running worker.
#[derive(Debug)]
pub struct Log {
    file: File,
    path: PathBuf,
    /// Length of all complete lines (bytes).
    whole: u64,
    synced: Instant,
}

impl Log {
    /// Creates the file of a worker in a folder.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn new(folder: &Path, worker: &Worker) -> Result<Self, WriteError> {
        let path = folder.join(format!("{}.{ENDING}", worker.name));
        let file = File::create_new(&path).map_err(|source| WriteError::new(&path, source))?;
        let mut log = Self { file, path, whole: 0, synced: Instant::now() };
        let words = serde_json::to_string(worker).unwrap_or_default();
        log.append(&format!("{MAGIC}{words}\n")).inspect_err(|_| {
            let _ = std::fs::remove_file(&log.path);
        })?;
        Ok(log)
    }

    /// Adds the line of task `id`. If the write fails, the file is truncated to the end of its last complete line.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn add(&mut self, id: Id, entry: &Entry) -> Result<(), WriteError> {
        self.append(&entry.written(id))?;
        if self.synced.elapsed() > SYNC { self.sync() } else { Ok(()) }
    }

    fn append(&mut self, text: &str) -> Result<(), WriteError> {
        self.file.write_all(text.as_bytes()).map_err(|source| {
            let _ = self.file.set_len(self.whole);
            WriteError::new(&self.path, source)
        })?;
        self.whole += text.len() as u64;
        Ok(())
    }

    /// Syncs all added lines to the disk.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn sync(&mut self) -> Result<(), WriteError> {
        self.synced = Instant::now();
        match self.file.sync_data() {
            // Pipes and some file systems do not support syncing.
            Err(error) if error.kind() != io::ErrorKind::InvalidInput => Err(WriteError::new(&self.path, error)),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_read_as_it_is_written_and_not_when_it_is_damaged() {
        let id = Id::of_words("", &["a"]);
        for load in [None, Some(0.25)] {
            let entry = Entry::new(State::Failed, 0.5, load, "{\"a b\": 1}");
            let text = entry.written(id);
            let text = text.trim_end();
            assert_eq!(Entry::read(text, true), Some((id, entry)));
            for end in 0..text.len() {
                assert_eq!(Entry::read(&text[..end], true), None, "cut off at {end}");
            }
            for at in 0..text.len() {
                let mut bytes = text.as_bytes().to_vec();
                bytes[at] ^= 1;
                assert_eq!(Entry::read(std::str::from_utf8(&bytes).unwrap(), true), None, "a bit at {at}");
            }
        }
        for foreign in ["", " ", "     ", "{}", "é é é é é é"] {
            assert_eq!(Entry::read(foreign, true), None, "{foreign}");
        }
    }
}
