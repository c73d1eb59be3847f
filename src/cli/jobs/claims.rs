//! Tasks of `run`: one for each claim with its negative control, one for the figures of each case, and one for the
//! conformance of each solver.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study, Tasks, is_plan};
use crate::cli::cache;
use crate::cli::claims::tasks::{ClaimTask, ClaimTasks};
use crate::cli::claims::{self, ClaimOptions};
use crate::cli::exit::{Fault, Outcome};
use crate::cli::filter::Filters;
use crate::cli::provenance::provenance;
use crate::cli::publish::{Output, add_reasons, publish};
use crate::cli::select::{self, CaseSelection};
use crate::cli::solver::is_manifest;
use crate::cli::strangers::NamedSolvers;
use grainbench::cases::folder;
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::Registry;
use grainbench::cases::stored;
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::run::Run;
use grainbench::harness::runner::Runner;
use grainbench::harness::solvers::Solvers;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::plan::Plan;
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::Section;
use grainbench::store::key;
use grainbench::store::log::State;
use grainbench::studies::cost::knobs::nominal_seconds;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

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

impl ClaimStudy {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Fault> {
        let Arguments { cases, solver, levels, filter, no_controls, live, .. } = arguments.clone();
        let options = ClaimOptions { solver, levels, filter, no_controls, live, threads: 1, ..ClaimOptions::default() };
        let filters = Filters::read(&options.filter)?;
        if !filters.outcomes().is_empty() {
            return Err(Fault::input(
                "--filter: expected quantity, source or evidence (`outcome` is unknown before the \
                                     run)",
            ));
        }
        let mut selected = select::select(&cases, &options.solver, &options.levels)?;
        claims::narrow(&mut selected, &options, &filters, None)?;
        let is_whole = cases.is_empty() && options.filter.is_empty();
        let tasks = ClaimTasks::new(selected, &options, is_whole)?.cached(cache::open(false));
        let manifests: Vec<String> = options.solver.iter().filter(|name| is_manifest(name)).cloned().collect();
        let (strangers, _) = NamedSolvers::read_for(&manifests, true)?;
        let words = claims::words(&cases, &options);
        Ok(Self { tasks, strangers, is_whole: is_whole && options.solver.is_empty(), words })
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
            let content: Vec<String> = files_of(selected)?.iter().map(|path| key::of_file(path)).collect();
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

    /// Returns the hashes of the installed programs that a claim runs. A stored run needs no program.
    fn programs(&self, case: &Case, claim: &Claim) -> String {
        let runs = claim.runs.iter().filter(|run| self.tasks.live || !stored::exists(case, run));
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
    Ok(folder::files(&selected.case.directory())?)
}

impl Tasks for ClaimStudy {
    fn is_timed(&self) -> bool {
        false
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        let task = |(id, &task): (Id, &ClaimTask)| {
            let new = |scene: String, solver: String, level: String, what: String, seconds: f64| Task {
                scene,
                solver,
                level,
                what,
                ..Task::new(id, seconds)
            };
            match task {
                ClaimTask::Claim(case, claim) => {
                    let selected = &self.tasks.selected[case];
                    let claim = &selected.claims[claim];
                    let first = claim.runs.first();
                    let variant = first.map_or("", |run| run.variant);
                    let ours = first.map_or("", |run| run.solver).to_owned();
                    let solver = selected.stranger.as_ref().map_or(ours, |other| other.manifest().name.clone());
                    let seconds = self.seconds(self.tasks.runner(case), claim);
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
        Ok(self.ids(program)?.into_iter().zip(self.tasks.all()).map(task).collect())
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        // If a folder cannot be read, the error is reported when the tasks are listed.
        let files = self.tasks.selected.iter().flat_map(|selected| files_of(selected).unwrap_or_default());
        let mut inputs = self.strangers.inputs();
        inputs.extend(files.map(|path| (path.display().to_string(), key::of_file(&path))));
        inputs
    }

    fn check(&self, plan: &Plan) -> Result<(), Fault> {
        let ids = self.ids(&plan.head.program)?;
        is_plan(plan, ids.into_iter().eq(plan.tasks.iter().map(|task| task.id)))
    }
}

impl TaskList for ClaimStudy {
    type Output = Section;

    fn perform(&self, place: usize, sink: &ResultSink<'_, Section>) -> (State, Section) {
        self.tasks.perform(place, sink)
    }
}

impl Drop for ClaimStudy {
    fn drop(&mut self) {
        if let Some(cache) = self.tasks.cache() {
            cache.make_room();
        }
    }
}

impl Study for ClaimStudy {
    fn report(&self, results: Vec<Option<Result<Section, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let sections = self.tasks.sections(results);
        let words = self.words.iter().chain(&how.words).cloned().collect();
        let mut report = claims::report(provenance(words, how.seconds), sections, self.is_whole)?;
        report.red_because.extend(how.unfinished.clone());
        add_reasons(&mut report, false, how.strict);
        publish(&report, &Output { parquet: how.parquet, ..Output::new(how.out, how.json, how.strict) })
    }
}
