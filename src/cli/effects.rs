//! `grainbench effects`: measures the influence of each physical effect.

use super::exit::{Fault, Outcome, check_writable, refuse};
use super::interrupt::Interrupt;
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::jobs::plan::plan_or_perform;
use super::own;
use super::progress::Progress;
use super::provenance::provenance;
use super::publish::{Output, publish_study};
use super::solver;
use super::subject;
use super::value::{Step, duration, positive};
use grainbench::cases::solvers::Registry;
use grainbench::harness::solvers::Solvers as _;
use grainbench::reports::number;
use grainbench::reports::study::Study;
use grainbench::reports::study::effects::Entry;
use grainbench::scene::effect::Effect;
use grainbench::scene::method::Method;
use grainbench::solver::resolution::Resolution;
use grainbench::store::artifact::{Directory, JSON};
use grainbench::store::key;
use grainbench::studies::effects::scene::StudyInput;
use grainbench::studies::own::within::Within;
use grainbench::studies::run_cache::key_of_run;
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases, or one scene of your own: a scene file, or a folder with `scene.toml` and `claims.toml`. Default: all cases.
    #[arg(value_name = "CASE|CASE/VARIANT|SCENE.toml|FOLDER")]
    cases: Vec<String>,
    #[command(flatten)]
    yours: SceneOptions,
    /// Directory of the report and of the finished parts.
    #[arg(long, value_name = "DIR", default_value = "grainbench-effects")]
    out: PathBuf,
    #[command(flatten)]
    study: StudyOptions,
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
    /// Time for a scene of your own, such as `90s`, `2m` or `1h`. Effects for which no time is left are listed. Default: no
    /// limit.
    #[arg(long, value_name = "TIME", value_parser = duration)]
    budget: Option<Duration>,
}

/// Default solver for a scene file.
const SOLVER: &str = "dem";
/// Name under which the result of the test for chaos is stored.
const CHAOS: &str = "chaos";
/// Time limit if the user gives none: a year.
const UNLIMITED: Duration = Duration::from_secs(31_536_000);
/// Default of the smallest relevant change of a probe, as a fraction of the probe's largest value.
const MATTERS: f64 = 0.01;

impl SceneOptions {
    /// Returns true if all options have their defaults. Cases define these settings themselves and would ignore the options.
    fn is_usual(&self) -> bool {
        let is_usual = self.step.is_usual() && self.matters.total_cmp(&MATTERS).is_eq() && self.budget.is_none();
        self.solver == SOLVER && is_usual
    }

    fn resolution(&self) -> Resolution {
        match Method::from_name(&self.solver) {
            Some(Method::Rigid) => Resolution::substeps(Resolution::SUBSTEPS),
            Some(Method::Grid) => Resolution::grid(Resolution::CELLS, Resolution::POINTS),
            Some(Method::Dem) | None => self.step.resolution(),
        }
    }
}

/// Tests the effects in the named cases, of a scene file, or of the scene of a folder without claims.
pub(crate) fn effects(arguments: &Arguments) -> Outcome {
    let named = if own::folder(&arguments.cases)?.is_some() { None } else { own::scene(&arguments.cases)? };
    if let Some(scene) = named {
        if arguments.study.plan.plan.is_some() {
            refuse!("{scene}: expected cases with `--plan`, found a scene file");
        }
        return of_scene(&scene, arguments);
    }
    if !arguments.yours.is_usual() {
        let found = "found no scene file: a case sets its own solvers, steps and quantities";
        refuse!(
            "--solver, --time-step, --time-step-fraction, --matters, --budget: expected a scene file with them, {found}"
        );
    }
    let Arguments { cases, out, study, .. } = arguments;
    let planned = Planned { what: "effects".to_owned(), cases: cases.clone(), out: out.clone(), ..Planned::default() };
    plan_or_perform(&planned, study, None)
}

/// Tests the effects of a scene file. Finished effects are stored, so that a stopped study continues.
fn of_scene(name: &str, arguments: &Arguments) -> Outcome {
    let yours = &arguments.yours;
    let (scene, _) = subject::scene(name, &[])?;
    let solver = solver::find(&yours.solver)?;
    if scene.probes.is_empty() {
        refuse!("{name}: expected probes, because they show the influence of an effect, found none");
    }
    check_writable(&arguments.out)?;
    // The files of an external program may change between two runs.
    let cache = match solver::is_manifest(&yours.solver) {
        true => Directory::none(),
        false => Directory::open(&arguments.out.join(own::RUNS), JSON, arguments.study.no_cache)?,
    };
    let interrupt = Interrupt::listen();
    let stop = || interrupt.is_asked();
    let start = Instant::now();
    let deadline = start + yours.budget.unwrap_or(UNLIMITED);
    let (resolution, matters) = (yours.resolution(), yours.matters);
    let program = key::of_this_program() + &Registry.edition(&yours.solver);
    let id = |what: &str| {
        key_of_run(&program, &yours.solver, &scene, &resolution, &format!("{what} of {name}, {matters:?}"))
    };
    let effects: Vec<Effect> = Effect::switches().collect();
    let progress = Progress::new(effects.len() as u64 + 1, "effects");
    let mut whole = None;
    let mut study = Study::new(provenance(vec!["effects".to_owned(), name.to_owned()], 0.0));
    let mut left_out = Vec::new();
    for effect in effects {
        progress.advance();
        if let Ok(entry) = cache.get::<Option<Entry>>(&id(effect.word())) {
            study.ledger.extend(entry);
            continue;
        }
        if Instant::now() >= deadline {
            left_out.push(effect.word());
            continue;
        }
        // A run that is too long for the remaining time ends one effect, not all.
        let within = Within::new(&*solver, deadline, &stop);
        let asked = StudyInput { name: name.to_owned(), scene: &scene, solver: &within, resolution, matters };
        if whole.is_none() {
            progress.now("the unchanged scene");
            let found = asked.whole();
            if stop() {
                return Err(own::stopped());
            }
            whole = Some(found.map_err(|error| match within.0.is_cut() {
                false => Fault::input(error.to_string()),
                true => {
                    Fault::Broken(format!("{name}: expected a larger `--budget`: the unchanged scene needs more time"))
                }
            })?);
        }
        let Some(whole) = &whole else { continue };
        progress.now(effect.word());
        let entry = asked.entry(whole, effect);
        if stop() {
            return Err(own::stopped());
        }
        if within.0.is_cut() {
            left_out.push(effect.word());
            continue;
        }
        cache.put(&id(effect.word()), &entry)?;
        cache.put(&id(CHAOS), &!whole.perturbed.is_empty())?;
        study.ledger.extend(entry);
    }
    drop(progress);
    study.provenance.wall_seconds = start.elapsed().as_secs_f64();
    if !left_out.is_empty() {
        study.provenance.options.push(format!("no time was left for: {}", left_out.join(", ")));
    }
    let stored_chaos = cache.get::<bool>(&id(CHAOS)).ok();
    let is_chaotic = stored_chaos.unwrap_or_else(|| whole.is_some_and(|whole| !whole.perturbed.is_empty()));
    let text = study.text() + &scale_words(matters, is_chaotic, &left_out);
    let output = Output { text: Some(text), ..Output::new(&arguments.out, arguments.study.json) };
    publish_study(&study, output)
}

/// Returns the scale by which changes are judged, and the effects for which no time was left.
fn scale_words(matters: f64, is_chaotic: bool, left_out: &[&str]) -> String {
    let most = number::fraction(matters);
    let change =
        if is_chaotic { "the mean over time of a column changes" } else { "a column changes in at least one sample" };
    let mut text = format!(
        "needed: without the effect, {change} by more than {most} of the largest |value| that the columns of the same probe \
         and unit have (--matters)\n"
    );
    if is_chaotic {
        text += "The scene is chaotic: a displacement of one grain by a millionth of its radius changes its probes. A mean over \
                 time must also change by more than five times its largest change in perturbed runs.\n";
    }
    if !left_out.is_empty() {
        text += &format!("no time was left for: {}; a larger --budget tests them\n", left_out.join(", "));
    }
    text
}
