//! Job summary and annotations of red results for GitHub Actions.

use super::exit::{Fault, print};
use grainbench::reports::Report;
use grainbench::reports::github::{annotations, summary};
use std::env;
use std::fs::OpenOptions;
use std::io::Write;

/// Appends to the job summary, and prints annotations unless the standard output is JSON. Outside GitHub Actions, does nothing.
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
