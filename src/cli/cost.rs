//! `grainbench cost`: measures error against computing time.

use super::exit::{Outcome, refuse};
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::jobs::plan::plan_or_perform;
use super::own;
use super::value::window;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to measure, or one scene of your own: a scene file, or a folder with `scene.toml` and `claims.toml`. Default: all
    /// cases with an exact solution.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml|FOLDER")]
    cases: Vec<String>,
    /// Measure only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    /// Resolution levels. `all` includes points that take more than 20 s.
    #[arg(long, value_name = "default|all", default_value = "default", value_parser = ["default", "all"])]
    levels: String,
    /// Also measure the cost of the parts of a step, and of a step with one and with 10,000 grains. Without a named
    /// case, these costs are always measured.
    #[arg(long)]
    prices: bool,
    /// Compare with an earlier `results.json`. Counts must be equal, and times must agree within their spread.
    #[arg(long, value_name = "OLD.json", conflicts_with = "plan")]
    against: Option<PathBuf>,
    /// Directory of the report and of the finished points.
    #[arg(long, value_name = "DIR", default_value = "grainbench-cost")]
    out: PathBuf,
    #[command(flatten)]
    own: own::Options,
    /// Column of a probe whose error is estimated, such as `ball.vx`, or all columns of a probe. Only for a scene of your own.
    /// Repeatable. Default: all columns except counts.
    #[arg(long, value_name = "PROBE[.COLUMN]")]
    quantity: Vec<String>,
    /// Compare means over a window of time in seconds, such as `.2..1`. Only for a scene of your own. Default: the value at the
    /// end, or the mean over the whole run if the scene is chaotic.
    #[arg(long, value_name = "FROM..TO", value_parser = window, allow_hyphen_values = true)]
    window: Option<(f64, f64)>,
    /// Measure only errors and operation counts, in a plan. Without timing, several tasks can run on one machine.
    #[arg(long, requires = "plan", conflicts_with = "prices")]
    counts: bool,
    #[command(flatten)]
    study: StudyOptions,
}

/// Studies the named cases, or the scene of the user's that the arguments name.
pub(crate) fn cost(arguments: &Arguments) -> Outcome {
    let Arguments { cases, solver, levels, quantity, window, own, study, out, .. } = arguments;
    let path = own::scene(cases)?;
    let has_claims = own::folder(cases)?.is_some_and(|case| !(case.targets)(case).is_empty());
    let Some(path) = path.filter(|_| !has_claims) else {
        own.refuse_for_cases(!quantity.is_empty() || window.is_some())?;
        let planned = Planned {
            what: "cost".to_owned(),
            cases: cases.clone(),
            solver: solver.clone(),
            levels: if levels == "all" { vec![levels.clone()] } else { Vec::new() },
            prices: arguments.prices,
            counts: arguments.counts,
            out: out.clone(),
            ..Planned::default()
        };
        return plan_or_perform(&planned, study, arguments.against.as_deref());
    };
    if levels != "default" || arguments.prices || study.plan.plan.is_some() {
        refuse!("{path}: expected `--budget`, found `--levels`, `--prices` or `--plan`");
    }
    let input = own::Input {
        path,
        names: cases,
        solvers: solver,
        quantities: quantity,
        window: *window,
        study,
        out,
        budget: own.budget(),
    };
    own::cost(&input)
}
