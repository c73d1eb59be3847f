//! `grainbench completions` and `grainbench man`: shell completions and manual pages, generated from the commands.

use super::exit::{Fault, Outcome, check_folder, print};
use super::publish::write_files;
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
    print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page of the program, or writes one page for each command.
pub(crate) fn man(arguments: &ManArguments, mut command: clap::Command) -> Outcome {
    command.build();
    let page = |command: clap::Command| {
        let mut text = Vec::new();
        clap_mangen::Man::new(command).render(&mut text)?;
        Ok::<_, Fault>(text)
    };
    let Some(out) = &arguments.out else {
        return print(&String::from_utf8_lossy(&page(command)?));
    };
    check_folder(out)?;
    let mut pages = Vec::new();
    for subcommand in command.get_subcommands() {
        let name = subcommand.get_display_name().unwrap_or_else(|| subcommand.get_name());
        pages.push((format!("{name}.1"), page(subcommand.clone())?));
    }
    pages.push(("grainbench.1".to_owned(), page(command)?));
    write_files(StagedDir::new(out)?, &pages)?;
    Ok(ExitCode::SUCCESS)
}
