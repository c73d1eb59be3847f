//! `grainbench effects`: measures the influence of each physical effect.

use super::exit::{Fault, Outcome, check_writable};
use super::jobs::arguments::{Arguments as Planned, PlanOptions, StudyOptions};
use super::own;
use super::progress::Progress;
use super::provenance::provenance;
use super::publish::{Output, publish_study};
use super::solver;
use super::step::Step;
use super::subject::{self, SelectedVariants, selected};
use super::value::positive;
use grainbench::cases::solvers::Registry;
use grainbench::harness::case::Case;
use grainbench::reports::study::Study;
use grainbench::scene::effect::Effect;
use grainbench::scene::method::Method;
use grainbench::solver::resolution::Resolution;
use grainbench::studies::effects::ledger::{Ledger, SceneEffect};
use grainbench::studies::effects::scene::StudyInput;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases, or one scene of your own: a scene file, or a folder with `scene.toml` and `claims.toml`. Default: all cases.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml|FOLDER")]
    cases: Vec<String>,
    #[command(flatten)]
    yours: SceneOptions,
    /// Repeat the finished parts of the study.
    #[arg(long)]
    no_cache: bool,
    /// Store the results in the source tree, for the first screen of the report. Needs all cases.
    #[arg(long, conflicts_with = "cases")]
    update_stored: bool,
    /// Directory of the report and of the finished parts.
    #[arg(long, value_name = "DIR", default_value = "grainbench-effects")]
    out: PathBuf,
    /// Print the results as JSON instead of text.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    pub(crate) plan: PlanOptions,
}

/// Options for a scene file.
#[derive(clap::Args)]
struct SceneOptions {
    /// Solver for the scene file, by name or manifest.
    #[arg(long, value_name = "NAME|SOLVER.toml", default_value = SOLVER)]
    solver: String,
    #[command(flatten)]
    step: Step,
    /// Smallest relevant change of a probe, as a fraction of the largest value of the probe.
    #[arg(long, value_name = "FRACTION", default_value_t = MATTERS, value_parser = positive, allow_hyphen_values = true)]
    matters: f64,
}

/// Default solver for a scene file.
const SOLVER: &str = "dem";
/// Default of the smallest relevant change of a probe, as a fraction of the probe's largest value.
const MATTERS: f64 = 0.01;

impl SceneOptions {
    /// Returns true if all options have their defaults. Cases define these settings themselves and would ignore the options.
    fn is_usual(&self) -> bool {
        self.solver == SOLVER && self.step.is_usual() && self.matters.total_cmp(&MATTERS).is_eq()
    }

    fn resolution(&self) -> Resolution {
        match Method::from_name(&self.solver) {
            Some(Method::Rigid) => Resolution::substeps(Resolution::SUBSTEPS),
            Some(Method::Grid) => Resolution::grid(Resolution::CELLS, Resolution::POINTS),
            Some(Method::Dem) | None => self.step.resolution(),
        }
    }
}

impl Arguments {
    /// Returns the arguments of the study of cases.
    pub(crate) fn planned(&self) -> Planned {
        Planned {
            what: "effects".to_owned(),
            cases: self.cases.clone(),
            json: self.json,
            out: self.out.clone(),
            ..Planned::default()
        }
    }

    /// Returns the options that do not change the tasks.
    pub(crate) const fn options(&self) -> StudyOptions<'_> {
        StudyOptions { no_cache: self.no_cache, against: None, update_stored: self.update_stored }
    }
}

/// Tests the effects of a scene file; returns `None` if the arguments name no scene file.
pub(crate) fn scene_file(arguments: &Arguments) -> Result<Option<ExitCode>, Fault> {
    if let Some(scene) = arguments.cases.iter().find(|name| is_scene(name)) {
        if arguments.cases.len() > 1 {
            return Err(Fault::input(format!("{scene}: expected no case in addition to a scene file")));
        }
        if arguments.plan.is_given() {
            return Err(Fault::input(format!("{scene}: expected cases with `--plan`, found a scene file")));
        }
        return of_scene(scene, arguments).map(Some);
    }
    if !arguments.yours.is_usual() {
        let found = "found no scene file: a case sets its own solvers, steps and quantities";
        return Err(Fault::input(format!(
            "--solver, --time-step, --time-step-fraction, --matters: expected a scene file with them, {found}"
        )));
    }
    Ok(None)
}

fn is_scene(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// Tests the effects of a scene file.
fn of_scene(name: &str, arguments: &Arguments) -> Outcome {
    let yours = &arguments.yours;
    let (scene, _) = subject::scene(name, &[])?;
    let solver = solver::find(&yours.solver)?;
    check_writable(&arguments.out)?;
    let asked = StudyInput {
        name: name.to_owned(),
        scene: &scene,
        solver: &*solver,
        resolution: yours.resolution(),
        matters: yours.matters,
    };
    let effects: Vec<Effect> = Effect::switches().collect();
    let start = Instant::now();
    let progress = Progress::new(effects.len() as u64 + 1, "effects");
    progress.now("the unchanged scene");
    let whole = asked.whole().map_err(|error| Fault::input(error.to_string()))?;
    progress.advance();
    if whole.record.series.columns.is_empty() {
        return Err(Fault::input(format!(
            "{name}: expected probes, because they show the influence of an effect, found none"
        )));
    }
    let mut study = Study::new(provenance(vec!["effects".to_owned(), name.to_owned()], 0.0));
    for effect in effects {
        progress.now(effect.word());
        study.ledger.extend(asked.entry(&whole, effect));
        progress.advance();
    }
    drop(progress);
    study.provenance.wall_seconds = start.elapsed().as_secs_f64();
    let chaotic = "The scene is chaotic: a displacement of one grain by a millionth of its radius changes its probes. Means over \
                   time are compared, with the scatter of perturbed runs.\n";
    let text = study.text() + if whole.perturbed.is_empty() { "" } else { chaotic };
    let output = Output { text: Some(text), ..Output::new(&arguments.out, arguments.json, false) };
    publish_study(&study, output)
}

/// Returns the study of each named case, with the effects to test.
pub(crate) fn ledgers(names: &[String]) -> Result<Vec<(Ledger, Vec<SceneEffect>)>, Fault> {
    if let Some(case) = own::folder(names)? {
        let ledger = Ledger::new(case, Arc::new(Registry));
        let pieces = ledger.pieces();
        return Ok(vec![(ledger, pieces)]);
    }
    let of_case = |(case, variants): (&'static Case, SelectedVariants<'_>)| {
        let ledger = Ledger::new(case, Arc::new(Registry));
        let pieces = ledger.pieces().into_iter().filter(|piece| variants.contain(piece.variant)).collect();
        (ledger, pieces)
    };
    Ok(selected(names)?.into_iter().map(of_case).collect())
}
