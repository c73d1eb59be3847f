//! Runner of a case. It does each run of the case once and judges the claims.

use crate::case::Case;
use crate::claim::Claim;
use crate::control::{self, WrongPhysics};
use crate::expect::Measurement;
use crate::reading::{self, Table};
use crate::run::{ExpectedOutcome, FinishedRun, ResultOrigin, Run, SceneDataError, Set};
use crate::solvers::Solvers;
use crate::tolerance;
use crate::uncertainty::{Estimate, of_finest};
use crate::verdict::{ControlResult, Outcome, Verdict};
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use grainbench_solver::failure::RunError;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::{Defect, Solver};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// Finished run, with the scene that the solver got; empty until the run has ended.
type Slot = Arc<OnceLock<Result<FinishedRun, RunError>>>;
/// A scene; empty until it is first requested.
type SceneSlot = Arc<OnceLock<Result<Arc<Scene>, RunError>>>;
/// Runs with their outputs, by [`Run::key`].
type Runs = BTreeMap<String, (Run, Result<FinishedRun, RunError>)>;
/// Scenes with the outputs of their runs, by solver, defect, resolution and evaluation.
type Slots = BTreeMap<String, Vec<(Arc<Scene>, Slot)>>;

/// Runner of one case. It uses the solvers named in the claims, or one external solver for all runs.
pub struct Runner {
    case: &'static Case,
    solvers: Arc<dyn Solvers>,
    options: RunnerOptions,
    /// Runs with the scenes as the case defines them, by [`Run::key`].
    runs: Mutex<Runs>,
    /// Scenes as the case defines them, by [`Run::scene_words`].
    scenes: Mutex<BTreeMap<String, SceneSlot>>,
    /// Outputs of all runs, with right or wrong physics, by solver and resolution. Claims with the same scene share a run.
    done: Mutex<Slots>,
}

/// Options of a runner.
#[derive(Clone)]
pub struct RunnerOptions {
    /// External solver that replaces every solver named in the claims. It interprets the resolutions of the claims itself.
    pub external: Option<Arc<dyn Solver>>,
    /// True to run other programs even if their runs are stored.
    pub live: bool,
    /// True if figures may use the finest levels, which take minutes.
    pub thorough: bool,
    /// True if an external solver passes only if it can also run the wrong physics.
    pub controlled: bool,
    /// Number of threads per run.
    pub threads: usize,
    /// Largest tier whose stored runs are repeated; none to repeat no stored run.
    pub repeated: Option<Set>,
    /// Directory of third-party data.
    pub data: Option<PathBuf>,
}

impl Default for RunnerOptions {
    fn default() -> Self {
        Self { external: None, live: false, thorough: false, controlled: true, threads: 1, repeated: None, data: None }
    }
}

/// Solver of a run, optionally with a defect.
#[derive(Clone, Copy)]
struct SolverChoice<'a> {
    solver: &'a str,
    defect: Option<Defect>,
    resolution: &'a Resolution,
    /// Negative control of the run; none for a run of the claim.
    control: Option<&'a control::Control>,
}

impl Runner {
    /// Returns a runner without finished runs.
    #[must_use]
    pub fn new(case: &'static Case, solvers: Arc<dyn Solvers>) -> Self {
        let (runs, scenes, done) = (Mutex::default(), Mutex::default(), Mutex::default());
        Self { case, solvers, options: RunnerOptions::default(), runs, scenes, done }
    }

    /// Sets the options.
    #[must_use]
    pub fn with(self, options: RunnerOptions) -> Self {
        Self { options, ..self }
    }

    /// Returns true if figures may use the finest levels, which take minutes.
    #[must_use]
    pub const fn is_thorough(&self) -> bool {
        self.options.thorough
    }

    /// Returns all claims of the case. With an external solver, returns only the claims that apply to it.
    #[must_use]
    pub fn claims(&self) -> Vec<Claim> {
        let mut claims = (self.case.claims)();
        if let Some(external) = &self.options.external {
            claims.retain(|claim| claim.scope.applies_to(&**external));
        }
        claims
    }

    /// Returns a finished run, and does the run if it was not done before.
    ///
    /// # Errors
    /// When the solver does not support the scene or fails.
    pub fn run(&self, run: &Run) -> Result<FinishedRun, RunError> {
        let key = run.key();
        if let Some((_, done)) = self.runs.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return done.clone();
        }
        let by = SolverChoice { solver: run.solver, defect: None, resolution: &run.resolution, control: None };
        let done = self.done_by(run, by);
        let mut runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
        runs.entry(key).or_insert_with(|| (run.clone(), done)).1.clone()
    }

    /// Returns all successful runs so far, in the order of their keys.
    #[must_use]
    pub fn done(&self) -> Vec<(Run, FinishedRun)> {
        let runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
        runs.values().filter_map(|(run, done)| Some((run.clone(), done.as_ref().ok()?.clone()))).collect()
    }

    /// Returns true if all runs of a claim are available: the data exist, and a result is stored or the solver is installed.
    #[must_use]
    pub fn is_available(&self, claim: &Claim) -> bool {
        let is_stored = |run: &Run| !self.options.live && self.solvers.references().is_stored(self.case, run);
        let can_run = |run: &Run| self.solver(run.solver).is_none_or(|solver| solver.available().is_ok());
        let has_data = |run: &Run| run.data.is_none() || !matches!(self.scene(run), Err(RunError::NotAvailable { .. }));
        claim.runs.iter().all(|run| has_data(run) && (self.is_read_back(run, None) || is_stored(run) || can_run(run)))
    }

    /// Judges a claim. If an external solver passes but cannot run the negative control, the result is unsupported. A
    /// panic gives the outcome `broken`, so that all other results are still reported.
    pub fn judge(&self, claim: &Claim) -> Verdict {
        unless_panicked(|| self.judge_or_panic(claim)).unwrap_or_else(|reason| self.crashed(claim, reason))
    }

    /// Judges a claim. A panic of its evaluation is not caught.
    fn judge_or_panic(&self, claim: &Claim) -> Verdict {
        let row = self.conclude(claim, claim.runs.iter().map(|run| self.run(run)).collect());
        if row.outcome != Outcome::Pass {
            return row;
        }
        let Some(reason) = self.refused_control(claim) else { return row };
        let control = claim.control.name;
        let words = format!("the solver cannot run the negative control of this claim, {control}: {reason}");
        row.left(Outcome::Unsupported, words)
    }

    /// Judges a claim and, if `with_control` is true and the control can be run, its negative control. All runs of the claim must
    /// be available. An external solver must support the claim and be able to run the wrong physics.
    pub fn judge_and_control(&self, claim: &Claim, with_control: bool) -> (Verdict, Option<ControlResult>) {
        let row = self.judge(claim);
        let is_run = || {
            self.options.external.is_none()
                || row.outcome != Outcome::Unsupported && self.refused_control(claim).is_none()
        };
        let control = (with_control && self.is_available(claim) && is_run()).then(|| self.control(claim));
        (row, control)
    }

    /// Returns the reason why an external solver cannot run the wrong physics of a claim; none if it can.
    fn refused_control(&self, claim: &Claim) -> Option<String> {
        let asked = self.options.controlled && self.options.external.is_some();
        // A panic does not mean that the scene is unsupported. The control is then run, and its outcome is `broken`.
        let wrong = |run: &Run| match unless_panicked(|| self.run_wrong(claim, run)) {
            Ok(Err(error @ RunError::Unsupported { .. })) => Some(error.to_string()),
            _ => None,
        };
        if asked { claim.runs.iter().find_map(wrong) } else { None }
    }

    /// Judges a claim under its wrong physics. For a known error, another solver without this error does the runs, and
    /// the claim must pass. After a panic, the claim counts as failed by error.
    pub fn control(&self, claim: &Claim) -> ControlResult {
        let start = Instant::now();
        let under = || self.conclude(claim, claim.runs.iter().map(|run| self.run_wrong(claim, run)).collect());
        let row = unless_panicked(under).unwrap_or_else(|reason| self.crashed(claim, reason));
        let (standing, outcome) = (claim.standing(), row.outcome);
        let control = ControlResult::new(row, claim.control.name, claim.control.red, start.elapsed().as_secs_f64());
        match standing {
            ExpectedOutcome::Known(_) => {
                ControlResult { turned_red: matches!(outcome, Outcome::Pass | Outcome::Outdated), ..control }
            }
            ExpectedOutcome::Passes | ExpectedOutcome::Refused => control,
        }
    }

    /// Does a run of a claim under the wrong physics of its control.
    ///
    /// # Errors
    /// When the solver does not support the scene or fails.
    pub fn run_wrong(&self, claim: &Claim, run: &Run) -> Result<FinishedRun, RunError> {
        let control = &claim.control;
        let resolution = control.resolution.as_ref().unwrap_or(&run.resolution);
        let mut by = SolverChoice { solver: run.solver, defect: None, resolution, control: Some(control) };
        match &control.wrong {
            _ if run.aside => return self.run(run),
            // Only our solver gets the wrong physics.
            WrongPhysics::Ours(_) | WrongPhysics::OtherSolver(_) if self.solvers.is_program(run.solver) => {
                return self.run(run);
            }
            WrongPhysics::Scene(_) | WrongPhysics::Ours(_) => {}
            WrongPhysics::Solver(defect) => by.defect = Some(*defect),
            WrongPhysics::OtherSolver(solver) => by.solver = solver,
            WrongPhysics::OtherRun(solver, resolution) => (by.solver, by.resolution) = (solver, resolution),
            WrongPhysics::OtherVariant(variant) => {
                let done = self.run(&Run { variant, ..run.clone() })?;
                return Ok(FinishedRun { scene: self.scene(run)?, ..done });
            }
            WrongPhysics::Misread(change) => {
                let mut done = self.run(run)?;
                change(Arc::<Vec<Table>>::make_mut(&mut done.tables));
                return Ok(done);
            }
        }
        self.done_by(run, by)
    }

    /// Does a run with a given solver, on the scene of the case or on the scene that a control changes.
    fn done_by(&self, run: &Run, by: SolverChoice<'_>) -> Result<FinishedRun, RunError> {
        let scene = self.scene(run)?;
        let given = changed(&scene, by.control);
        if Arc::ptr_eq(&given, &scene)
            && self.options.external.is_none()
            && run.reading.is_none()
            && !self.options.live
            && by.solver == run.solver
            && by.defect.is_none()
            && let Some(record) = self.solvers.references().stored(self.case, run, &scene)
        {
            return Ok(FinishedRun::new(scene, Arc::new(record?)));
        }
        let slot = self.slot(run, by, &given);
        let left = || {
            if self.is_read_back(run, by.control) {
                self.read_back(run, by, &given)
            } else {
                self.simulate(run, by, &given)
            }
        };
        Ok(FinishedRun { scene, ..slot.get_or_init(left).clone()? })
    }

    /// Returns the stored result of a run.
    fn read_back(&self, run: &Run, by: SolverChoice<'_>, scene: &Arc<Scene>) -> Result<FinishedRun, RunError> {
        let of_control = by.control.map(|control| control.name);
        let none = || Err(self.unreadable(run, "no result is stored; `grainbench reference keep` makes it".to_owned()));
        self.solvers.references().kept(self.case, run, scene, of_control).unwrap_or_else(none)
    }

    /// Returns true if the stored result of a run is used, because its tier is larger than the tiers that are repeated
    /// now. An external solver never uses stored results.
    fn is_read_back(&self, run: &Run, control: Option<&control::Control>) -> bool {
        let set = control.map_or(run.set, |control| run.set.max(control.set));
        let is_wanted_now = self.options.live && self.solvers.is_program(run.solver);
        run.kept
            && self.options.external.is_none()
            && !is_wanted_now
            && self.options.repeated.is_none_or(|repeated| set > repeated)
    }

    /// Returns the slot of a run: one for each combination of scene, solver, defect, resolution and evaluation.
    fn slot(&self, run: &Run, by: SolverChoice<'_>, scene: &Arc<Scene>) -> Slot {
        let key = format!("{}|{:?}|{:?}|{:?}", by.solver, by.defect, by.resolution, run.reading);
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let of_solver = done.entry(key).or_default();
        if let Some((_, slot)) = of_solver.iter().find(|(known, _)| known == scene) {
            return Arc::clone(slot);
        }
        let slot = Slot::default();
        of_solver.push((Arc::clone(scene), Arc::clone(&slot)));
        slot
    }

    fn simulate(&self, run: &Run, by: SolverChoice<'_>, scene: &Arc<Scene>) -> Result<FinishedRun, RunError> {
        let solver = match by.defect {
            None => self.solver(by.solver),
            Some(defect) => self.solvers.with_defect(by.solver, defect),
        };
        let solver = solver.ok_or_else(|| self.unusable(run, "there is no such solver".to_owned()))?;
        let (record, tables) = reading::run(&*solver, scene, by.resolution, self.options.threads, run.reading)?;
        Ok(FinishedRun { tables: Arc::new(tables), ..FinishedRun::new(Arc::clone(scene), Arc::new(record)) })
    }

    /// Returns the scene of a run as the case defines it.
    ///
    /// # Errors
    /// When the scene file is invalid, or third-party data are missing.
    pub fn scene(&self, run: &Run) -> Result<Arc<Scene>, RunError> {
        let slot = {
            let mut scenes = self.scenes.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(scenes.entry(run.scene_words()).or_default())
        };
        slot.get_or_init(|| {
            let mut scene = match run.data {
                None => self.case.variant(run.variant).map_err(|error| self.unreadable(run, error.to_string()))?,
                Some(data) => {
                    let folder = self.options.data.as_deref().ok_or_else(|| data.needs.to_owned());
                    let made = folder.and_then(|folder| (data.scene)(folder).map_err(SceneDataError::into_words));
                    made.map_err(|reason| RunError::NotAvailable { solver: self.solver_name(run), reason })?
                }
            };
            if let Some((_, change)) = &run.adjustment {
                change(&mut scene);
            }
            Ok(Arc::new(scene))
        })
        .clone()
    }

    /// Returns the scene of a run as the case defines it. If `wrong` is true and the negative control changes the scene,
    /// returns the changed scene.
    ///
    /// # Errors
    /// When the scene file is invalid, or third-party data are missing.
    pub fn given(&self, claim: &Claim, run: &Run, wrong: bool) -> Result<Arc<Scene>, RunError> {
        Ok(changed(&self.scene(run)?, wrong.then_some(&claim.control)))
    }

    /// Returns the external solver if there is one, otherwise the solver with this name.
    fn solver(&self, name: &str) -> Option<Arc<dyn Solver>> {
        self.options.external.clone().or_else(|| self.solvers.find(name))
    }

    /// Returns the name of the solver of a run, as it appears in results.
    fn solver_name(&self, run: &Run) -> String {
        self.options.external.as_ref().map_or_else(|| run.solver.to_owned(), |solver| solver.name())
    }

    /// Returns the error of a run whose scene or stored result cannot be read. If the data of our cases are not installed, the
    /// error says so.
    fn unreadable(&self, run: &Run, reason: String) -> RunError {
        match self.solvers.references().missing_data().filter(|_| self.case.home.made.is_some()) {
            Some(reason) => RunError::NotAvailable { solver: self.solver_name(run), reason },
            None => self.unusable(run, reason),
        }
    }

    fn unusable(&self, run: &Run, reason: String) -> RunError {
        RunError::Unsupported { solver: self.solver_name(run), reason }
    }

    /// Estimates the numerical uncertainty of a claim with one run from three resolution levels: its own level and two
    /// coarser ones. If there is no coarser level, two finer levels are used.
    ///
    /// # Errors
    /// When there is no estimate. The text states the reason.
    pub fn estimate(&self, claim: &Claim) -> Result<Estimate, String> {
        let [run] = &claim.runs[..] else { return Err("the claim reads more than one run".to_owned()) };
        let formal = if Method::from_name(run.solver) == Some(Method::Rigid) { 1.0 } else { 2.0 };
        let value = |factor: f64| -> Result<(String, f64), String> {
            let resolution = run.resolution.coarser(factor).ok_or("there is no coarser level")?;
            let done = self.run(&run.at(resolution)).map_err(|error| error.to_string())?;
            let found = (claim.measure)(&[done]).map_err(|missing| missing.to_string())?.error();
            if found.is_finite() {
                Ok((resolution.to_string(), found))
            } else {
                Err("a value is not finite".to_owned())
            }
        };
        let levels = |factors: [f64; 3]| -> Result<[(String, f64); 3], String> {
            let [a, b, c] = factors.map(value);
            Ok([a?, b?, c?])
        };
        let (found, at_coarsest) = match levels([1.0, 2.0, 4.0]) {
            Ok(found) => (found, false),
            Err(_) => (levels([0.25, 0.5, 1.0])?, true),
        };
        let values = [found[0].1, found[1].1, found[2].1];
        let (order, safety, mut uncertainty) = of_finest(values, formal);
        if at_coarsest {
            // Uncertainty of the coarsest level: the distance from the finest value plus the uncertainty of the finest value.
            uncertainty += (values[2] - values[0]).abs();
        }
        let [a, b, c] = found.map(|(level, _)| level);
        Ok(Estimate {
            variant: run.scene_words(),
            solver: run.solver.to_owned(),
            resolution: run.resolution.to_string(),
            quantity: claim.quantity.clone(),
            levels: [a, b, c],
            values,
            order,
            safety,
            uncertainty,
        })
    }

    /// Returns the tolerance of a claim for these runs, and the origin of the tolerance. A stored estimate replaces the
    /// stated tolerance if it is smaller. Returns none if an estimate is required but not stored.
    #[must_use]
    pub fn allowed(&self, claim: &Claim, done: &[FinishedRun]) -> Option<(f64, tolerance::ToleranceOrigin)> {
        let stated = (claim.tolerance.allowed(done), claim.tolerance.made_without_estimate());
        if claim.tolerance.made != tolerance::ToleranceOrigin::Estimated || self.options.external.is_some() {
            return Some(stated);
        }
        // If the estimate is not below the stated limit, the limit applies as engineering judgement.
        let found = self.solvers.references().uncertainty(self.case, claim)?;
        Some(if found < claim.tolerance.up_to { (found, tolerance::ToleranceOrigin::Estimated) } else { stated })
    }

    /// Returns the result of a claim whose evaluation panicked. Its outcome is `broken`.
    pub fn crashed(&self, claim: &Claim, reason: String) -> Verdict {
        let tolerance = &claim.tolerance;
        self.row(claim, Some((tolerance.allowed(&[]), tolerance.made))).left(Outcome::Broken, reason)
    }

    /// Returns the result of a claim before it is judged. `allowed` is the tolerance with its origin.
    fn row(&self, claim: &Claim, allowed: Option<(f64, tolerance::ToleranceOrigin)>) -> Verdict {
        let first = claim.runs.first();
        Verdict {
            variant: first.map_or_else(String::new, |run| run.variant.to_owned()),
            solver: first.map_or_else(String::new, |run| self.solver_name(run)),
            resolution: claim.resolution(),
            allowed: allowed.map_or(0.0, |(most, _)| most),
            tolerance: allowed.map_or(claim.tolerance.made, |(_, made)| made),
            because: claim.tolerance.because.clone(),
            evidence: claim.evidence(),
            source: claim.source.words(),
            ..Verdict::open(self.case.name, claim.quantity.clone(), claim.unit)
        }
    }

    /// Judges a claim from its runs.
    fn conclude(&self, claim: &Claim, done: Result<Vec<FinishedRun>, RunError>) -> Verdict {
        let allowed = self.allowed(claim, done.as_deref().unwrap_or_default());
        let row = self.row(claim, allowed);
        match done {
            Err(error) => row.ended(&error),
            Ok(_) if allowed.is_none() => {
                row.left(Outcome::NoReference, "no estimate of its numerical uncertainty is stored")
            }
            Ok(done) => {
                let row = self.with_programs(row, &done);
                match (claim.measure)(&done) {
                    // An external solver may report fewer quantities than our solvers.
                    Err(missing) if self.options.external.is_some() => {
                        row.left(Outcome::Unsupported, missing.to_string())
                    }
                    Err(missing) => row.left(Outcome::Fail, missing.to_string()),
                    Ok(found) => {
                        let row = known(row.judged(&found), claim, &found).unless_as_wide_as_the_scale();
                        self.unless_outdated(row, &done)
                    }
                }
            }
        }
    }

    /// Returns the result, with the outcome `outdated` if it passed with a stored result of other solver sources.
    fn unless_outdated(&self, row: Verdict, done: &[FinishedRun]) -> Verdict {
        let is_outdated = |done: &FinishedRun| done.kept.as_ref().is_some_and(|made| !made.is_current);
        if row.outcome == Outcome::Pass && done.iter().any(is_outdated) {
            let case = self.case.name;
            let hint = format!("`grainbench reference keep {case} --no-cache` repeats it");
            let reason = format!("the stored run was made with other solver sources; {hint}");
            return row.left(Outcome::Outdated, reason);
        }
        row
    }

    /// Adds the options of external programs, and the provenance of stored results, to the source of a result.
    fn with_programs(&self, mut row: Verdict, done: &[FinishedRun]) -> Verdict {
        for run in done.iter().map(|done| &done.record.provenance).filter(|run| self.solvers.is_program(&run.solver)) {
            row.source.push_str(&format!(": {}", run.options.join(", ")));
        }
        let mut kept: Vec<&ResultOrigin> = done.iter().filter_map(|done| done.kept.as_ref()).collect();
        kept.dedup();
        for ResultOrigin { words, .. } in kept {
            row.source.push_str(&format!("; stored result of {words}"));
        }
        row
    }
}

/// Calls a function and returns its value. If it panics, returns an error with the message of the panic.
fn unless_panicked<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|reason| {
        let words = reason.downcast_ref::<String>().map(String::as_str);
        let words = words.or_else(|| reason.downcast_ref::<&str>().copied());
        format!("our program failed: {}", words.unwrap_or("without a message"))
    })
}

/// Returns the scene as a negative control changes it, or the same scene.
fn changed(scene: &Arc<Scene>, control: Option<&control::Control>) -> Arc<Scene> {
    let Some(WrongPhysics::Scene(change) | WrongPhysics::Ours(change)) = control.map(|control| &control.wrong) else {
        return Arc::clone(scene);
    };
    let mut given = (**scene).clone();
    change(&mut given);
    Arc::new(given)
}

/// Returns the result, with the outcome `known` if its error is documented, finite and at most the limit of the known error.
fn known(row: Verdict, claim: &Claim, found: &Measurement) -> Verdict {
    let ExpectedOutcome::Known(reason) = claim.standing() else { return row };
    let most = claim.runs.first().map_or(f64::INFINITY, |run| run.known_up_to);
    match row.outcome {
        Outcome::Fail if found.error().abs() <= most && found.error().is_finite() => row.left(Outcome::Known, reason),
        Outcome::Fail if found.error().is_finite() => {
            row.left(Outcome::Fail, format!("larger than the bound of the known error, {most} of the scale: {reason}"))
        }
        _ => row,
    }
}
