//! Plan of claims: one task per claim with its control, one for the figures of a case, and one for the conformance of
//! each solver.

use super::collect::ReportOptions;
use super::plan::Arguments;
use super::study::{Study, TaskResult, came};
use crate::cli::cache;
use crate::cli::conform;
use crate::cli::exit::{self, Fault, Outcome, print};
use crate::cli::filter::Filters;
use crate::cli::provenance::provenance;
use crate::cli::run;
use crate::cli::select::{self, CaseSelection};
use crate::cli::solver::is_manifest;
use crate::cli::strangers::NamedSolvers;
use grainbench::campaign::finished::FinishedTasks;
use grainbench::campaign::log::State;
use grainbench::campaign::plan::{Kind, Plan, hash_of_file};
use grainbench::campaign::share::share;
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::ResultSink;
use grainbench::cases::folder;
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::Registry;
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::conformance;
use grainbench::harness::run::Run;
use grainbench::harness::runner::Runner;
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict;
use grainbench::reports::results::results_json;
use grainbench::reports::{RunCost, Section, summary_table, write_report, write_report_and_parquet};
use grainbench::studies::cost::knobs::nominal_seconds;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Expected duration of the figures of a case beyond its runs (s).
const FIGURES: f64 = 0.5;
/// Expected duration of the conformance tests of one solver (s).
const CONFORMANCE: f64 = 2.0;
/// Expected duration of reading a stored result (s).
const KEPT: f64 = 0.1;
/// Expected duration of starting a program (s).
const START: f64 = 0.5;

/// Claims of a plan.
pub(crate) struct ClaimStudy {
    selected: Vec<CaseSelection>,
    /// External solvers of the plan.
    strangers: NamedSolvers,
    options: run::Options,
    arguments: Arguments,
    /// True if all resolution levels run.
    thorough: bool,
    /// True if the plan covers the whole registry.
    is_whole: bool,
}

/// Parser for the options of `run`.
#[derive(clap::Parser)]
struct RunParser {
    #[command(flatten)]
    arguments: run::Arguments,
}

/// Work item, with indices of the case and of the claim within the case.
#[derive(Clone, Copy)]
enum WorkItem {
    Row(usize, usize),
    Figures(usize),
    Owed(usize),
}

/// Result of a work item: part of a section, and the keys that order its runs.
#[derive(Serialize, Deserialize)]
struct Part {
    keys: Vec<String>,
    section: Section,
    /// Error if the figures could not be drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    without: Option<String>,
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
        let again = <RunParser as clap::Parser>::try_parse_from(words).map_err(Fault::input)?;
        let run::Arguments { cases, options, .. } = again.arguments;
        let filters = Filters::read(&options.filter)?;
        if !filters.outcomes().is_empty() {
            return Err(Fault::input(
                "--filter: expected quantity, source or evidence (`outcome` is unknown before the \
                                     run)",
            ));
        }
        let mut selected = select::select(&cases, &options.solver, &options.levels)?;
        run::narrow(&mut selected, &options, &filters)?;
        let thorough = options.levels.iter().any(|level| level == "all");
        let is_whole = cases.is_empty() && options.filter.is_empty();
        let manifests: Vec<String> = options.solver.iter().filter(|name| is_manifest(name)).cloned().collect();
        let (strangers, _) = NamedSolvers::read_by_content(&manifests)?;
        Ok(Self { selected, strangers, options, arguments: arguments.clone(), thorough, is_whole })
    }

    /// Returns true if the plan includes conformance tests.
    fn owes(&self) -> bool {
        self.is_whole && (self.options.levels.is_empty() || self.thorough)
    }

    /// Returns all work items with their ids, in the order of the report.
    fn pieces(&self, program: &str) -> Result<Vec<(Id, WorkItem)>, Fault> {
        let mut pieces = Vec::new();
        let mut seen: HashMap<String, usize> = HashMap::new();
        let settings = format!("{} {} {}", self.options.no_controls, self.options.live, self.thorough);
        for (at, selected) in self.selected.iter().enumerate() {
            let stranger = match &selected.stranger {
                Some(outside) => outside.edition().map_err(Fault::input)?,
                None => String::new(),
            };
            let case = selected.case.name;
            let content: Vec<String> = files_of(selected)?.iter().map(|path| hash_of_file(path)).collect();
            let content = content.join(" ");
            let mut rows = String::new();
            for (gate, claim) in selected.claims.iter().enumerate() {
                let keys: Vec<String> = claim.runs.iter().map(Run::key).collect();
                let runs = keys.join("|");
                let programs = self.programs(selected.case, claim);
                let words =
                    format!("{case}|{content}|{stranger}|{programs}|{runs}|{}|{}", claim.quantity, claim.control.name);
                // Two claims may have equal descriptions.
                let number = seen.entry(words.clone()).and_modify(|number| *number += 1).or_default();
                rows += &words;
                pieces.push((
                    Id::of_words(program, &["row", &words, &number.to_string(), &settings]),
                    WorkItem::Row(at, gate),
                ));
            }
            pieces.push((Id::of_words(program, &["figures", &rows, &settings]), WorkItem::Figures(at)));
        }
        if self.owes() {
            for (at, (solver, _)) in conform::owing(&self.options.solver)?.iter().enumerate() {
                let name = solver.name();
                pieces.push((
                    Id::of_words(program, &["owed", &name, &self.strangers.edition(&name)]),
                    WorkItem::Owed(at),
                ));
            }
        }
        Ok(pieces)
    }

    /// Returns the work items of a plan.
    ///
    /// # Errors
    /// The cases or programs have changed since the plan was written.
    fn planned(&self, plan: &Plan) -> Result<Vec<(Id, WorkItem)>, Fault> {
        let pieces = self.pieces(&plan.head.program)?;
        let known: HashSet<Id> = plan.tasks.iter().map(|task| task.id).collect();
        if pieces.iter().all(|(id, _)| known.contains(id)) {
            return Ok(pieces);
        }
        let path = plan.path.display();
        Err(Fault::input(format!(
            "{path}: the cases or programs have changed; write the plan again, unchanged tasks stay finished"
        )))
    }

    /// Returns the hashes of the installed programs that a claim runs. Stored runs need no program.
    fn programs(&self, case: &Case, claim: &Claim) -> String {
        let runs = claim.runs.iter().filter(|run| self.options.live || !Registry.is_stored(case, run));
        runs.map(|run| Registry.edition(run.solver)).collect::<Vec<_>>().join(" ").trim().to_owned()
    }

    /// Estimates the duration of a claim with its control (s).
    fn seconds(&self, runner: &Runner, claim: &Claim) -> f64 {
        let once = |run: &Run| {
            let start = if grainbench::cases::solvers::is_program(run.solver) { START } else { 0.0 };
            if run.kept && !self.thorough {
                return KEPT;
            }
            let scene = runner.scene(run);
            start + scene.map_or(0.0, |scene| nominal_seconds(&scene, &run.resolution))
        };
        let all: f64 = claim.runs.iter().map(once).sum();
        if self.options.no_controls { all } else { 2.0 * all }
    }

    fn runners(&self) -> Vec<OnceLock<Runner>> {
        self.selected.iter().map(|_| OnceLock::new()).collect()
    }
}

/// Returns the files that the results of a case depend on; none if the case is built in.
fn files_of(selected: &CaseSelection) -> Result<Vec<PathBuf>, Fault> {
    if CASES.iter().any(|case| std::ptr::eq(*case, selected.case)) {
        return Ok(Vec::new());
    }
    folder::files(&selected.case.directory()).map_err(Fault::input)
}

/// Evaluates a claim and its control.
fn row(selected: &CaseSelection, runner: &Runner, gate: usize, controls: bool) -> (State, Part) {
    let claim = &selected.claims[gate];
    let verdict = runner.judge(claim);
    let tried = controls && runner.tries_control(claim, &verdict);
    let control = tried.then(|| runner.control(claim));
    // A solver that is missing now may be available in a later attempt.
    let is_failed = matches!(verdict.outcome, verdict::Outcome::Broken | verdict::Outcome::NotAvailable);
    let state = if is_failed { State::Failed } else { State::Done };
    let mut part = Part { keys: Vec::new(), section: run::blank(selected), without: None };
    part.section.verdicts.push(verdict);
    part.section.controls.extend(control);
    for run in &claim.runs {
        if let Ok(done) = runner.run(run) {
            part.keys.push(run.key());
            part.section.runs.push(run::cost(run, &done));
        }
    }
    (state, in_short(part))
}

/// Draws the figures of a case.
fn figures(selected: &CaseSelection, runner: &Runner) -> (State, Part) {
    let mut part = Part { keys: Vec::new(), section: run::blank(selected), without: None };
    match run::draw(selected, runner) {
        Ok(figures) => part.section.figures = figures,
        Err(error) => part.without = Some(error.to_string()),
    }
    for (run, done) in runner.done() {
        part.keys.push(run.key());
        part.section.runs.push(run::cost(&run, &done));
    }
    (if part.without.is_some() { State::Failed } else { State::Done }, in_short(part))
}

/// Removes the texts that the report takes from the case.
fn in_short(part: Part) -> Part {
    let nothing = String::new;
    let section = Section { claim: nothing(), derivation: nothing(), weak: nothing(), ..part.section };
    Part { section, ..part }
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
        let runners: Vec<Runner> = self
            .selected
            .iter()
            .map(|selected| run::runner(selected, &self.options, self.thorough, Arc::clone(&solvers)))
            .collect();
        let owing = if self.owes() { conform::owing(&self.options.solver)? } else { Vec::new() };
        let task = |(id, piece): (Id, WorkItem)| {
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
            match piece {
                WorkItem::Row(at, gate) => {
                    let selected = &self.selected[at];
                    let claim = &selected.claims[gate];
                    let first = claim.runs.first();
                    let variant = first.map_or("", |run| run.variant);
                    let ours = first.map_or("", |run| run.solver).to_owned();
                    let solver = selected.stranger.as_ref().map_or(ours, |other| other.manifest().name.clone());
                    let seconds = self.seconds(&runners[at], claim);
                    let scene = format!("{}/{variant}", selected.case.name);
                    new(scene, solver, claim.resolution(), claim.quantity.clone(), seconds)
                }
                WorkItem::Figures(at) => {
                    let name = self.selected[at].case.name.to_owned();
                    new(name, String::new(), String::new(), "figures".to_owned(), FIGURES)
                }
                WorkItem::Owed(at) => {
                    let solver = owing[at].0.name();
                    new(
                        "conformance".to_owned(),
                        solver,
                        String::new(),
                        "conformance properties".to_owned(),
                        CONFORMANCE,
                    )
                }
            }
        };
        Ok(self.pieces(program)?.into_iter().map(task).collect())
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        // A folder that cannot be read is reported when the tasks are listed.
        let files = self.selected.iter().flat_map(|selected| files_of(selected).unwrap_or_default());
        let mut inputs = self.strangers.inputs();
        inputs.extend(files.map(|path| (path.display().to_string(), hash_of_file(&path))));
        inputs
    }

    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault> {
        let cache = cache::open(false);
        let solvers = cache::solvers(cache.as_ref());
        let known: HashMap<Id, WorkItem> = self.planned(plan)?.into_iter().collect();
        let owing = if self.owes() { conform::owing(&self.options.solver)? } else { Vec::new() };
        let runners = self.runners();
        let runner = |at: usize| {
            let new = || run::runner(&self.selected[at], &self.options, self.thorough, Arc::clone(&solvers));
            runners[at].get_or_init(new)
        };
        let do_piece = |piece: usize| {
            let id = tasks[piece].id;
            match known.get(&id) {
                Some(&WorkItem::Row(at, gate)) => {
                    let controls = !self.options.no_controls;
                    desk.attempt(id, || row(&self.selected[at], runner(at), gate, controls));
                }
                Some(&WorkItem::Figures(at)) => desk.attempt(id, || figures(&self.selected[at], runner(at))),
                Some(&WorkItem::Owed(at)) => desk.attempt(id, || {
                    let (solver, terms) = &owing[at];
                    let (verdicts, controls) = conformance::judge(&**solver, terms);
                    let section = Section { title: String::new(), ..conform::section_of(verdicts, controls) };
                    (State::Done, in_short(Part { keys: Vec::new(), section, without: None }))
                }),
                None => {}
            }
        };
        share(tasks.len(), jobs, || desk.goes_on(), do_piece);
        if let Some(cache) = &cache {
            cache.make_room();
        }
        Ok(())
    }

    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome {
        let mut sections: Vec<Section> = self.selected.iter().map(run::blank).collect();
        let mut runs: Vec<BTreeMap<String, RunCost>> = vec![BTreeMap::new(); sections.len()];
        let (mut verdicts, mut controls) = (Vec::new(), Vec::new());
        for (id, piece) in self.planned(plan)? {
            let part: Part = match (came(finished, id), piece) {
                (TaskResult::Out(part), _) => part,
                (TaskResult::Nothing, _) => continue,
                (TaskResult::Crash(detail), WorkItem::Row(at, gate)) => {
                    let selected = &self.selected[at];
                    let runner = run::runner(selected, &self.options, self.thorough, cache::solvers(None));
                    sections[at].verdicts.push(runner.crashed(&selected.claims[gate], detail));
                    continue;
                }
                (TaskResult::Crash(detail), _) => {
                    exit::say("warning", &format!("figures or conformance properties are omitted: {detail}"));
                    continue;
                }
            };
            match piece {
                WorkItem::Row(at, _) | WorkItem::Figures(at) => {
                    if let Some(error) = part.without {
                        let case = &sections[at].name;
                        exit::say("warning", &format!("{case}: its figures are omitted: {error}"));
                    }
                    runs[at].extend(part.keys.into_iter().zip(part.section.runs));
                    sections[at].figures.extend(part.section.figures);
                    sections[at].verdicts.extend(part.section.verdicts);
                    sections[at].controls.extend(part.section.controls);
                }
                WorkItem::Owed(_) => {
                    verdicts.extend(part.section.verdicts);
                    controls.extend(part.section.controls);
                }
            }
        }
        for (section, runs) in sections.iter_mut().zip(runs) {
            section.runs = runs.into_values().collect();
        }
        if self.owes() && !verdicts.is_empty() {
            sections.push(conform::section_of(verdicts, controls));
        }
        let mut words = run::words(&self.arguments.cases, &self.options);
        words.extend(how.words.iter().cloned());
        let is_whole = self.is_whole && self.options.solver.is_empty();
        let mut report = run::report(provenance(words, how.seconds), sections, is_whole)?;
        let is_mute = self.selected.iter().any(|selection| selection.stranger.is_some()) && run::says_nothing(&report);
        report.red_because.extend(how.unfinished.clone());
        run::add_reasons(&mut report, is_mute, how.strict);
        let write = if how.parquet { write_report_and_parquet } else { write_report };
        write(how.out, &report).map_err(Fault::writing)?;
        if how.json {
            print(&results_json(&report).map_err(Fault::input)?)?;
        } else {
            print(&format!("{}\n{}\n", summary_table(&report), how.out.join("index.html").display()))?;
        }
        Ok(run::exit_code(&report, how.strict))
    }
}
