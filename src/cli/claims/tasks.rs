//! Tasks of `run` and `conform`, in memory or from a plan: one for each claim with its negative control, one for the
//! figures of each case, and one for the conformance of each solver.

use super::conformance::{self as conform, ConformingSolver};
use crate::cli::cache;
use crate::cli::earlier::EarlierReport;
use crate::cli::exit::{self, Fault, Outcome, refuse};
use crate::cli::filter::Filters;
use crate::cli::jobs::arguments::Arguments;
use crate::cli::jobs::study::{ReportOptions, Study, check_ids};
use crate::cli::provenance::provenance;
use crate::cli::publish::{Output, add_reasons, publish};
use crate::cli::select::{self, CaseSelection};
use crate::cli::solver::{NamedSolvers, is_manifest};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::{Registry, is_program};
use grainbench::cases::{folder, stored};
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::course;
use grainbench::harness::mistake;
use grainbench::harness::run::{FinishedRun, Run, Set};
use grainbench::harness::runner::{Runner, RunnerOptions};
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::plan::Plan;
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::{RunCost, Section};
use grainbench::solver::Solver;
use grainbench::store::key;
use grainbench::store::log::State;
use grainbench::studies::cost::knobs::nominal_seconds;
use grainbench::studies::run_cache::RunCache;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Expected duration of the figures of a case, without their runs (s).
const FIGURES: f64 = 0.5;
/// Expected duration of the conformance tests of one solver (s).
const CONFORMANCE: f64 = 2.0;
/// Expected duration of loading a stored result (s).
const KEPT: f64 = 0.1;
/// Expected duration of starting an external program (s).
const START: f64 = 0.5;

/// Claims of cases and conformance properties of solvers. Tasks of the same case share finished runs.
pub(crate) struct ClaimTasks {
    pub(crate) selected: Vec<CaseSelection>,
    /// Solvers whose conformance properties are tested.
    conforming: Vec<ConformingSolver>,
    /// Options of the runners, without an external solver.
    options: RunnerOptions,
    /// True if the tasks cover the whole registry with all solvers.
    pub(crate) is_whole: bool,
    /// Options for the report, in words.
    pub(crate) words: Vec<String>,
    /// External solvers that a plan names.
    external_solvers: NamedSolvers,
    /// All tasks in the order of the report.
    all: Vec<ClaimTask>,
    /// Cache of finished runs, if there is one.
    pub(crate) cache: Option<Arc<RunCache>>,
    solvers: Arc<dyn Solvers>,
    runners: Vec<OnceLock<Runner>>,
}

/// Task of a run. The numbers are indices of the case, of the claim within the case, and of the solver.
#[derive(Clone, Copy)]
enum ClaimTask {
    /// A claim and its control.
    Claim(usize, usize),
    /// Figures of a case.
    Figures(usize),
    /// Conformance properties of a solver.
    Conformance(usize),
}

impl ClaimTasks {
    /// Returns the tasks of a plan.
    pub(crate) fn from_arguments(arguments: &Arguments) -> Result<Self, Fault> {
        let filters = Filters::read(&arguments.filter)?;
        if !filters.outcomes().is_empty() {
            refuse!("--filter: expected quantity, source or evidence (`outcome` is unknown before the run)");
        }
        let tasks = Self::new(arguments, &filters, None, RunnerOptions::default())?.cached(cache::open(false));
        let manifests: Vec<String> = arguments.solver.iter().filter(|name| is_manifest(name)).cloned().collect();
        let (external_solvers, _) = NamedSolvers::read_for(&manifests, true)?;
        Ok(Self { external_solvers, ..tasks })
    }

    /// Returns the tasks of the claims that the arguments, the filters and the earlier report of `--retry-failed` select.
    /// The conformance of solvers is included if the whole registry is selected at its default levels or at all levels.
    /// `options` contains the number of threads and the directory of third-party data.
    pub(crate) fn new(
        arguments: &Arguments,
        filters: &Filters,
        before: Option<&EarlierReport>,
        options: RunnerOptions,
    ) -> Result<Self, Fault> {
        let Arguments { cases, solver, levels, filter, no_controls, live, .. } = arguments;
        let mut selected = select::select(cases, solver, levels)?;
        super::narrow(&mut selected, arguments, filters, before)?;
        let is_whole = cases.is_empty() && filter.is_empty() && before.is_none();
        let thorough = levels.iter().any(|level| level == "all");
        let conforms = is_whole && (levels.is_empty() || thorough);
        let conforming = if conforms { conform::conforming(solver)? } else { Vec::new() };
        Ok(Self {
            is_whole: is_whole && solver.is_empty(),
            words: super::words(arguments, options.data.is_some(), before.is_some()),
            // With all levels, runs with stored results are repeated too.
            options: RunnerOptions {
                live: *live,
                thorough,
                controlled: !no_controls,
                repeated: thorough.then_some(Set::Paper),
                ..options
            },
            ..Self::with(selected, conforming)
        })
    }

    /// Returns the tasks of all claims of the selected cases and of the conformance of solvers, with default options.
    pub(crate) fn with(selected: Vec<CaseSelection>, conforming: Vec<ConformingSolver>) -> Self {
        let of_case = |(case, selected): (usize, &CaseSelection)| {
            let claims = (0..selected.claims.len()).map(move |claim| ClaimTask::Claim(case, claim));
            claims.chain([ClaimTask::Figures(case)])
        };
        let of_cases = selected.iter().enumerate().flat_map(of_case);
        Self {
            all: of_cases.chain((0..conforming.len()).map(ClaimTask::Conformance)).collect(),
            runners: selected.iter().map(|_| OnceLock::new()).collect(),
            selected,
            conforming,
            options: RunnerOptions::default(),
            is_whole: false,
            words: Vec::new(),
            external_solvers: NamedSolvers::default(),
            cache: None,
            solvers: Arc::new(Registry),
        }
    }

    /// Sets the cache of finished runs.
    pub(crate) fn cached(self, cache: Option<Arc<RunCache>>) -> Self {
        Self { solvers: cache::with(Registry, cache.as_ref()), cache, ..self }
    }

    /// Returns the indices of all tasks in the order of their execution. Claims that need a new run come first, and claims
    /// that need only runs of earlier claims follow. All cases progress evenly. Two threads therefore seldom work on
    /// one case, where they would wait for the same scene or run. Figures come last, because they use finished runs.
    pub(crate) fn order(&self) -> Vec<usize> {
        let mut turns = Vec::new();
        for selected in &self.selected {
            let mut asked = HashSet::new();
            for (place, claim) in selected.claims.iter().enumerate() {
                let known = asked.len();
                asked.extend(claim.runs.iter().map(Run::key));
                let turn = place as f64 / selected.claims.len() as f64;
                turns.push(if asked.len() > known { turn } else { 1.0 + turn });
            }
            turns.push(3.0);
        }
        turns.extend(self.conforming.iter().map(|_| 2.0));
        let mut order: Vec<usize> = (0..turns.len()).collect();
        order.sort_by(|a, b| turns[*a].total_cmp(&turns[*b]));
        order
    }

    /// Returns a runner for the selected case with index `case`, set up by the command's options.
    fn runner(&self, case: usize) -> &Runner {
        self.runners[case].get_or_init(|| {
            let selected = &self.selected[case];
            let external = selected.external.as_ref().map(|external| Arc::clone(external) as Arc<dyn Solver>);
            let options = RunnerOptions { external, ..self.options.clone() };
            Runner::new(selected.case, Arc::clone(&self.solvers)).with(options)
        })
    }

    /// Returns the sections of a report from the results of its tasks. The detail of a failed result names a known mistake
    /// that gives the same error, if there is one.
    pub(crate) fn sections(&self, results: Vec<Option<Result<Section, String>>>) -> Vec<Section> {
        let mut cases: Vec<(Section, Vec<&Claim>)> =
            self.selected.iter().map(|selected| (blank(selected), Vec::new())).collect();
        let mut conformance = conform::section();
        for (&task, result) in self.all.iter().zip(results) {
            let finished = match (result, task) {
                (None, _) => continue,
                (Some(Ok(finished)), _) => finished,
                (Some(Err(detail)), ClaimTask::Claim(case, claim)) => {
                    let row = self.runner(case).crashed(&self.selected[case].claims[claim], detail);
                    Section { verdicts: vec![row], ..Section::default() }
                }
                (Some(Err(detail)), _) => {
                    exit::say("warning", &format!("figures or conformance properties are omitted: {detail}"));
                    continue;
                }
            };
            match task {
                ClaimTask::Conformance(_) => conformance.add(finished),
                ClaimTask::Figures(case) => cases[case].0.add(finished),
                ClaimTask::Claim(case, claim) => {
                    let (section, judged) = &mut cases[case];
                    judged.extend(finished.verdicts.iter().map(|_| &self.selected[case].claims[claim]));
                    section.add(finished);
                }
            }
        }
        let mut sections = Vec::new();
        for (selected, (mut section, judged)) in self.selected.iter().zip(cases) {
            if let Some(error) = &section.omitted {
                exit::say("warning", &format!("{}: its figures are omitted: {error}", selected.case.name));
            }
            mistake::explain(selected.case, &self.solvers, &judged, &mut section.verdicts);
            section.finish_runs();
            sections.push(section);
        }
        if !conformance.verdicts.is_empty() {
            sections.push(conformance);
        }
        sections
    }
}

impl TaskList for ClaimTasks {
    type Output = Section;

    fn perform(&self, place: usize, sink: &ResultSink<'_, Section>) -> (State, Section) {
        let task = self.all[place];
        match task {
            ClaimTask::Claim(case, _) | ClaimTask::Figures(case) => sink.now(self.selected[case].case.name),
            ClaimTask::Conformance(solver) => sink.now(&self.conforming[solver].0.name()),
        }
        match task {
            ClaimTask::Claim(case, claim) => self.claim(case, claim),
            ClaimTask::Figures(case) => self.figures(case),
            ClaimTask::Conformance(solver) => {
                let (verdicts, controls) = conform::judge(&self.conforming[solver], &self.solvers);
                (State::Done, Section { verdicts, controls, ..Section::default() })
            }
        }
    }
}

impl Study for ClaimTasks {
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        self.planned(program, true)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        // If a folder cannot be read, the error is reported when the tasks are listed.
        let files = self.selected.iter().flat_map(|selected| files_of(selected).unwrap_or_default());
        let mut inputs = self.external_solvers.inputs();
        inputs.extend(files.map(|path| (path.display().to_string(), key::of_file(&path))));
        inputs
    }

    fn check(&self, plan: &Plan) -> Result<(), Fault> {
        check_ids(plan, &self.planned(&plan.head.program, false)?)
    }

    fn report(&self, results: Vec<Option<Result<Section, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let sections = self.sections(results);
        let words = self.words.iter().chain(&how.words).cloned().collect();
        let mut report = super::report(provenance(words, how.seconds), sections, self.is_whole)?;
        report.red_because.extend(how.unfinished.clone());
        add_reasons(&mut report, false, how.strict);
        publish(&report, &Output { parquet: how.parquet, ..Output::new(&how.out, how.json) })
    }
}

impl ClaimTasks {
    /// Returns the tasks of a plan in the order of the report. Expected durations need the scenes of all claims, so they
    /// are omitted without `has_seconds`.
    fn planned(&self, program: &str, has_seconds: bool) -> Result<Vec<Task>, Fault> {
        let mut tasks = Vec::new();
        let mut seen: HashMap<String, usize> = HashMap::new();
        let RunnerOptions { controlled, live, thorough, .. } = self.options;
        let settings = format!("{} {live} {thorough}", !controlled);
        for (at, selected) in self.selected.iter().enumerate() {
            let external = match &selected.external {
                Some(outside) => outside.edition().map_err(Fault::input)?,
                None => String::new(),
            };
            let case = selected.case.name;
            let content: Vec<String> = files_of(selected)?.iter().map(|path| key::of_file(path)).collect();
            let content = content.join(" ");
            let mut rows = String::new();
            for claim in &selected.claims {
                let runs = claim.runs.iter().map(Run::key).collect::<Vec<_>>().join("|");
                let programs = self.programs(selected.case, claim);
                let words =
                    format!("{case}|{content}|{external}|{programs}|{runs}|{}|{}", claim.quantity, claim.control.name);
                // Two claims may have equal descriptions, so their ids contain a number.
                let number = seen.entry(words.clone()).and_modify(|number| *number += 1).or_default();
                rows += &words;
                let (variant, ours) = claim.runs.first().map_or(("", ""), |run| (run.variant, run.solver));
                let solver = selected.external.as_ref().map_or(ours, |external| &external.manifest().name);
                let seconds = if has_seconds { self.seconds(self.runner(at), claim) } else { 0.0 };
                tasks.push(Task {
                    scene: format!("{case}/{variant}"),
                    solver: solver.to_owned(),
                    level: claim.resolution(),
                    what: claim.quantity.clone(),
                    ..Task::new(Id::of_words(program, &["row", &words, &number.to_string(), &settings]), seconds)
                });
            }
            tasks.push(Task {
                scene: case.to_owned(),
                what: "figures".to_owned(),
                ..Task::new(Id::of_words(program, &["figures", &rows, &settings]), FIGURES)
            });
        }
        for (solver, _) in &self.conforming {
            let solver = solver.name();
            let id = Id::of_words(program, &["owed", &solver, &self.external_solvers.edition(&solver)]);
            let what = "conformance properties".to_owned();
            tasks.push(Task { scene: "conformance".to_owned(), solver, what, ..Task::new(id, CONFORMANCE) });
        }
        Ok(tasks)
    }

    /// Returns the hashes of the installed programs that a claim runs. A stored run needs no program.
    fn programs(&self, case: &Case, claim: &Claim) -> String {
        let runs = claim.runs.iter().filter(|run| self.options.live || !stored::exists(case, run));
        runs.map(|run| Registry.edition(run.solver)).collect::<Vec<_>>().join(" ").trim().to_owned()
    }

    /// Estimates the duration of a claim with its negative control (s).
    fn seconds(&self, runner: &Runner, claim: &Claim) -> f64 {
        let once = |run: &Run| {
            let start = if is_program(run.solver) { START } else { 0.0 };
            if run.kept && !self.options.thorough {
                return KEPT;
            }
            let scene = runner.scene(run);
            start + scene.map_or(0.0, |scene| nominal_seconds(&scene, &run.resolution))
        };
        let all: f64 = claim.runs.iter().map(once).sum();
        if self.options.controlled { 2.0 * all } else { all }
    }

    /// Judges a claim and its negative control.
    fn claim(&self, case: usize, claim: usize) -> (State, Section) {
        let (claim, runner) = (&self.selected[case].claims[claim], self.runner(case));
        let (verdict, control) = runner.judge_and_control(claim, self.options.controlled);
        // A solver that is not installed now may be installed later, so the task can be repeated.
        let is_failed = matches!(verdict.outcome, verdict::Outcome::Broken | verdict::Outcome::NotAvailable);
        let keys: HashSet<String> = claim.runs.iter().map(Run::key).collect();
        let (verdicts, controls) = (vec![verdict], control.into_iter().collect());
        let runs: Vec<RunCost> = runs(runner).filter(|run| keys.contains(&run.key)).collect();
        let state = if is_failed { State::Failed } else { State::Done };
        (state, Section { verdicts, controls, runs, ..Section::default() })
    }

    /// Draws the figures of a case for its selected claims.
    fn figures(&self, case: usize) -> (State, Section) {
        let (selected, runner) = (&self.selected[case], self.runner(case));
        // The case's own figures may need runs that none of the selected claims uses.
        let drawn = match selected.external.is_some() || selected.is_part {
            true => course::figures(runner, &selected.claims),
            false => course::of_case(selected.case, runner, &selected.claims),
        };
        let (figures, omitted) = match drawn {
            Ok(figures) => (figures, None),
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        let state = if omitted.is_some() { State::Failed } else { State::Done };
        (state, Section { figures, omitted, runs: runs(runner).collect(), ..Section::default() })
    }
}

/// Returns the files that the results of a case depend on; none if the case is built in.
fn files_of(selected: &CaseSelection) -> Result<Vec<PathBuf>, Fault> {
    if CASES.iter().any(|case| std::ptr::eq(*case, selected.case)) {
        return Ok(Vec::new());
    }
    Ok(folder::files(&selected.case.directory())?)
}

/// Returns the cost of the finished runs of a runner.
fn runs(runner: &Runner) -> impl Iterator<Item = RunCost> {
    runner.done().into_iter().map(|(run, done)| cost(&run, &done))
}

/// Returns the section of a case before any result is added.
fn blank(selected: &CaseSelection) -> Section {
    let case = selected.case;
    Section {
        name: case.name.to_owned(),
        title: match &selected.external {
            Some(external) => format!("{}: {}", case.title, external.manifest().name),
            None => case.title.to_owned(),
        },
        physics: case.physics,
        claim: case.claim.to_owned(),
        derivation: case.derivation.to_owned(),
        weak: case.weakness.to_owned(),
        ..Section::default()
    }
}

fn cost(run: &Run, done: &FinishedRun) -> RunCost {
    let (provenance, cost) = (&done.record.provenance, &done.record.cost);
    RunCost {
        key: run.key(),
        variant: run.scene_words(),
        solver: provenance.solver.clone(),
        resolution: run.resolution.to_string(),
        steps: cost.steps,
        particle_steps: cost.particle_steps,
        contact_evaluations: cost.contact_evaluations,
        wall_seconds: cost.wall_seconds,
        time_step: provenance.time_step,
        fraction_of_critical: provenance.critical_time_step.map(|critical| provenance.time_step / critical),
    }
}
