//! Cost, stability and effects of a scene of the user's, which has no exact solution.

use super::exit::{Fault, Outcome, check_writable, refuse};
use super::interrupt::Interrupt;
use super::jobs::arguments::StudyOptions;
use super::progress::Progress;
use super::provenance::provenance;
use super::publish::{Output, publish_study};
use super::solver::NamedSolvers;
use super::subject::{self, Variant, is_scene_file};
use super::value::duration;
use grainbench::cases::folder::{self as case_folder, CLAIMS};
use grainbench::cases::registry::CASES;
use grainbench::harness::case::Case;
use grainbench::reports::study::effects::Entry;
use grainbench::reports::study::estimate::SceneCost;
use grainbench::reports::study::stability::Limit;
use grainbench::reports::study::{Study, write_study};
use grainbench::scene::scene::{Duration as SceneDuration, Scene};
use grainbench::solver::recorder::Recorder;
use grainbench::store::artifact::{Directory, JSON};
use grainbench::store::{WriteError, key};
use grainbench::studies::own::cost::{Measurement, PARTS, SceneStudy, StudyFollower};
use grainbench::studies::own::effects;
use grainbench::studies::own::ladder::DEFAULT;
use grainbench::studies::own::limit;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time budget if the user gives none.
const BUDGET: Duration = Duration::from_secs(60);
/// Shortest time between two updates of the report.
const EVERY: Duration = Duration::from_secs(5);
/// Directory of finished runs in the directory of the report.
pub(crate) const RUNS: &str = "runs";
/// Name of the scene file in a folder.
const SCENE: &str = "scene.toml";

/// Options for a scene of the user's.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Time for a scene of your own, such as `90s`, `2m` or `1h`. Default: 1m.
    #[arg(long, value_name = "TIME", value_parser = duration)]
    budget: Option<Duration>,
}

impl Options {
    /// Returns an error if an option for a scene is given with cases, which would ignore it. `others` is true if another such
    /// option is given.
    pub(crate) fn refuse_for_cases(&self, others: bool) -> Result<(), Fault> {
        if self.budget.is_none() && !others {
            return Ok(());
        }
        Err(Fault::input(
            "--budget, --quantity, --window: expected a scene without exact claims, found cases or claims, which set their own \
             levels",
        ))
    }

    /// Returns the time budget.
    pub(crate) fn budget(&self) -> Duration {
        self.budget.unwrap_or(BUDGET)
    }
}

/// Scene, solvers and output of a study.
pub(crate) struct Input<'a> {
    /// Path of the scene.
    pub(crate) path: String,
    /// Name of the scene on the command line.
    pub(crate) names: &'a [String],
    /// Names or manifests of the solvers; the usual ones if empty.
    pub(crate) solvers: &'a [String],
    /// Target quantities; all if empty.
    pub(crate) quantities: &'a [String],
    /// Window of time (s) whose means are compared.
    pub(crate) window: Option<(f64, f64)>,
    pub(crate) study: &'a StudyOptions,
    pub(crate) out: &'a Path,
    /// Time budget of the study.
    pub(crate) budget: Duration,
}

impl Input<'_> {
    /// Returns the input with a window of time within the duration of the scene.
    fn within(&self, scene: &Scene) -> Result<Self, Fault> {
        let duration = scene.duration.seconds().unwrap_or_default();
        let window = self.window.map(|(from, to)| (from.max(0.0), to.min(duration)));
        if let Some((from, _)) = window.filter(|(from, to)| from >= to) {
            let path = &self.path;
            refuse!("--window: expected a window within 0..{duration}, the duration of {path}, found {from}..");
        }
        Ok(Self { window, path: self.path.clone(), ..*self })
    }

    /// Returns the words of the command for the report.
    fn words(&self, command: &str) -> Vec<String> {
        let mut words = vec![command.to_owned()];
        words.extend(self.names.iter().chain(self.solvers).cloned());
        words.extend(self.quantities.iter().map(|quantity| format!("--quantity {quantity}")));
        words.extend(self.window.map(|(from, to)| format!("--window {from}..{to}")));
        words.push(format!("--budget {}s", self.budget.as_secs_f64()));
        words
    }

    /// Calls a function with the study of a scene with the named solvers, or with the usual ones if none is named.
    fn study(&self, scene: &Scene, work: impl FnOnce(&SceneStudy<'_>) -> Outcome) -> Outcome {
        let (solvers, named) = NamedSolvers::read_for(self.solvers, true)?;
        check_writable(self.out)?;
        let cache = Directory::open(&self.out.join(RUNS), JSON, self.study.no_cache)?;
        let interrupt = Interrupt::listen();
        work(&SceneStudy {
            name: self.path.clone(),
            scene,
            names: if named.is_empty() { DEFAULT.map(str::to_owned).into() } else { named },
            solvers: &solvers,
            quantities: self.quantities.to_vec(),
            window: self.window,
            budget: self.budget,
            cache: &cache,
            program: key::of_this_program(),
            stop: &|| interrupt.is_asked(),
        })
    }
}

/// Returns the path of the scene that the arguments name: a file, or the scene of a folder; none for cases.
pub(crate) fn scene(names: &[String]) -> Result<Option<String>, Fault> {
    let is_case = |name: &str| CASES.iter().any(|case| name.split('/').next() == Some(case.name));
    let is_scene = |name: &&String| is_scene_file(name) || (!is_case(name) && Path::new(name).is_dir());
    let Some(name) = names.iter().find(is_scene) else { return Ok(None) };
    if names.len() > 1 {
        refuse!("{name}: expected one scene alone, found {} names", names.len());
    }
    Ok(Some(if is_scene_file(name) { name.clone() } else { Path::new(name).join(SCENE).display().to_string() }))
}

/// Returns the case of the folder with claims that the arguments name; none for scene files, folders without claims, and cases.
pub(crate) fn folder(names: &[String]) -> Result<Option<&'static Case>, Fault> {
    let Some(path) = scene(names)? else { return Ok(None) };
    match names {
        [name] if *name != path && Path::new(name).join(CLAIMS).is_file() => {
            Ok(Some(Variant::read_with_folders(name)?.case))
        }
        _ => Ok(None),
    }
}

/// Returns a text that changes with the files of a case in a folder; empty for built-in cases, which are part of the program.
pub(crate) fn edition(case: &Case) -> String {
    if case.home.made.is_some() {
        return String::new();
    }
    let files = case_folder::files(&case.directory()).unwrap_or_default();
    files.iter().map(|file| key::of_file(file)).collect()
}

/// Reads a scene, and checks that a study can compare its probes.
fn read(path: &str, quantities: &[String]) -> Result<Scene, Fault> {
    let (scene, _) = subject::scene(path, &[])?;
    if scene.probes.is_empty() {
        refuse!(
            "{path}: expected probes, whose values are compared between levels, found none; for example `[probes]` with `all = \
             {{ system = true }}`"
        );
    }
    if !matches!(scene.duration, SceneDuration::Seconds(_)) {
        refuse!("{path}: duration: expected seconds, because time steps change; found cycles");
    }
    let (series, _) = Recorder::new(&scene, 1.0, 1).finish();
    let columns: Vec<&str> = series.columns.iter().map(|column| column.name.as_str()).collect();
    for name in quantities {
        if !columns.iter().any(|column| *column == name || column.starts_with(&format!("{name}."))) {
            return Err(Fault::unknown("a probe or a column of a probe", name, columns.iter().copied()));
        }
    }
    Ok(scene)
}

/// Measures cost, stability and effects of a scene within the budget, and writes one report.
pub(crate) fn cost(input: &Input<'_>) -> Outcome {
    let scene = read(&input.path, input.quantities)?;
    let input = &input.within(&scene)?;
    input.study(&scene, |study| {
        let mut follower = Follower::new(study, input, "cost");
        let mut measured = Measurement::new(study);
        measured.levels(&mut follower)?;
        measured.variations(&mut follower)?;
        let (ledger, skipped) = effects::measure(study, &measured, &mut follower)?;
        follower.ledger = ledger;
        // A note tells why a solver has no level. Its stable step would take too long or does not exist.
        let names = measured.measured_solvers();
        limits(&names, &mut |part| measured.remaining(part), &mut follower)?;
        measured.repetitions(&mut follower)?;
        let mut result = measured.result();
        result.notes.extend(skipped);
        let is_stopped = measured.is_stopped();
        let result = follower.study(Some(result), is_stopped);
        drop(follower);
        if is_stopped {
            write_study(input.out, &result)?;
            return Err(stopped());
        }
        publish_study(&result, Output::new(input.out, input.study.json))
    })
}

/// Returns the error of a study that the user stops.
pub(crate) fn stopped() -> Fault {
    Fault::Broken("stopped; the same command continues".to_owned())
}

/// Finds the largest stable step of each solver.
fn limits(names: &[String], remaining: &mut dyn FnMut(f64) -> f64, follower: &mut Follower<'_>) -> Result<(), Fault> {
    let study = follower.study;
    for (at, solver) in names.iter().enumerate() {
        follower.now(&format!("{solver}: largest stable step"), study.budget.as_secs_f64() - remaining(1.0));
        let share = remaining(PARTS[3]).max(0.0) / (names.len() - at) as f64;
        let deadline = Instant::now() + Duration::from_secs_f64(share);
        let limit = limit::of_scene(study, solver, deadline)?;
        if (study.stop)() {
            break;
        }
        follower.limits.push(limit);
    }
    Ok(())
}

/// Finds the largest stable step of each solver in a scene, and writes the report.
pub(crate) fn stability(input: &Input<'_>) -> Outcome {
    let (scene, _) = subject::scene(&input.path, &[])?;
    input.study(&scene, |study| {
        let (start, budget) = (Instant::now(), study.budget.as_secs_f64());
        let mut follower = Follower::new(study, input, "stability");
        // The bisection may use the whole budget.
        let mut remaining = |part: f64| budget * (part / PARTS[3]).min(1.0) - start.elapsed().as_secs_f64();
        limits(&study.names, &mut remaining, &mut follower)?;
        let result = follower.study(None, false);
        drop(follower);
        if (study.stop)() {
            return Err(stopped());
        }
        publish_study(&result, Output::new(input.out, input.study.json))
    })
}

/// Returns hashes of the solvers' sources, by solver name.
pub(crate) fn sources(names: &[String]) -> BTreeMap<String, String> {
    names.iter().filter_map(|name| Some((name.clone(), grainbench::kept::sources(name)?))).collect()
}

/// Follower that shows the progress, prints a line after each level and updates the report.
struct Follower<'a> {
    /// Progress bar over the time budget.
    progress: Progress,
    study: &'a SceneStudy<'a>,
    out: &'a Path,
    words: Vec<String>,
    start: Instant,
    written: Instant,
    limits: Vec<Limit>,
    ledger: Vec<Entry>,
}

impl<'a> Follower<'a> {
    fn new(study: &'a SceneStudy<'_>, input: &'a Input<'_>, command: &str) -> Self {
        let progress = Progress::new(study.budget.as_secs_f64().ceil() as u64, "s of the budget");
        let (out, words, start) = (input.out, input.words(command), Instant::now());
        Self { progress, study, out, words, start, written: start, limits: Vec::new(), ledger: Vec::new() }
    }

    fn study(&self, cost: Option<SceneCost>, is_unfinished: bool) -> Study {
        let mut options = self.words.clone();
        options.extend(is_unfinished.then(|| "unfinished".to_owned()));
        let mut study = Study::new(provenance(options, self.start.elapsed().as_secs_f64()));
        study.scenes.extend(cost);
        study.limits.clone_from(&self.limits);
        study.ledger.clone_from(&self.ledger);
        study.sources = sources(&self.study.names);
        study
    }
}

impl StudyFollower for Follower<'_> {
    fn now(&mut self, run: &str, spent: f64) {
        let budget = self.study.budget.as_secs_f64();
        self.progress.set(spent.clamp(0.0, budget) as u64, budget.ceil() as u64);
        self.progress.now(run);
    }

    fn result(&mut self, line: &str, so_far: &dyn Fn() -> SceneCost) -> Result<(), WriteError> {
        self.progress.tell(line);
        if self.written.elapsed() > EVERY {
            write_study(self.out, &self.study(Some(so_far()), true))
                .map_err(|error| WriteError::new(self.out, std::io::Error::other(error)))?;
            self.written = Instant::now();
        }
        Ok(())
    }
}
