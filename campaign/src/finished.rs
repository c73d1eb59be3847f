//! What is finished of a plan, whoever did it.

use crate::fault::Fault;
use crate::log::{self, ENDING, Line, State, Worker};
use crate::plan::RESULTS;
use crate::task::Id;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What came out of a task.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// How it ended.
    pub state: State,
    /// What it took (s).
    pub seconds: f64,
    /// Programs that wanted a core meanwhile.
    pub load: Option<f64>,
    /// Place of the worker among all.
    pub worker: usize,
    /// What came out, where that was asked for.
    pub json: Box<str>,
}

/// Everything that is finished.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// By task.
    pub entries: HashMap<Id, Entry>,
    /// Who worked.
    pub workers: Vec<Worker>,
    /// Lines that are cut off or damaged.
    pub damaged: usize,
    /// Tasks that were done more than once.
    pub twice: usize,
}

impl Finished {
    /// Reads what all workers left, with what came out or without.
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
        // By name, which begins with the time.
        files.sort();
        for file in files {
            let bytes = fs::read(&file).map_err(|error| Fault::in_file(&file, "a file that can be read", error))?;
            finished.add(&bytes, with_results);
        }
        Ok(finished)
    }

    fn add(&mut self, bytes: &[u8], with_results: bool) {
        // The worker died before it could say who it is.
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
            // What follows the last end of a line is nothing, or cut off.
            let is_last = lines.peek().is_none();
            match Line::read(line).filter(|_| !is_last) {
                Some(line) => self.take(&line, place, with_results),
                None if is_last && line.is_empty() => {}
                None => self.damaged += 1,
            }
        }
    }

    /// The first result of a task counts; of a task that failed and was done again, the last.
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
