//! Origin of results: version, machine, date and options of a run.

use grainbench_harness::figure::number;
use serde::{Deserialize, Serialize};

/// Provenance of a run: version, machine, date and options.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of the harness.
    pub version: String,
    /// Commit of the harness. A mark shows that the working tree was modified.
    pub commit: String,
    /// Date and time of the run.
    pub date: String,
    /// Processor and operating system.
    pub machine: String,
    /// Version of the Rust compiler.
    pub rustc: String,
    /// Options of the run in words.
    pub options: Vec<String>,
    /// Wall-clock time of the run (s).
    #[serde(deserialize_with = "number")]
    pub wall_seconds: f64,
}

impl Provenance {
    /// Returns the date of the run, without the time.
    #[must_use]
    pub fn day(&self) -> &str {
        self.date.split(' ').next().unwrap_or_default()
    }
}
