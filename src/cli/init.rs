//! `grainbench init`: writes the files of a new solver, case or scene. They are the files of `examples`.

use super::exit::{Fault, Outcome, print, refuse};
use super::publish::write_files;
use grainbench::store::{StagedDir, write_file};
use std::path::{Path, PathBuf};

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Write a solver for one grain: its manifest `SOLVER.toml` and the program that the manifest starts.
    Solver {
        /// New or empty directory.
        dir: PathBuf,
        /// Language of the program. A compiled language needs `make` and its compiler.
        #[arg(long, default_value = "python", value_parser = SOLVERS.map(|(language, _)| language))]
        language: String,
    },
    /// Write a case without Rust code: `scene.toml` and `claims.toml`.
    Case {
        /// New or empty directory.
        dir: PathBuf,
    },
    /// Write a scene: a ball on a slope.
    Scene {
        /// New file.
        #[arg(value_name = "FILE.toml")]
        file: PathBuf,
    },
}

/// Files of an example with their names.
type Files = &'static [(&'static str, &'static str)];

macro_rules! example {
    ($folder:literal: $($file:literal)*) => {
        &[$(($file, include_str!(concat!("../../examples/", $folder, "/", $file)))),*]
    };
}

/// Files of a solver, by the language of its program.
const SOLVERS: [(&str, Files); 3] = [
    ("python", example!("python": "SOLVER.toml" "one_grain.py")),
    ("cpp", example!("cpp": "SOLVER.toml" "Makefile" "one_grain.cpp")),
    ("rust", example!("rust": "SOLVER.toml" "Makefile" "one_grain.rs")),
];
const CASE: Files = example!("case": "scene.toml" "claims.toml");

/// Writes the files and prints the command that runs them.
pub(crate) fn init(command: &Command) -> Outcome {
    let next = match command {
        Command::Solver { dir, language } => {
            SOLVERS.iter().filter(|(known, _)| known == language).try_for_each(|(_, files)| write(dir, files))?;
            format!("grainbench judge {} incline-disc backspin", dir.join("SOLVER.toml").display())
        }
        Command::Case { dir } => {
            write(dir, CASE)?;
            format!("grainbench run {}", dir.display())
        }
        Command::Scene { file } => {
            let is_toml = file.extension().is_some_and(|end| end == "toml");
            if !is_toml || file.symlink_metadata().is_ok() {
                let found = if is_toml { "an existing file" } else { "another name" };
                refuse!("{}: expected the name of a new `.toml` file, found {found}", file.display());
            }
            write_file(file, CASE[0].1)?;
            format!("grainbench simulate {} --solver dem", file.display())
        }
    };
    print(&format!("{next}\n"))
}

/// Writes the files to a new or empty directory.
fn write(dir: &Path, files: Files) -> Result<(), Fault> {
    if let Some(entry) = dir.read_dir().ok().and_then(|mut entries| entries.next()) {
        let found = entry.map_or_else(|error| error.to_string(), |entry| entry.file_name().display().to_string());
        refuse!("{}: expected a new or empty directory, found `{found}` in it", dir.display());
    }
    write_files(StagedDir::new(dir)?.without_manifest(), files)
}
