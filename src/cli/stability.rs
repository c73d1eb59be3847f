//! `grainbench stability`: finds the largest stable time steps and runs hard cases.

use super::exit::{Outcome, refuse};
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::jobs::plan::plan_or_perform;
use super::own;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Names, or beginnings of names, of hard cases and of assemblies with a known stability limit. Or one scene of your own: a
    /// scene file, or a folder with `scene.toml`. Default: all cases.
    #[arg(value_name = "CASE|SCENE.toml|FOLDER")]
    cases: Vec<String>,
    /// Test only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    /// Directory of the report and of the finished parts.
    #[arg(long, value_name = "DIR", default_value = "grainbench-stability")]
    out: PathBuf,
    #[command(flatten)]
    own: own::Options,
    #[command(flatten)]
    study: StudyOptions,
}

/// Studies the named cases, or the scene of the user's that the arguments name.
pub(crate) fn stability(arguments: &Arguments) -> Outcome {
    let Arguments { cases, solver, out, own, study } = arguments;
    let Some(path) = own::scene(cases)? else {
        own.refuse_for_cases(false)?;
        let planned = Planned {
            what: "stability".to_owned(),
            cases: cases.clone(),
            solver: solver.clone(),
            out: out.clone(),
            ..Planned::default()
        };
        return plan_or_perform(&planned, study, None);
    };
    if study.plan.plan.is_some() {
        refuse!("{path}: expected cases with `--plan`, found a scene file");
    }
    let budget = own.budget();
    let input = own::Input { path, names: cases, solvers: solver, quantities: &[], window: None, study, out, budget };
    own::stability(&input)
}
