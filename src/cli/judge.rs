//! `grainbench judge`: judges one solver.

use super::exit::{Fault, Outcome, refuse};
use super::run::{RunOptions, judge_by};
use super::solver;
use grainbench::cases::solvers;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Solver: the manifest of an external solver, the name of a built-in solver, or a Python function under
    /// `@grainbench.solver`, as `module:function` or `file.py:function`.
    #[arg(value_name = "SOLVER.toml|NAME|module:function")]
    solver: String,
    /// Cases, patterns such as 'incline-*' or '*/60deg*', or folders with `scene.toml` and `claims.toml`. Default: all
    /// built-in cases.
    #[arg(value_name = "CASE|CASE/VARIANT|FOLDER")]
    cases: Vec<String>,
    #[command(flatten)]
    rest: RunOptions,
}

/// Options that `judge` has in common with `run`, but that its help text omits: a plan names its solver.
pub(super) const HIDDEN: [&str; 4] = ["resume", "shard", "on", "resubmit"];

/// Judges the solver with the claims that apply to it.
pub(crate) fn judge(arguments: Arguments) -> Outcome {
    let Arguments { solver, cases, rest } = arguments;
    if !is_function(&solver) {
        return judge_by(cases, vec![solver], rest);
    }
    if rest.plan.plan.is_some() {
        let found = format!("--plan: expected a manifest or the name of a solver, found the function `{solver}`");
        return Err(Fault::input(found));
    }
    let (folder, manifest) = manifest_of_function(&solver)?;
    let done = judge_by(cases, vec![manifest.display().to_string()], rest);
    drop(folder);
    done
}

/// Returns true for `module:function` and `file.py:function`. Names such as `dem:lammps` belong to built-in solvers, and
/// a misspelled one is not a function.
fn is_function(name: &str) -> bool {
    let Some((module, _)) = name.split_once(':') else { return false };
    let is_method = |known: &String| known.split(':').next() == Some(module);
    !solver::is_manifest(name) && (module.ends_with(".py") || !solvers::names().iter().any(is_method))
}

/// Asks the Python package for the manifest of a function and writes it to a temporary folder.
fn manifest_of_function(name: &str) -> Result<(TempDir, PathBuf), Fault> {
    let mut python = Command::new("python3");
    let asked = python.args(["-m", "grainbench.worker", "--manifest", name]).stdin(Stdio::null()).output();
    let output = asked.map_err(|error| {
        let reason = if error.kind() == ErrorKind::NotFound { "none".to_owned() } else { error.to_string() };
        Fault::input(format!("{name}: expected the program `python3`, which runs the function; found {reason}"))
    })?;
    if !output.status.success() {
        let messages = String::from_utf8_lossy(&output.stderr);
        let last = messages.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("no message").trim();
        // The interpreter itself reports a missing package, before any line of the package runs.
        let is_package = last.contains("No module named grainbench") || last.contains("No module named 'grainbench'");
        let help = if is_package { " (`pip install ./python` in the source tree installs the package)" } else { "" };
        let expected = "expected a function under `@grainbench.solver`";
        refuse!("{name}: {expected}; python3 reports: {last}{help}");
    }
    let writing = |error| Fault::input(format!("cannot write the manifest of `{name}`: {error}"));
    let folder = tempfile::tempdir().map_err(writing)?;
    let manifest = folder.path().join("SOLVER.toml");
    std::fs::write(&manifest, &output.stdout).map_err(writing)?;
    Ok((folder, manifest))
}
