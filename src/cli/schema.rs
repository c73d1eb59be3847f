//! `grainbench schema`.

use super::exit::{Outcome, print_json};
use std::process::ExitCode;

/// Prints the JSON schema of scene files.
pub(crate) fn schema() -> Outcome {
    print_json(&grainbench::scene::schema())?;
    Ok(ExitCode::SUCCESS)
}
