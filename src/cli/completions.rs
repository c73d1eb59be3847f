//! `grainbench completions` and `grainbench man`: shell completions and manual pages, generated from the commands.

use super::exit::{Fault, MANUAL, Outcome, check_output, print};
use super::publish::write_files;
use grainbench::store::StagedDir;
use std::path::Path;
use std::process::ExitCode;

/// Prints the completion script of a shell.
pub(crate) fn completions(shell: clap_complete::Shell, mut command: clap::Command) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "grainbench", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page of the program, or writes one page for each command to the directory `out`.
pub(crate) fn man(out: Option<&Path>, mut command: clap::Command) -> Outcome {
    command.build();
    let page = |command: clap::Command| {
        let mut text = Vec::new();
        clap_mangen::Man::new(command).render(&mut text)?;
        Ok::<_, Fault>(text)
    };
    let Some(out) = out else {
        return print(&String::from_utf8_lossy(&page(command)?));
    };
    check_output(out, &MANUAL, &[])?;
    let mut pages = Vec::new();
    for subcommand in command.get_subcommands() {
        let name = subcommand.get_display_name().unwrap_or_else(|| subcommand.get_name());
        pages.push((format!("{name}.1"), page(subcommand.clone())?));
    }
    pages.push(("grainbench.1".to_owned(), page(command)?));
    write_files(StagedDir::new(out)?, &pages)?;
    Ok(ExitCode::SUCCESS)
}
