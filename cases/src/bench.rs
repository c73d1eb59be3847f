//! Does the runs of a case, each once, whoever asks for it.

use crate::case::Case;
use crate::gate::{Change, Control, Done, Gate, Measured, Missing, Run, Standing, Wrong};
use crate::scope::Scope;
use crate::solvers;
use crate::stored;
use crate::verdict::{self, Outcome, Verdict};
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{RunError, Solver};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

type Slot = Arc<OnceLock<Result<Done, RunError>>>;

/// The workbench of one case: of the solvers that its gates name, or of one solver in place of them all.
pub struct Bench {
    case: &'static Case,
    stranger: Option<Arc<dyn Solver>>,
    /// Whether other programs are run even where their runs are stored.
    live: bool,
    /// Whether figures may take as long as the finest rungs do.
    thorough: bool,
    /// By [`Run::key`].
    runs: Mutex<BTreeMap<String, (Run, Slot)>>,
    /// Of negative controls, by run and change.
    wrong: Mutex<BTreeMap<String, (Change, Slot)>>,
}

impl Bench {
    /// A bench without runs.
    #[must_use]
    pub fn new(case: &'static Case) -> Self {
        Self { case, stranger: None, live: false, thorough: false, runs: Mutex::default(), wrong: Mutex::default() }
    }

    /// A bench on which one solver takes the place of every solver that the gates name. It is given their resolutions,
    /// to be read as it sees fit.
    #[must_use]
    pub fn with_solver(case: &'static Case, solver: Arc<dyn Solver>) -> Self {
        Self { stranger: Some(solver), ..Self::new(case) }
    }

    /// The bench on which other programs are run even where their runs are stored.
    #[must_use]
    pub fn live(self, live: bool) -> Self {
        Self { live, ..self }
    }

    /// The bench whose figures are drawn from the finest runs, which take minutes.
    #[must_use]
    pub fn thorough(self, thorough: bool) -> Self {
        Self { thorough, ..self }
    }

    /// Whether figures may take as long as the finest rungs do.
    #[must_use]
    pub const fn is_thorough(&self) -> bool {
        self.thorough
    }

    /// The gates of this bench: all of the case, or those that are fair to a stranger.
    #[must_use]
    pub fn gates(&self) -> Vec<Gate> {
        let mut gates = (self.case.gates)();
        if self.stranger.is_some() {
            gates.retain(|gate| gate.scope == Scope::AnySolver);
        }
        gates
    }

    /// The case.
    #[must_use]
    pub const fn case(&self) -> &'static Case {
        self.case
    }

    /// A run, done now or before.
    ///
    /// # Errors
    /// When the solver cannot run the scene or breaks.
    pub fn run(&self, run: &Run) -> Result<Done, RunError> {
        let slot = {
            let mut runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
            let (_, slot) = runs.entry(run.key()).or_insert_with(|| (run.clone(), Slot::default()));
            Arc::clone(slot)
        };
        slot.get_or_init(|| self.simulate(run, None)).clone()
    }

    /// Every run done so far, in the order of their keys.
    #[must_use]
    pub fn done(&self) -> Vec<(Run, Done)> {
        let runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
        runs.values().filter_map(|(run, slot)| Some((run.clone(), slot.get()?.as_ref().ok()?.clone()))).collect()
    }

    /// Whether all runs of a gate can be had on this machine; a gate that cannot be judged has no control either.
    #[must_use]
    pub fn is_available(&self, gate: &Gate) -> bool {
        let is_stored = |run: &Run| !self.live && stored::exists(self.case, run);
        let can_run = |run: &Run| self.solver(run.solver).is_none_or(|solver| solver.available().is_ok());
        gate.runs.iter().all(|run| is_stored(run) || can_run(run))
    }

    /// Judges a gate.
    #[must_use]
    pub fn judge(&self, gate: &Gate) -> Verdict {
        let done: Result<Vec<Done>, RunError> = gate.runs.iter().map(|run| self.run(run)).collect();
        self.conclude(gate, done)
    }

    /// Feeds a gate with its wrong physics; the row of a known error with a solver that does not have it.
    #[must_use]
    pub fn control(&self, gate: &Gate) -> verdict::Control {
        let done = gate.runs.iter().map(|run| match &gate.control.wrong {
            _ if run.aside => self.run(run),
            // What is made wrong is our own side.
            Wrong::Ours(_) | Wrong::OtherSolver(_) if solvers::is_program(run.solver) => self.run(run),
            // Another solver's run may be one of those that gates read.
            Wrong::OtherSolver(solver) if self.stranger.is_none() => self.run(&Run { solver, ..run.clone() }),
            Wrong::OtherRun(solver, resolution) if self.stranger.is_none() => {
                self.run(&Run { solver, resolution: *resolution, ..run.clone() })
            }
            Wrong::Ours(change) => self.run_wrong(run, &gate.control, change),
            _ => self.simulate(run, Some(&gate.control)),
        });
        let done = done.collect();
        let verdict = self.conclude(gate, done);
        verdict::Control {
            case: verdict.case,
            variant: verdict.variant,
            solver: verdict.solver,
            quantity: verdict.quantity,
            wrong_physics: gate.control.name.to_owned(),
            error: verdict.error,
            allowed: verdict.allowed,
            turned_red: match gate.standing() {
                Standing::Known(_) => verdict.outcome == Outcome::Pass,
                Standing::Passes | Standing::Refused => matches!(verdict.outcome, Outcome::Fail | Outcome::Broken),
            },
        }
    }

    /// A run of a wrong scene. Gates that share a control share its runs; the change is kept with them, so that no other
    /// can take its address.
    fn run_wrong(&self, run: &Run, control: &Control, change: &Change) -> Result<Done, RunError> {
        let key = format!("{}|{:p}", run.key(), Arc::as_ptr(change));
        let slot = {
            let mut wrong = self.wrong.lock().unwrap_or_else(PoisonError::into_inner);
            let (_, slot) = wrong.entry(key).or_insert_with(|| (Arc::clone(change), Slot::default()));
            Arc::clone(slot)
        };
        slot.get_or_init(|| self.simulate(run, Some(control))).clone()
    }

    fn simulate(&self, run: &Run, control: Option<&Control>) -> Result<Done, RunError> {
        let scene = self.scene(run)?;
        if control.is_none()
            && self.stranger.is_none()
            && !self.live
            && let Some(record) = stored::record(self.case, run, &scene)
        {
            return Ok(Done { scene: Arc::new(scene), record: Arc::new(record?) });
        }
        let mut given = scene.clone();
        let solver = match control.map(|control| &control.wrong) {
            None => self.solver(run.solver),
            Some(Wrong::Scene(change) | Wrong::Ours(change)) => {
                change(&mut given);
                self.solver(run.solver)
            }
            Some(Wrong::OtherSolver(name) | Wrong::OtherRun(name, _)) => self.solver(name),
            Some(Wrong::Solver(defect)) => Convention::ALL
                .into_iter()
                .find(|convention| convention.name == run.solver)
                .map(|convention| Arc::new(Dem::new(convention).with_defect(*defect)) as Arc<dyn Solver>),
        };
        let solver = solver.ok_or_else(|| self.unusable(run, "there is no such solver".to_owned()))?;
        let resolution = match control.map(|control| &control.wrong) {
            Some(Wrong::OtherRun(_, resolution)) => resolution,
            _ => &run.resolution,
        };
        let record = solver.run(&given, resolution, &mut ())?;
        Ok(Done { scene: Arc::new(scene), record: Arc::new(record) })
    }

    /// The scene of a run as the case means it.
    ///
    /// # Errors
    /// When the scene file is wrong.
    pub fn scene(&self, run: &Run) -> Result<Scene, RunError> {
        let variant = self.case.variant(run.variant);
        let mut scene = variant.map_err(|error| self.unusable(run, error.to_string()))?;
        if let Some((_, change)) = &run.adjustment {
            change(&mut scene);
        }
        Ok(scene)
    }

    /// The solver that does the runs of a name.
    fn solver(&self, name: &str) -> Option<Arc<dyn Solver>> {
        self.stranger.clone().or_else(|| solvers::by_name(name).map(Arc::from))
    }

    /// What rows call the solver of a run.
    fn solver_name(&self, run: &Run) -> String {
        self.stranger.as_ref().map_or_else(|| run.solver.to_owned(), |solver| solver.name())
    }

    fn unusable(&self, run: &Run, reason: String) -> RunError {
        RunError::Unsupported { solver: self.solver_name(run), reason }
    }

    fn conclude(&self, gate: &Gate, done: Result<Vec<Done>, RunError>) -> Verdict {
        let first = gate.runs.first();
        let row = Verdict {
            case: self.case.name.to_owned(),
            variant: first.map_or_else(String::new, |run| run.variant.to_owned()),
            solver: first.map_or_else(String::new, |run| self.solver_name(run)),
            resolution: gate.resolution(),
            quantity: gate.quantity.clone(),
            unit: gate.unit.to_owned(),
            value: None,
            expected: None,
            scale: None,
            error: None,
            allowed: gate.allowed,
            because: gate.because.to_owned(),
            evidence: gate.evidence,
            source: gate.source.to_owned(),
            outcome: Outcome::Fail,
            detail: None,
        };
        conclude(row, gate, done)
    }
}

/// Completes a row with what was measured.
fn conclude(mut verdict: Verdict, gate: &Gate, done: Result<Vec<Done>, RunError>) -> Verdict {
    match done {
        Err(error) => {
            verdict.outcome = Outcome::from(&error);
            verdict.detail = Some(error.to_string());
        }
        Ok(done) => match measure(&mut verdict, gate, &done) {
            Err(missing) => verdict.detail = Some(missing.to_string()),
            Ok(measured) => {
                let error = measured.error();
                let finite = |value: f64| value.is_finite().then_some(value);
                verdict.value = finite(measured.value);
                verdict.expected = finite(measured.expected);
                verdict.scale = finite(measured.scale);
                verdict.error = finite(error);
                if error.abs() <= gate.allowed {
                    verdict.outcome = Outcome::Pass;
                } else if let (Standing::Known(reason), true) = (gate.standing(), error.is_finite()) {
                    verdict.outcome = Outcome::Known;
                    verdict.detail = Some(reason.to_owned());
                } else {
                    verdict.detail = measured.first_outside(gate.allowed);
                }
            }
        },
    }
    verdict
}

/// What the gate measures; the row says which programs it was compared with.
fn measure(verdict: &mut Verdict, gate: &Gate, done: &[Done]) -> Result<Measured, Missing> {
    for run in done.iter().map(|done| &done.record.provenance).filter(|run| solvers::is_program(&run.solver)) {
        verdict.source.push_str(&format!(": {}", run.options.join(", ")));
    }
    (gate.measure)(done)
}
