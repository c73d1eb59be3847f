//! Within a job on GitHub: a summary of the report, and its red rows as annotations.

use super::exit::{Fault, print};
use grainbench::reports::Report;
use grainbench::reports::github::{annotations, summary};
use std::env;
use std::fs::OpenOptions;
use std::io::Write;

/// Adds to the job's summary, and prints annotations where standard output is not asked for by a program. Elsewhere it does
/// nothing.
pub(crate) fn tell(report: &Report, is_json: bool) -> Result<(), Fault> {
    if let Some(path) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) {
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let written = file.and_then(|mut file| file.write_all(summary(report).as_bytes()));
        written.map_err(|error| Fault::input(format!("GITHUB_STEP_SUMMARY: {}: {error}", path.display())))?;
    }
    if !is_json && env::var_os("GITHUB_ACTIONS").is_some_and(|set| set == "true") {
        for line in annotations(report) {
            print(&(line + "\n"))?;
        }
    }
    Ok(())
}
