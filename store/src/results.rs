//! Results of finished tasks, from the result files of all workers.

use crate::key::Id;
use crate::log::{self, ENDING, Entry, State, Worker};
use crate::write::WriteError;
use serde::de::DeserializeOwned;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Directory of result files.
pub const RESULTS: &str = "results";

/// All finished tasks whose results are in a directory.
#[derive(Clone, Debug, Default)]
pub struct FinishedTasks {
    /// Results by task.
    pub entries: HashMap<Id, Entry>,
    /// Workers with a result file.
    pub workers: Vec<Worker>,
    /// Number of truncated or damaged lines. A file with a damaged first line counts as one line.
    pub damaged: usize,
}

/// Removes the result files of a directory.
///
/// # Errors
/// When a file cannot be removed.
pub fn remove(directory: &Path) -> Result<(), WriteError> {
    for file in files(&directory.join(RESULTS)).unwrap_or_default() {
        fs::remove_file(&file).map_err(|source| WriteError::new(&file, source))?;
    }
    Ok(())
}

/// Returns the result files in a folder, in the order of the starts of their workers; none if there is no folder.
fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
    // The names begin with the time.
    files.sort();
    Ok(files)
}

impl FinishedTasks {
    /// Reads the result files of all workers. The JSON of the results is kept only if `with_results` is set.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn read(directory: &Path, with_results: bool) -> Result<Self, String> {
        let folder = directory.join(RESULTS);
        let unreadable = |path: &Path, what: &str, error: std::io::Error| {
            format!("{}: expected a {what} that can be read, found {error}", path.display())
        };
        let mut finished = Self::default();
        for file in files(&folder).map_err(|error| unreadable(&folder, "directory", error))? {
            let bytes = fs::read(&file).map_err(|error| unreadable(&file, "file", error))?;
            finished.add(&bytes, with_results);
        }
        Ok(finished)
    }

    /// Returns the result of a task, deserialised from its JSON text; `None` if the task is not finished. The error is the
    /// message of a crash of our program, or the reason why the stored result cannot be read. [`Self::read`] must have
    /// been called with `with_results`.
    #[must_use]
    pub fn result<T: DeserializeOwned>(&self, id: Id) -> Option<Result<T, String>> {
        let entry = self.entries.get(&id)?;
        if entry.state == State::Crashed {
            let words = serde_json::from_str(&entry.json);
            return Some(Err(words.unwrap_or_else(|_| "our program failed".to_owned())));
        }
        Some(serde_json::from_str(&entry.json).map_err(|error| format!("its result cannot be read: {error}")))
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
            match Entry::read(line, with_results).filter(|_| !is_last) {
                Some((id, entry)) => self.take(id, Entry { worker: place, ..entry }),
                None if is_last && line.is_empty() => {}
                None => self.damaged += 1,
            }
        }
    }

    /// Adds a result. If the task has a successful result already, the new result is ignored. A failed or
    /// crashed result is replaced.
    fn take(&mut self, id: Id, entry: Entry) {
        match self.entries.get_mut(&id) {
            Some(known) if known.state == State::Done => known.repeats += 1,
            _ => drop(self.entries.insert(id, entry)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Log;

    #[test]
    fn the_first_successful_result_of_a_task_counts() {
        let directory = tempfile::tempdir().unwrap();
        fs::create_dir(directory.path().join(RESULTS)).unwrap();
        let [a, b] = ["a", "b"].map(|word| Id::of_words("", &[word]));
        for (name, results) in [
            ("1", [(a, State::Failed, "1"), (b, State::Done, "2")]),
            ("2", [(a, State::Done, "3"), (b, State::Done, "4")]),
            ("3", [(a, State::Crashed, "\"5\""), (b, State::Failed, "6")]),
        ] {
            let worker = Worker { name: name.to_owned(), ..Worker::default() };
            let mut log = Log::new(&directory.path().join(RESULTS), &worker).unwrap();
            for (id, state, json) in results {
                log.add(id, &Entry::new(state, 1.0, None, json)).unwrap();
            }
        }
        let finished = FinishedTasks::read(directory.path(), true).unwrap();
        assert_eq!([a, b].map(|id| finished.result::<u32>(id)), [Some(Ok(3)), Some(Ok(2))]);
        // Repeats are counted for each task, because the directory may hold results of tasks outside a plan.
        assert_eq!([a, b].map(|id| finished.entries[&id].repeats), [1, 2]);
        remove(directory.path()).unwrap();
        assert_eq!(FinishedTasks::read(directory.path(), true).unwrap().entries.len(), 0);
    }
}
