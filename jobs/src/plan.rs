//! Plans. A plan is a directory with tasks (`tasks.jsonl`) and a description of their origin (`plan.toml`).

use crate::fault::Fault;
use crate::shard;
use crate::task::Task;
use grainbench_scene::text::tamed;
use grainbench_store::artifact::{read_text, read_toml};
use grainbench_store::results::RESULTS;
use grainbench_store::{StagedDir, WriteError, is_scratch, key};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// File with the origin of the plan.
const HEAD: &str = "plan.toml";
/// File with the tasks, one per line.
const TASKS: &str = "tasks.jsonl";
/// Directory of leases.
pub const RUNNING: &str = "running";
/// Format version of `plan.toml`. It must be raised whenever the meaning of stored data changes.
const FORMAT: u32 = 1;
/// Default time (s) after which a lease expires if it is not renewed.
const LEASE: f64 = 60.0;

/// Contents of `plan.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// Format version of the file.
    pub format: u32,
    /// Command, in plans of earlier versions only. The arguments repeat it, so it is ignored.
    #[serde(default, rename = "kind", skip_serializing)]
    _earlier_kind: Option<String>,
    /// Number of tasks.
    pub tasks: usize,
    /// Hash of the file of tasks.
    pub hash: String,
    /// Recommended number of shards. [`Plan::write`] replaces 0 by a number for the expected time.
    #[serde(alias = "chunks")]
    pub shards: u32,
    /// Expected time of all tasks on one core (s).
    pub seconds: f64,
    /// True if wall-clock times are measured. Nothing else may then run at the same time.
    pub timed: bool,
    /// Time (s) after which a lease expires if it is not renewed.
    #[serde(default = "lease")]
    pub lease_seconds: f64,
    /// Hash of the program that wrote the plan. No other program may run the tasks.
    pub program: String,
    /// Version and commit of the program.
    pub version: String,
    /// Date of planning.
    pub date: String,
    /// Directory in which the program was started; relative paths refer to it.
    pub directory: PathBuf,
    /// Arguments of the command that wrote the plan; in earlier plans, a list of words.
    pub arguments: toml::Value,
    /// Hashes of the input files of the tasks, by path.
    #[serde(default)]
    pub inputs: BTreeMap<String, String>,
}

const fn lease() -> f64 {
    LEASE
}

impl Head {
    /// Returns the contents of `plan.toml` for this program. [`Plan::write`] sets the number, the hash and the expected
    /// time of the tasks.
    #[must_use]
    pub fn new(arguments: toml::Value, timed: bool) -> Self {
        Self {
            format: FORMAT,
            _earlier_kind: None,
            tasks: 0,
            hash: String::new(),
            shards: 1,
            seconds: 0.0,
            timed,
            lease_seconds: LEASE,
            program: key::of_this_program(),
            version: String::new(),
            date: String::new(),
            directory: std::env::current_dir().unwrap_or_default(),
            arguments,
            inputs: BTreeMap::new(),
        }
    }
}

/// Plan with its directory and tasks.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Directory of the plan.
    pub path: PathBuf,
    /// Contents of `plan.toml`.
    pub head: Head,
    /// Tasks in the order of the file.
    pub tasks: Vec<Task>,
}

impl Plan {
    /// Returns true if a directory contains a `plan.toml`.
    #[must_use]
    pub fn is_in(path: &Path) -> bool {
        path.join(HEAD).is_file()
    }

    /// Writes the plan to its directory, which is new, empty, or already has a plan.
    ///
    /// Results of an earlier plan in the directory are kept. They count for tasks with the same ids in the new plan.
    ///
    /// # Errors
    /// When the directory has other contents, or the disk rejects a write.
    pub fn write(mut self) -> Result<Self, Fault> {
        let Self { path, head, tasks } = &mut self;
        check_place(path)?;
        let text = lines(tasks)?;
        head.tasks = tasks.len();
        head.hash = hash(&text);
        head.seconds = tasks.iter().map(|task| task.seconds).sum();
        if head.shards == 0 {
            head.shards = shard::count(tasks);
        }
        let words = toml::to_string(head).map_err(|error| Fault::Input(error.to_string()))?;
        // `plan.toml` is moved before the tasks. If the process is killed between the two moves, the directory counts
        // as a plan and can be overwritten by a new plan.
        let mut out = StagedDir::new(&*path)?.without_manifest();
        out.write(HEAD, words)?;
        out.write(TASKS, text)?;
        out.commit()?;
        for folder in [path.join(RESULTS), path.join(RUNNING)] {
            fs::create_dir_all(&folder).map_err(|source| WriteError::new(folder, source))?;
        }
        Ok(self)
    }

    /// Reads a plan.
    ///
    /// # Errors
    /// The error names the file, the place, what was expected and what was found.
    pub fn read(path: &Path) -> Result<Self, Fault> {
        let file = path.join(HEAD);
        if !file.is_file() {
            let expected = "a directory with a plan, written by `--plan DIR`";
            return Err(Fault::in_file(path, expected, format!("no {HEAD} in it")));
        }
        let head: Head = read_toml(&file)?;
        let wrong = |expected: &str, found: String| Err(Fault::in_file(&file, expected, found));
        if head.format != FORMAT {
            return wrong("format = 1", head.format.to_string());
        }
        if !(1..=shard::MOST).contains(&head.shards) {
            return wrong("`shards` from 1 to a million", head.shards.to_string());
        }
        if !(head.lease_seconds.is_finite() && head.lease_seconds > 0.0) {
            return wrong("`lease_seconds` above zero", head.lease_seconds.to_string());
        }
        let file = path.join(TASKS);
        let text = read_text(&file)?;
        if hash(&text) != head.hash {
            return Err(Fault::in_file(&file, format!("the tasks for which {HEAD} was written"), "others"));
        }
        let tasks = read_tasks(&file, &text)?;
        Ok(Self { path: path.to_owned(), head, tasks })
    }

    /// Checks that the running program is the one that wrote the plan, and that the input files have not changed.
    ///
    /// # Errors
    /// When the program or an input file differs. The error names it.
    pub fn check_program(&self) -> Result<(), Fault> {
        let head = &self.head;
        let here = key::of_this_program();
        if here != head.program {
            let expected = format!("the program that wrote the plan, version {}", head.version);
            let found = "another build; write the plan again (unchanged tasks stay finished)";
            return Err(Fault::in_file(&self.path, expected, found));
        }
        for (path, known) in &head.inputs {
            if key::of_file(&head.directory.join(path)) != *known {
                let found = "a changed file; write the plan again (unchanged tasks stay finished)";
                return Err(Fault::expected(path, "the file of the plan", found));
            }
        }
        Ok(())
    }
}

/// Reads tasks from text, one per line.
///
/// # Errors
/// When a line is not a task, or its expected time is negative or not finite. The error names the file and the line.
fn read_tasks(path: &Path, text: &str) -> Result<Vec<Task>, Fault> {
    let mut tasks = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let task: Task = serde_json::from_str(line).map_err(|error| {
            let found = tamed(&error.to_string(), |_| false);
            Fault::in_line(path, at, "a task in the form that `--plan DIR` writes", found)
        })?;
        if !(task.seconds.is_finite() && task.seconds >= 0.0) {
            return Err(Fault::in_line(path, at, "`seconds` of zero or more", task.seconds));
        }
        tasks.push(task);
    }
    Ok(tasks)
}

/// Returns tasks as JSON, one per line.
///
/// # Errors
/// When a task cannot be written as JSON, which does not occur for tasks of this project.
fn lines(tasks: &[Task]) -> Result<String, Fault> {
    let mut text = String::with_capacity(300 * tasks.len());
    for task in tasks {
        text.push_str(&serde_json::to_string(task).map_err(|error| Fault::Input(error.to_string()))?);
        text.push('\n');
    }
    Ok(text)
}

/// Checks that a directory can take a plan: it must be new, empty, or already have a plan.
///
/// # Errors
/// When the directory has other contents or cannot be read.
pub fn check_place(path: &Path) -> Result<(), Fault> {
    let expected = "a new directory, an empty directory or a directory with a plan";
    match fs::read_dir(path) {
        Ok(mut entries) => {
            // Temporary files of killed processes are ignored.
            let is_left =
                |entry: std::io::Result<fs::DirEntry>| entry.is_ok_and(|entry| is_scratch(&entry.file_name()));
            let is_ours = read_toml::<Head>(&path.join(HEAD)).is_ok() || entries.all(is_left);
            if is_ours { Ok(()) } else { Err(Fault::in_file(path, expected, "other files")) }
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Fault::in_file(path, expected, error)),
    }
}

fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::task::Id;
    use serde_json::Value;

    #[test]
    fn a_wrong_line_is_named() {
        let task = Task {
            scene: "squash".to_owned(),
            set: BTreeMap::from([("a.b".to_owned(), Value::from(0.1))]),
            solver: "dem".to_owned(),
            level: "dt=.1".to_owned(),
            ..Task::new(Id::of_words("", &[]), 0.5)
        };
        let text = lines(&[task.clone(), task.clone()]).unwrap();
        assert_eq!(read_tasks(Path::new("t"), &text).unwrap(), [task.clone(), task]);
        for wrong in [&text[..text.len() - 9], &(text.clone() + "\n"), &text.replace("0.5", "-1"), "{}", "\0"] {
            let message = read_tasks(Path::new("t"), wrong).unwrap_err().to_string();
            assert!(message.starts_with("t:") && message.contains("expected"), "{message}");
        }
    }
}
