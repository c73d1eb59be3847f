//! `grainbench completions` and `grainbench man`: shell completions and manual pages, generated from the commands.

use super::exit::{Fault, Outcome, check_folder, print};
use grainbench::store::StagedDir;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Shell that reads the completion script.
    shell: clap_complete::Shell,
}

#[derive(clap::Args)]
pub(crate) struct ManArguments {
    /// Directory for the pages of all commands. Default: print the page of `grainbench`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the completion script of a shell.
pub(crate) fn completions(arguments: &Arguments, mut command: clap::Command) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "grainbench", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the manual page of the program, or writes one page for each command.
pub(crate) fn man(arguments: &ManArguments, mut command: clap::Command) -> Outcome {
    command.build();
    let page = |command: clap::Command| {
        let mut text = Vec::new();
        clap_mangen::Man::new(command).render(&mut text).map_err(Fault::input)?;
        Ok::<_, Fault>(text)
    };
    let Some(out) = &arguments.out else {
        print(&String::from_utf8_lossy(&page(command)?))?;
        return Ok(ExitCode::SUCCESS);
    };
    check_folder(out)?;
    let mut staged = StagedDir::new(out).map_err(Fault::writing)?;
    for subcommand in command.get_subcommands() {
        let name = subcommand.get_display_name().unwrap_or_else(|| subcommand.get_name());
        staged.write(format!("{name}.1"), page(subcommand.clone())?).map_err(Fault::writing)?;
    }
    staged.write("grainbench.1", page(command)?).map_err(Fault::writing)?;
    staged.commit().map_err(Fault::writing)?;
    Ok(ExitCode::SUCCESS)
}
