//! `grainbench deck`: writes the input files of another program for a scene.

use super::exit::{DECK, Fault, Outcome, check_output, print};
use super::publish::write_files;
use super::subject;
use super::value::{path_and_value, positive};
use grainbench::reference::deck::{DeckError, Program, write_deck};
use grainbench::solver::resolution::Resolution;
use grainbench::store::StagedDir;
use std::path::PathBuf;

/// Default time step for scene files, as a fraction of the critical one.
const USUAL: Resolution = Resolution::CriticalFraction(0.1);

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Case, variant of a case, folder of a case, or scene file.
    #[arg(value_name = "CASE|CASE/VARIANT|FOLDER|SCENE.toml")]
    scene: String,
    /// Program that reads the input: `lammps` or `liggghts`.
    #[arg(long = "for", value_name = "PROGRAM")]
    program: String,
    /// Use the scene of the first solver-independent claim of the case. The claim may change the scene, for example to a
    /// stiffer contact, so that its expected value holds for any solver. `check` recognizes this scene by its initial
    /// state.
    #[arg(long, conflicts_with = "set")]
    exact: bool,
    /// Override one key of the scene. Positions follow a changed radius, and `law = "hertz"` removes linear stiffness.
    /// Repeatable.
    #[arg(long, value_name = "PATH=VALUE", value_parser = path_and_value)]
    set: Vec<(String, String)>,
    /// Time step as a fraction of the critical one. Default: the default of the case, or 0.1 for a scene file.
    #[arg(long, value_name = "FRACTION", value_parser = positive, allow_hyphen_values = true, conflicts_with = "time_step")]
    time_step_fraction: Option<f64>,
    /// Time step in seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    time_step: Option<f64>,
    /// Directory of the input files.
    #[arg(long, value_name = "DIR", default_value = "grainbench-deck")]
    out: PathBuf,
}

/// Writes the input files of a program and prints the command that runs it.
pub(crate) fn deck(arguments: &Arguments) -> Outcome {
    let name = arguments.program.as_str();
    let program =
        Program::by_name(name).ok_or_else(|| Fault::unknown("a program", name, Program::ALL.map(Program::name)))?;
    let (scene, usual) = if arguments.exact {
        subject::exact_scene(&arguments.scene)?
    } else {
        let (scene, case) = subject::scene(&arguments.scene, &arguments.set)?;
        (scene, case.map_or(USUAL, |case| case.default_level.resolution))
    };
    let resolution = match (arguments.time_step, arguments.time_step_fraction) {
        (Some(step), _) => Resolution::TimeStep(step),
        (None, Some(fraction)) => Resolution::CriticalFraction(fraction),
        (None, None) => usual,
    };
    let deck = write_deck(&scene, &resolution, program).map_err(|error| match error {
        DeckError::Unsupported { .. } => Fault::input(format!("unsupported: {error}")),
        DeckError::Resolution(_) => Fault::input(error),
    })?;
    let names: Vec<&str> = deck.files.iter().map(|(name, _)| name.as_str()).collect();
    check_output(&arguments.out, &DECK, &names)?;
    write_files(StagedDir::new(&arguments.out)?, &deck.files)?;
    let (stepping, out) = (&deck.stepping, shell_word(&arguments.out.to_string_lossy()));
    print(&format!(
        "scene      {}\nprogram    {program}\ntime step  {:.6e} s\nsteps      {}\nfiles      {}\nrun        cd {out} && {}\n",
        scene.title,
        stepping.time_step,
        grainbench::reports::number::count(stepping.steps),
        names.join(", "),
        program.command(),
    ))
}

/// Quotes a word for a shell.
fn shell_word(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+=:@,".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::shell_word;

    #[test]
    fn a_folder_is_one_word_to_a_shell() {
        assert_eq!(shell_word("out/deck-1"), "out/deck-1");
        assert_eq!(shell_word("my deck; rm -r x"), "'my deck; rm -r x'");
        assert_eq!(shell_word("it's"), r"'it'\''s'");
    }
}
