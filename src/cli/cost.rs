//! `grainbench cost`: measures error against computing time.

use super::exit::Fault;
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::own;
use super::subject::selected;
use super::value::window;
use grainbench::cases::registry;
use grainbench::harness::case::Case;
use grainbench::harness::subject::{TargetQuantity, of_each_variant};
use grainbench::reports::study::Study;
use grainbench::reports::study::point::Point;
use grainbench::studies::cost::against::{compare, shared};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to measure, or one scene of your own: a scene file, or a folder with `scene.toml` and `claims.toml`. Default: all
    /// cases with an exact solution.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml|FOLDER")]
    pub(crate) cases: Vec<String>,
    /// Measure only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Resolution levels. `all` includes points that take more than 20 s.
    #[arg(long, value_name = "default|all", default_value = "default", value_parser = ["default", "all"])]
    pub(crate) levels: String,
    /// Also measure the cost of the parts of a step, and of a step with one and with 10,000 grains. Without a named
    /// case, these costs are always measured.
    #[arg(long)]
    pub(crate) prices: bool,
    /// Compare with an earlier `results.json`. Counts must be equal, and times must agree within their spread.
    #[arg(long, value_name = "OLD.json", conflicts_with = "plan")]
    pub(crate) against: Option<PathBuf>,
    /// Directory of the report and of the finished points.
    #[arg(long, value_name = "DIR", default_value = "grainbench-cost")]
    pub(crate) out: PathBuf,
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
    pub(crate) study: StudyOptions,
}

impl Arguments {
    /// Returns the arguments of the study.
    pub(crate) fn planned(&self) -> Planned {
        Planned {
            what: "cost".to_owned(),
            cases: self.cases.clone(),
            solver: self.solver.clone(),
            levels: if self.levels == "all" { vec![self.levels.clone()] } else { Vec::new() },
            prices: self.prices,
            counts: self.counts,
            out: self.out.clone(),
            ..Planned::default()
        }
    }

    /// Studies the scene that the arguments name; returns `None` if they name cases, or claims with exact values.
    pub(crate) fn own_scene(&self) -> Result<Option<ExitCode>, Fault> {
        let (has_levels, is_planned) = (self.levels != "default" || self.prices, self.study.plan.is_given());
        let path = own::scene(&self.cases)?;
        let has_claims = own::folder(&self.cases)?.is_some_and(|case| !registry::subjects(case).is_empty());
        let Some(path) = path.filter(|_| !has_claims) else {
            self.own.refuse_for_cases(!self.quantity.is_empty() || self.window.is_some())?;
            return Ok(None);
        };
        if has_levels || is_planned {
            return Err(Fault::input(format!("{path}: expected `--budget`, found `--levels`, `--prices` or `--plan`")));
        }
        let words = [&self.cases[..], &self.solver].concat();
        let input = own::Input {
            path,
            words,
            solvers: &self.solver,
            quantities: &self.quantity,
            window: self.window,
            no_cache: self.study.no_cache,
            out: &self.out,
            json: self.study.json,
        };
        own::cost(&input, &self.own).map(Some)
    }
}

/// Compares a study with the points of an earlier study, and names the file `path` of that study in the report.
pub(crate) fn set_against(study: &mut Study, old: &[Point], path: &Path) {
    let new: Vec<Point> = study.diagrams.iter().flat_map(|diagram| diagram.points.clone()).collect();
    study.changes = compare(old, &new);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    study.against = Some(format!("{name}, {} of {} points compared", shared(old, &new), new.len()));
}

/// Returns the target quantities of the named cases, in the order of the registry.
pub(crate) fn subjects(names: &[String]) -> Result<Vec<TargetQuantity>, Fault> {
    if let Some(case) = own::folder(names)? {
        return Ok(registry::subjects(case));
    }
    let mut found = Vec::new();
    for (case, variants) in selected(names)? {
        found.extend(registry::subjects(case).into_iter().filter(|subject| variants.contain(subject.variant)));
        for variant in variants.named() {
            if found.iter().all(|subject| subject.case.name != case.name || subject.variant != variant) {
                found.push(of_variant(case, variant)?);
            }
        }
    }
    if found.is_empty() {
        return Err(Fault::input(
            "expected a case with an exact solution for a single run, found none in the selection",
        ));
    }
    Ok(found)
}

/// Returns the target quantity of a variant that is not among those of the case. The error lists the variants with one.
fn of_variant(case: &'static Case, variant: &str) -> Result<TargetQuantity, Fault> {
    let mut all = of_each_variant(case);
    if let Some(at) = all.iter().position(|subject| subject.variant == variant) {
        return Ok(all.swap_remove(at));
    }
    let mut variants: Vec<&str> = all.iter().map(|subject| subject.variant).collect();
    variants.sort_unstable();
    let known = if variants.is_empty() { "no variant has one".to_owned() } else { variants.join(", ") };
    Err(Fault::input(format!(
        "{}/{variant}: expected a variant with an exact solution for a single run ({known}), found one without",
        case.name
    )))
}
