//! `grainbench schema`.

use super::exit::{Outcome, print_json};
use grainbench::reference::outside;
use std::process::ExitCode;

/// What the command takes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Of the scenes that programs are given (`grainbench scene`).
    #[arg(long)]
    resolved: bool,
}

/// Prints the JSON schema of scene files, or of resolved scenes.
pub(crate) fn schema(arguments: &Arguments) -> Outcome {
    if arguments.resolved {
        print_json(&outside::schema())?;
    } else {
        print_json(&grainbench::scene::schema())?;
    }
    Ok(ExitCode::SUCCESS)
}
