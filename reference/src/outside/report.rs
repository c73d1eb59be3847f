//! What a program says of its own run, in a JSON file.

use crate::read::read_error::one_line;
use grainbench_scene::solver::Failure;
use serde::Deserialize;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Most bytes of a report.
const MOST: u64 = 1 << 20;

/// The report. Other keys are the program's own.
#[derive(Clone, Debug, Default, Deserialize)]
pub(super) struct OwnReport {
    /// Times of its parts (s).
    pub(super) seconds: Option<Seconds>,
    /// How it broke.
    pub(super) failed: Option<Failed>,
}

/// Times (s).
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) struct Seconds {
    /// Of the solution, without the start.
    pub(super) solve: f64,
}

impl Seconds {
    /// Whether it is a time.
    pub(super) fn is_a_time(self) -> bool {
        self.solve.is_finite() && self.solve >= 0.0
    }
}

/// When, where and why a run broke: a number, a text or a place.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Failed {
    when: Option<Value>,
    #[serde(rename = "where")]
    place: Option<Value>,
    why: Option<Value>,
}

impl Failed {
    /// In words.
    pub(super) fn words(&self) -> String {
        let of = |value: &Option<Value>| {
            value.as_ref().map_or_else(|| "not told".to_owned(), |value| one_line(&value.to_string()))
        };
        format!("by its own report: when {}, where {}, why {}", of(&self.when), of(&self.place), of(&self.why))
    }
}

/// Reads a report; an empty one where there is no file.
pub(super) fn read(path: &Path, name: &str) -> Result<OwnReport, Failure> {
    let wrong = |expected: &str, found: String| Failure::Output(format!("{name}: expected {expected}, found {found}"));
    match fs::symlink_metadata(path) {
        Err(_) => return Ok(OwnReport::default()),
        Ok(found) if !found.is_file() || found.len() > MOST => {
            return Err(wrong("a plain file of at most a megabyte", "something else".to_owned()));
        }
        Ok(_) => {}
    }
    let text = fs::read(path).map_err(|error| wrong("a file that can be read", error.to_string()))?;
    let report: OwnReport =
        serde_json::from_slice(&text).map_err(|error| wrong("a report", one_line(&error.to_string())))?;
    match report.seconds.filter(|seconds| !seconds.is_a_time()) {
        Some(Seconds { solve }) => Err(wrong("seconds.solve of zero or more", solve.to_string())),
        None => Ok(report),
    }
}
