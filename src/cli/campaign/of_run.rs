//! Plan of claims. It has one task for each claim with its negative control, one for the figures of each case, and one
//! for the conformance of each solver.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study};
use crate::cli::cache;
use crate::cli::claims::tasks::{ClaimTask, ClaimTasks, Desk};
use crate::cli::claims::{self, ClaimOptions};
use crate::cli::exit::{Fault, Outcome};
use crate::cli::filter::Filters;
use crate::cli::provenance::provenance;
use crate::cli::publish::{Output, add_reasons, publish, says_nothing};
use crate::cli::select::{self, CaseSelection};
use crate::cli::solver::is_manifest;
use crate::cli::strangers::NamedSolvers;
use grainbench::campaign::finished::FinishedTasks;
use grainbench::campaign::plan::{Kind, Plan, hash_of_file};
use grainbench::campaign::share::share;
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::ResultSink;
use grainbench::cases::folder;
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::Registry;
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::run::Run;
use grainbench::harness::runner::Runner;
use grainbench::harness::solvers::Solvers;
use grainbench::studies::cost::knobs::nominal_seconds;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;
use std::sync::Arc;

/// Expected duration of the figures of a case, without their runs (s).
const FIGURES: f64 = 0.5;
/// Expected duration of the conformance tests of one solver (s).
const CONFORMANCE: f64 = 2.0;
/// Expected duration of loading a stored result (s).
const KEPT: f64 = 0.1;
/// Expected duration of starting an external program (s).
const START: f64 = 0.5;

/// Claims, figures and conformance properties of a plan.
pub(crate) struct ClaimStudy {
    tasks: ClaimTasks,
    /// External solvers named in the plan.
    strangers: NamedSolvers,
    /// True if the plan covers the whole registry with all solvers.
    is_whole: bool,
    /// Options for the report, in words.
    words: Vec<String>,
}

/// Parser for the arguments of `run` that a plan accepts.
#[derive(clap::Parser)]
struct RunParser {
    cases: Vec<String>,
    #[command(flatten)]
    options: ClaimOptions,
}

impl ClaimStudy {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Fault> {
        arguments.only(&["CASE", "--solver", "--levels", "--filter", "--no-controls", "--live"])?;
        let mut words = vec!["run".to_owned()];
        words.extend(arguments.cases.iter().cloned());
        words.extend(arguments.solver.iter().map(|value| format!("--solver={value}")));
        words.extend(arguments.levels.iter().map(|value| format!("--levels={value}")));
        words.extend(arguments.filter.iter().map(|value| format!("--filter={value}")));
        words.extend(arguments.no_controls.then(|| "--no-controls".to_owned()));
        words.extend(arguments.live.then(|| "--live".to_owned()));
        let RunParser { cases, options } = clap::Parser::try_parse_from(words).map_err(Fault::input)?;
        let filters = Filters::read(&options.filter)?;
        if !filters.outcomes().is_empty() {
            return Err(Fault::input(
                "--filter: expected quantity, source or evidence (`outcome` is unknown before the \
                                     run)",
            ));
        }
        let mut selected = select::select(&cases, &options.solver, &options.levels)?;
        claims::narrow(&mut selected, &options, &filters)?;
        let is_whole = cases.is_empty() && options.filter.is_empty();
        let tasks = ClaimTasks::new(selected, &options, is_whole)?;
        let manifests: Vec<String> = options.solver.iter().filter(|name| is_manifest(name)).cloned().collect();
        let (strangers, _) = NamedSolvers::read_by_content(&manifests)?;
        let words = claims::words(&cases, &options);
        Ok(Self { tasks, strangers, is_whole: is_whole && options.solver.is_empty(), words })
    }

    /// Returns all tasks with their ids, in the order of the report.
    fn with_ids(&self, program: &str) -> Result<Vec<(Id, ClaimTask)>, Fault> {
        let tasks = self.tasks.all();
        Ok(self.ids(program)?.into_iter().zip(tasks).collect())
    }

    /// Returns the ids of all tasks, in the order of the report.
    fn ids(&self, program: &str) -> Result<Vec<Id>, Fault> {
        let mut ids = Vec::new();
        let mut seen: HashMap<String, usize> = HashMap::new();
        let settings = format!("{} {} {}", !self.tasks.controls, self.tasks.live, self.tasks.thorough);
        for selected in &self.tasks.selected {
            let stranger = match &selected.stranger {
                Some(outside) => outside.edition().map_err(Fault::input)?,
                None => String::new(),
            };
            let case = selected.case.name;
            let content: Vec<String> = files_of(selected)?.iter().map(|path| hash_of_file(path)).collect();
            let content = content.join(" ");
            let mut rows = String::new();
            for claim in &selected.claims {
                let keys: Vec<String> = claim.runs.iter().map(Run::key).collect();
                let runs = keys.join("|");
                let programs = self.programs(selected.case, claim);
                let words =
                    format!("{case}|{content}|{stranger}|{programs}|{runs}|{}|{}", claim.quantity, claim.control.name);
                // Two claims may have equal descriptions, so their ids contain a number.
                let number = seen.entry(words.clone()).and_modify(|number| *number += 1).or_default();
                rows += &words;
                ids.push(Id::of_words(program, &["row", &words, &number.to_string(), &settings]));
            }
            ids.push(Id::of_words(program, &["figures", &rows, &settings]));
        }
        for conforming in &self.tasks.conforming {
            let name = conforming.solver.name();
            ids.push(Id::of_words(program, &["owed", &name, &self.strangers.edition(&name)]));
        }
        Ok(ids)
    }

    /// Returns the tasks of a plan.
    ///
    /// # Errors
    /// When the cases or programs have changed since the plan was written.
    fn planned(&self, plan: &Plan) -> Result<Vec<(Id, ClaimTask)>, Fault> {
        let tasks = self.with_ids(&plan.head.program)?;
        let known: HashSet<Id> = plan.tasks.iter().map(|task| task.id).collect();
        if tasks.iter().all(|(id, _)| known.contains(id)) {
            return Ok(tasks);
        }
        let path = plan.path.display();
        Err(Fault::input(format!(
            "{path}: the cases or programs have changed; write the plan again, unchanged tasks stay finished"
        )))
    }

    /// Returns the hashes of the installed programs that a claim runs. A stored run needs no program.
    fn programs(&self, case: &Case, claim: &Claim) -> String {
        let runs = claim.runs.iter().filter(|run| self.tasks.live || !Registry.is_stored(case, run));
        runs.map(|run| Registry.edition(run.solver)).collect::<Vec<_>>().join(" ").trim().to_owned()
    }

    /// Estimates the duration of a claim with its negative control (s).
    fn seconds(&self, runner: &Runner, claim: &Claim) -> f64 {
        let once = |run: &Run| {
            let start = if grainbench::cases::solvers::is_program(run.solver) { START } else { 0.0 };
            if run.kept && !self.tasks.thorough {
                return KEPT;
            }
            let scene = runner.scene(run);
            start + scene.map_or(0.0, |scene| nominal_seconds(&scene, &run.resolution))
        };
        let all: f64 = claim.runs.iter().map(once).sum();
        if self.tasks.controls { 2.0 * all } else { all }
    }
}

/// Returns the files that the results of a case depend on; none if the case is built in.
fn files_of(selected: &CaseSelection) -> Result<Vec<PathBuf>, Fault> {
    if CASES.iter().any(|case| std::ptr::eq(*case, selected.case)) {
        return Ok(Vec::new());
    }
    folder::files(&selected.case.directory()).map_err(Fault::input)
}

impl Study for ClaimStudy {
    fn kind(&self) -> Kind {
        Kind::Run
    }

    fn is_timed(&self) -> bool {
        false
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        let solvers = cache::solvers(None);
        let selected = &self.tasks.selected;
        let runners: Vec<Runner> =
            (0..selected.len()).map(|case| self.tasks.runner(case, Arc::clone(&solvers))).collect();
        let task = |(id, task): (Id, ClaimTask)| {
            let new = |scene: String, solver: String, level: String, what: String, seconds: f64| Task {
                id,
                scene,
                set: BTreeMap::new(),
                solver,
                level,
                what,
                repetitions: 1,
                seconds,
                group: None,
            };
            match task {
                ClaimTask::Claim(case, claim) => {
                    let selected = &selected[case];
                    let claim = &selected.claims[claim];
                    let first = claim.runs.first();
                    let variant = first.map_or("", |run| run.variant);
                    let ours = first.map_or("", |run| run.solver).to_owned();
                    let solver = selected.stranger.as_ref().map_or(ours, |other| other.manifest().name.clone());
                    let seconds = self.seconds(&runners[case], claim);
                    let scene = format!("{}/{variant}", selected.case.name);
                    new(scene, solver, claim.resolution(), claim.quantity.clone(), seconds)
                }
                ClaimTask::Figures(_) => {
                    new(self.tasks.name(task), String::new(), String::new(), "figures".to_owned(), FIGURES)
                }
                ClaimTask::Conformance(_) => {
                    let what = "conformance properties".to_owned();
                    new("conformance".to_owned(), self.tasks.name(task), String::new(), what, CONFORMANCE)
                }
            }
        };
        Ok(self.with_ids(program)?.into_iter().map(task).collect())
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        // If a folder cannot be read, the error is reported when the tasks are listed.
        let files = self.tasks.selected.iter().flat_map(|selected| files_of(selected).unwrap_or_default());
        let mut inputs = self.strangers.inputs();
        inputs.extend(files.map(|path| (path.display().to_string(), hash_of_file(&path))));
        inputs
    }

    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, sink: &Arc<ResultSink>) -> Result<(), Fault> {
        let cache = cache::open(false);
        let desk = Desk::new(&self.tasks, cache.as_ref());
        let known: HashMap<Id, ClaimTask> = self.planned(plan)?.into_iter().collect();
        let do_task = |place: usize| {
            let id = tasks[place].id;
            if let Some(task) = known.get(&id) {
                sink.attempt(id, || desk.perform(*task));
            }
        };
        share(tasks.len(), jobs, || sink.goes_on(), do_task);
        if let Some(cache) = &cache {
            cache.make_room();
        }
        Ok(())
    }

    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome {
        let results = self.planned(plan)?.into_iter().map(|(id, task)| (task, finished.result(id)));
        let sections = self.tasks.sections(results, &cache::solvers(None));
        let words = self.words.iter().chain(&how.words).cloned().collect();
        let mut report = claims::report(provenance(words, how.seconds), sections, self.is_whole)?;
        let is_mute = self.tasks.has_stranger() && says_nothing(&report);
        report.red_because.extend(how.unfinished.clone());
        add_reasons(&mut report, is_mute, how.strict);
        publish(&report, &Output { parquet: how.parquet, ..Output::new(how.out, how.json, how.strict) })
    }
}
