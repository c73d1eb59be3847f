//! `grainbench schema`: prints JSON schemas.

use super::exit::{Outcome, print_json};
use grainbench::reference::outside;
use std::process::ExitCode;

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Print the schema of resolved scenes (`grainbench scene`).
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
