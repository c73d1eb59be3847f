//! Tasks of a plan. The file of tasks has one task per line.

use crate::fault::Fault;
use grainbench_scene::text::tamed;
pub use grainbench_store::key::Id;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Run or measurement of a plan, with the inputs that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Id of the task in result files.
    pub id: Id,
    /// Case and variant (`CASE/VARIANT`), path of the scene file, or another name, such as `conformance`.
    pub scene: String,
    /// Scene keys with changed values.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Value>,
    /// Solver name. In a sweep, the path of the manifest of an external program.
    pub solver: String,
    /// Resolution level as text.
    pub level: String,
    /// Quantity that the task determines, or a description of the task, such as `figures`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub what: String,
    /// Number of repetitions of the run; above 1 only for timed tasks.
    pub repetitions: u32,
    /// Expected time (s) of all repetitions.
    pub seconds: f64,
    /// Group number. Tasks of a group are consecutive, and one worker runs their repetitions in alternation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<u32>,
}

impl Task {
    /// Returns a task without a description, which is expected to take `seconds`.
    #[must_use]
    pub const fn new(id: Id, seconds: f64) -> Self {
        Self {
            id,
            scene: String::new(),
            set: BTreeMap::new(),
            solver: String::new(),
            level: String::new(),
            what: String::new(),
            repetitions: 1,
            seconds,
            group: None,
        }
    }
}

/// Reads tasks from text, one per line.
///
/// # Errors
/// When a line is not a task, or its expected time is negative or not finite. The error names the file and the line.
pub fn read(path: &Path, text: &str) -> Result<Vec<Task>, Fault> {
    let mut tasks = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let task: Task = serde_json::from_str(line).map_err(|error| {
            let found = tamed(&error.to_string(), |_| false);
            Fault::expected(
                format!("{}:{}", path.display(), at + 1),
                "a task in the form that `--plan DIR` writes",
                found,
            )
        })?;
        if !(task.seconds.is_finite() && task.seconds >= 0.0) {
            let place = format!("{}:{}", path.display(), at + 1);
            return Err(Fault::expected(place, "`seconds` of zero or more", task.seconds));
        }
        tasks.push(task);
    }
    Ok(tasks)
}

/// Returns tasks as JSON, one per line.
///
/// # Errors
/// When a task cannot be written as JSON, which does not occur for tasks of this project.
pub fn lines(tasks: &[Task]) -> Result<String, Fault> {
    let mut text = String::with_capacity(300 * tasks.len());
    for task in tasks {
        text.push_str(&serde_json::to_string(task).map_err(|error| Fault::Input(error.to_string()))?);
        text.push('\n');
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(read(Path::new("t"), &text).unwrap(), [task.clone(), task]);
        for wrong in [&text[..text.len() - 9], &(text.clone() + "\n"), &text.replace("0.5", "-1"), "{}", "\0"] {
            let message = read(Path::new("t"), wrong).unwrap_err().to_string();
            assert!(message.starts_with("t:") && message.contains("expected"), "{message}");
        }
    }
}
