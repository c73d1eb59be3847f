//! `grainbench stability`: finds the largest stable time steps and runs hard cases.

use super::exit::{Outcome, refuse};
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::jobs::here::plan_or_perform;
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

impl Arguments {
    /// Returns the arguments of the study.
    fn planned(&self) -> Planned {
        Planned {
            what: "stability".to_owned(),
            cases: self.cases.clone(),
            solver: self.solver.clone(),
            out: self.out.clone(),
            ..Planned::default()
        }
    }
}

/// Studies the named cases, or the scene of the user's that the arguments name.
pub(crate) fn stability(arguments: &Arguments) -> Outcome {
    let Arguments { cases, solver, out, own, study } = arguments;
    let Some(path) = own::scene(cases)? else {
        own.refuse_for_cases(false)?;
        return plan_or_perform(&arguments.planned(), study, None);
    };
    if study.plan.is_given() {
        refuse!("{path}: expected cases with `--plan`, found a scene file");
    }
    let input = own::Input { path, names: cases, solvers: solver, quantities: &[], window: None, study, out };
    own::stability(&input, own)
}
