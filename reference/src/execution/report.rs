//! Report of a program about its own run, in a JSON file.

use crate::read::read_error::one_line;
use grainbench_solver::failure::Failure;
use serde::Deserialize;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Maximum size of a report (B).
const MOST: u64 = 1 << 20;

/// Report of a program. Unknown keys are ignored.
#[derive(Clone, Debug, Default, Deserialize)]
pub(super) struct ProgramReport {
    /// Times that the program measured (s).
    pub(super) seconds: Option<Seconds>,
    /// Description of a failure.
    pub(super) failed: Option<FailureReport>,
}

/// Times in a report (s).
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Seconds {
    /// Solution time without start-up (s).
    pub(super) solve: f64,
}

/// Returns true if a time (s) is finite and not negative.
pub(super) fn is_a_time(seconds: f64) -> bool {
    seconds.is_finite() && seconds >= 0.0
}

/// Time, position and reason of a failure. Each value can be any JSON value.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct FailureReport {
    when: Option<Value>,
    #[serde(rename = "where")]
    place: Option<Value>,
    why: Option<Value>,
}

impl FailureReport {
    /// Returns the failure as text.
    pub(super) fn words(&self) -> String {
        let text = |value: &Option<Value>| {
            value.as_ref().map_or_else(|| "unknown".to_owned(), |value| one_line(&value.to_string()))
        };
        let [when, place, why] = [&self.when, &self.place, &self.why].map(text);
        format!("the program reports: time {when}, place {place}, cause {why}")
    }
}

/// Reads a report. Returns an empty report if the file does not exist.
pub(super) fn read(path: &Path, name: &str) -> Result<ProgramReport, Failure> {
    let wrong = |expected: &str, found: String| Failure::Output(format!("{name}: expected {expected}, found {found}"));
    match fs::symlink_metadata(path) {
        Err(_) => return Ok(ProgramReport::default()),
        Ok(found) if !found.is_file() || found.len() > MOST => {
            return Err(wrong("a plain file of at most a megabyte", "something else".to_owned()));
        }
        Ok(_) => {}
    }
    let text = fs::read(path).map_err(|error| wrong("a file that can be read", error.to_string()))?;
    let report: ProgramReport =
        serde_json::from_slice(&text).map_err(|error| wrong("a report", one_line(&error.to_string())))?;
    match report.seconds.filter(|seconds| !is_a_time(seconds.solve)) {
        Some(Seconds { solve }) => Err(wrong("seconds.solve of zero or more", solve.to_string())),
        None => Ok(report),
    }
}
