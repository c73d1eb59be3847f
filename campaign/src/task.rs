//! Tasks of a plan. The file of tasks has one task per line.

use crate::fault::Fault;
use grainbench_scene::text::tamed;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// Number of hexadecimal digits of an id.
const DIGITS: usize = 32;

/// Id of a task: the first half of a hash of the program and the inputs of the task.
///
/// Equal tasks of the same program have equal ids in every plan.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id([u8; 16]);

impl Id {
    /// Returns the id from a hash in hexadecimal digits, or `None` if the hash is too short or has other characters.
    #[must_use]
    pub fn of_hash(hash: &str) -> Option<Self> {
        hash.get(..DIGITS)?.parse().ok()
    }

    /// Computes the id from the hash of the program that will run the task and from the words that describe the task.
    #[must_use]
    pub fn of_words(program: &str, words: &[&str]) -> Self {
        let mut id = [0; 16];
        let hash = grainbench_studies::identity::of_words(program, words);
        for (byte, digits) in id.iter_mut().zip(hash.as_bytes().chunks(2)) {
            *byte =
                std::str::from_utf8(digits).ok().and_then(|two| u8::from_str_radix(two, 16).ok()).unwrap_or_default();
        }
        Self(id)
    }
}

impl FromStr for Id {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{DIGITS} hexadecimal digits");
        if text.len() != DIGITS || !text.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f')) {
            return Err(wrong());
        }
        let number = u128::from_str_radix(text, 16).map_err(|_| wrong())?;
        Ok(Self(number.to_be_bytes()))
    }
}

impl fmt::Display for Id {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:032x}", u128::from_be_bytes(self.0))
    }
}

impl fmt::Debug for Id {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{self}")
    }
}

impl Serialize for Id {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Id {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

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
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn an_id_is_read_as_it_is_written() {
        let id = Id::of_words("program", &["a", "b"]);
        assert_eq!(id.to_string().parse(), Ok(id));
        assert_ne!(id, Id::of_words("program", &["ab", ""]));
        assert_eq!(Id::of_hash(&grainbench_studies::identity::of_words("program", &["a", "b"])), Some(id));
        for wrong in ["", "12", "G".repeat(32).as_str(), "é".repeat(16).as_str(), "+".repeat(32).as_str()] {
            assert!(wrong.parse::<Id>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_wrong_line_is_named() {
        let task = Task {
            id: Id::of_words("", &[]),
            scene: "squash".to_owned(),
            set: BTreeMap::from([("a.b".to_owned(), Value::from(0.1))]),
            solver: "dem".to_owned(),
            level: "dt=.1".to_owned(),
            what: String::new(),
            repetitions: 1,
            seconds: 0.5,
            group: None,
        };
        let text = lines(&[task.clone(), task.clone()]).unwrap();
        assert_eq!(read(Path::new("t"), &text).unwrap(), [task.clone(), task]);
        for wrong in [&text[..text.len() - 9], &(text.clone() + "\n"), &text.replace("0.5", "-1"), "{}", "\0"] {
            let message = read(Path::new("t"), wrong).unwrap_err().to_string();
            assert!(message.starts_with("t:") && message.contains("expected"), "{message}");
        }
    }
}
