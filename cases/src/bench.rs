//! Does the runs of a case, each once, whoever asks for it.

use crate::case::Case;
use crate::gate::{Control, Done, Gate, Run, Wrong};
use crate::solvers;
use crate::verdict::{self, Outcome, Verdict};
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{RunError, Solver};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

type Slot = Arc<OnceLock<Result<Done, RunError>>>;

/// The workbench of one case.
pub struct Bench {
    case: &'static Case,
    /// By [`Run::key`].
    runs: Mutex<BTreeMap<String, (Run, Slot)>>,
}

impl Bench {
    /// A bench without runs.
    #[must_use]
    pub fn new(case: &'static Case) -> Self {
        Self { case, runs: Mutex::new(BTreeMap::new()) }
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

    /// Judges a gate.
    #[must_use]
    pub fn judge(&self, gate: &Gate) -> Verdict {
        let done: Result<Vec<Done>, RunError> = gate.runs.iter().map(|run| self.run(run)).collect();
        conclude(self.case, gate, done)
    }

    /// Feeds a gate with its wrong physics.
    #[must_use]
    pub fn control(&self, gate: &Gate) -> verdict::Control {
        let done = gate.runs.iter().map(|run| self.simulate(run, Some(&gate.control))).collect();
        let verdict = conclude(self.case, gate, done);
        verdict::Control {
            case: verdict.case,
            variant: verdict.variant,
            solver: verdict.solver,
            quantity: verdict.quantity,
            wrong_physics: gate.control.name.to_owned(),
            error: verdict.error,
            allowed: verdict.allowed,
            turned_red: matches!(verdict.outcome, Outcome::Fail | Outcome::Broken),
        }
    }

    fn simulate(&self, run: &Run, control: Option<&Control>) -> Result<Done, RunError> {
        let unusable = |reason: String| RunError::Unsupported { solver: run.solver.to_owned(), reason };
        let mut scene = self.case.variant(run.variant).map_err(|error| unusable(error.to_string()))?;
        if let Some((_, change)) = &run.adjustment {
            change(&mut scene);
        }
        let mut given = scene.clone();
        let solver = match control.map(|control| &control.wrong) {
            None => solver(run.solver),
            Some(Wrong::Scene(change)) => {
                change(&mut given);
                solver(run.solver)
            }
            Some(Wrong::OtherSolver(name)) => solver(name),
            Some(Wrong::Solver(defect)) => Convention::ALL
                .into_iter()
                .find(|convention| convention.name == run.solver)
                .map(|convention| Box::new(Dem::new(convention).with_defect(*defect)) as Box<dyn Solver>),
        };
        let solver = solver.ok_or_else(|| unusable("there is no such solver".to_owned()))?;
        let record = solver.run(&given, &run.resolution, &mut ())?;
        Ok(Done { scene: Arc::new(scene), record: Arc::new(record) })
    }

    /// The scene of a run as the case means it.
    ///
    /// # Errors
    /// When the scene file is wrong.
    pub fn scene(&self, run: &Run) -> Result<Scene, RunError> {
        let mut scene = self
            .case
            .variant(run.variant)
            .map_err(|error| RunError::Unsupported { solver: run.solver.to_owned(), reason: error.to_string() })?;
        if let Some((_, change)) = &run.adjustment {
            change(&mut scene);
        }
        Ok(scene)
    }
}

fn solver(name: &str) -> Option<Box<dyn Solver>> {
    solvers::by_name(name)
}

fn conclude(case: &Case, gate: &Gate, done: Result<Vec<Done>, RunError>) -> Verdict {
    let (variant, solver) = gate.runs.first().map_or(("", ""), |run| (run.variant, run.solver));
    let mut verdict = Verdict {
        case: case.name.to_owned(),
        variant: variant.to_owned(),
        solver: solver.to_owned(),
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
    match done {
        Err(error) => {
            verdict.outcome = match error {
                RunError::Unsupported { .. } => Outcome::Unsupported,
                RunError::Resolution { .. } | RunError::Broken(_) => Outcome::Broken,
            };
            verdict.detail = Some(error.to_string());
        }
        Ok(done) => match (gate.measure)(&done) {
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
                } else {
                    let outside = |error: f64| error.is_nan() || error.abs() > gate.allowed;
                    verdict.detail = measured
                        .course
                        .iter()
                        .find(|(_, error)| outside(*error))
                        .map(|(time, _)| format!("first outside at t = {time:.6} s"));
                }
            }
        },
    }
    verdict
}
