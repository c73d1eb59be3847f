//! Finished tasks of a plan, from the result files of all workers.

use crate::fault::Fault;
use crate::log::{self, ENDING, Line, State, Worker};
use crate::plan::RESULTS;
use crate::task::Id;
use serde::de::DeserializeOwned;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Result of a task.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Final state of the task.
    pub state: State,
    /// Duration (s).
    pub seconds: f64,
    /// Average number of runnable processes on the machine when the task ended; `None` if the task is not timed or the
    /// system reports no load.
    pub load: Option<f64>,
    /// Index of the worker in [`FinishedTasks::workers`].
    pub worker: usize,
    /// Result as JSON; empty unless results were requested.
    pub json: Box<str>,
}

/// Result of a task, deserialised from its JSON text.
#[derive(Clone, Debug, PartialEq)]
pub enum TaskResult<T> {
    /// The task has no result yet.
    Nothing,
    /// Result of a finished task.
    Out(T),
    /// Error message: our program crashed, or the stored result cannot be read.
    Crash(String),
}

/// All finished tasks of a plan.
#[derive(Clone, Debug, Default)]
pub struct FinishedTasks {
    /// Results by task.
    pub entries: HashMap<Id, Entry>,
    /// Workers with a result file.
    pub workers: Vec<Worker>,
    /// Number of truncated or damaged lines. A file with a damaged first line counts as one line.
    pub damaged: usize,
    /// Number of results for tasks that already had a successful result. They are ignored.
    pub twice: usize,
}

impl FinishedTasks {
    /// Reads the result files of all workers. The JSON of the results is kept only if `with_results` is set.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn read(plan: &Path, with_results: bool) -> Result<Self, Fault> {
        let folder = plan.join(RESULTS);
        let mut finished = Self::default();
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(finished),
            Err(error) => return Err(Fault::in_file(&folder, "a directory that can be read", error)),
        };
        let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        files.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
        // The names begin with the time, so this is the order of the starts of the workers.
        files.sort();
        for file in files {
            let bytes = fs::read(&file).map_err(|error| Fault::in_file(&file, "a file that can be read", error))?;
            finished.add(&bytes, with_results);
        }
        Ok(finished)
    }

    /// Returns the result of a task, deserialised from its JSON text. [`Self::read`] must have been called with
    /// `with_results`.
    #[must_use]
    pub fn result<T: DeserializeOwned>(&self, id: Id) -> TaskResult<T> {
        let Some(entry) = self.entries.get(&id) else { return TaskResult::Nothing };
        if entry.state == State::Crashed {
            let words = serde_json::from_str(&entry.json);
            return TaskResult::Crash(words.unwrap_or_else(|_| "our program failed".to_owned()));
        }
        match serde_json::from_str(&entry.json) {
            Ok(result) => TaskResult::Out(result),
            Err(error) => TaskResult::Crash(format!("its result cannot be read: {error}")),
        }
    }

    fn add(&mut self, bytes: &[u8], with_results: bool) {
        // The file is empty if the worker died before it wrote its first line.
        if bytes.is_empty() {
            return;
        }
        let mut lines = bytes.split(|byte| *byte == b'\n').map(|line| std::str::from_utf8(line).unwrap_or_default());
        let Some(worker) = lines.next().and_then(log::worker) else {
            self.damaged += 1;
            return;
        };
        let place = self.workers.len();
        self.workers.push(worker);
        let mut lines = lines.peekable();
        while let Some(line) = lines.next() {
            // The text after the last newline is empty or an incomplete line.
            let is_last = lines.peek().is_none();
            match Line::read(line).filter(|_| !is_last) {
                Some(line) => self.take(&line, place, with_results),
                None if is_last && line.is_empty() => {}
                None => self.damaged += 1,
            }
        }
    }

    /// Adds the result in a line. If the task has a successful result already, the new result is ignored. A failed or
    /// crashed result is replaced.
    fn take(&mut self, line: &Line<'_>, worker: usize, with_results: bool) {
        let Line { id, state, seconds, load, json } = *line;
        let json = if with_results { json } else { "" };
        let entry = || Entry { state, seconds, load, worker, json: json.into() };
        match self.entries.get_mut(&id) {
            None => {
                self.entries.insert(id, entry());
            }
            Some(known) if known.state != State::Done => *known = entry(),
            Some(_) => self.twice += 1,
        }
    }
}
