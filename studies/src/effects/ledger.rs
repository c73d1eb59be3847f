//! The ledger of a case.

use super::idle::{Idle, ratio_of_times, try_idly};
use crate::identity;
use crate::result_cache::ResultCache;
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::run::{Done, Run, Set, Standing};
use grainbench_harness::runner::Runner;
use grainbench_harness::solvers::Solvers;
use grainbench_reports::WriteError;
use grainbench_reports::study::effects::{Entry, Shift, Worth};
use grainbench_scene::effect::Effect;
use grainbench_scene::record::Record;
use grainbench_scene::scene::Duration::Seconds;
use grainbench_scene::solver::{Method, RunError};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// How long an absent effect is tried, beyond the fewest runs.
const PATIENCE: Duration = Duration::from_millis(300);

/// Steps of a method with a grid that an absent effect is tried in.
const STEPS_OF_A_GRID: u64 = 200;

/// One scene of a case with one effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Variant of the scene.
    pub variant: &'static str,
    /// The effect.
    pub effect: Effect,
    /// The key that turned it on; none where it is off.
    pub key: Option<String>,
}

/// A case at work: runs with an effect switched off are done once, whoever asks.
pub struct Ledger {
    case: &'static Case,
    solvers: Arc<dyn Solvers>,
    runner: Runner,
    claims: Vec<Claim>,
    /// By effect and run.
    without: BTreeMap<(Effect, String), Result<Done, RunError>>,
}

impl Ledger {
    /// The ledger of a case: of its claims that pass, of which all runs can be had here.
    #[must_use]
    pub fn new(case: &'static Case, solvers: Arc<dyn Solvers>) -> Self {
        let runner = Runner::new(case, Arc::clone(&solvers));
        let mut claims = (case.claims)();
        claims.retain(|claim| {
            let is_short = |run: &Run| run.set < Set::Long && run.reading.is_none();
            claim.standing() == Standing::Passes && claim.runs.iter().all(is_short) && runner.is_available(claim)
        });
        Self { case, solvers, runner, claims, without: BTreeMap::new() }
    }

    /// Every variant that claims look at with every effect, on or off.
    #[must_use]
    pub fn pieces(&self) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        for run in self.claims.iter().flat_map(|claim| &claim.runs) {
            let Ok(scene) = self.runner.scene(run) else { continue };
            for effect in Effect::switches() {
                let key = effect.key(&scene).filter(|_| knows(run, effect));
                match pieces.iter_mut().find(|piece| piece.variant == run.variant && piece.effect == effect) {
                    // A change that belongs to a claim may turn on what the scene as it stands does not call for.
                    Some(piece) => piece.key = piece.key.take().or(key),
                    None => pieces.push(Piece { variant: run.variant, effect, key }),
                }
            }
        }
        pieces
    }

    /// The entry of a piece, from the result cache where it stands there, and whether it did; nothing of an absent effect that
    /// has no value that does nothing.
    ///
    /// # Errors
    /// When it cannot be kept.
    pub fn entry(
        &mut self,
        program: &str,
        piece: &Piece,
        cache: &ResultCache,
    ) -> Result<(Option<Entry>, bool), WriteError> {
        let name = identity::of_words(program, &["effect", self.case.name, piece.variant, piece.effect.word()]);
        if let Some(entry) = cache.take(&name) {
            return Ok((entry, true));
        }
        let entry = if piece.key.is_some() { Some(self.switched_off(piece)) } else { self.idle(piece) };
        cache.put(&name, &entry)?;
        Ok((entry, false))
    }

    /// Whether some claim of the case turns red by its value when the effect is switched off: the first that does. Where none
    /// does, one that has no value without it, as the pressure under what nothing presses has none.
    #[must_use]
    pub fn catches(&mut self, effect: Effect) -> Option<String> {
        let mut claims = self.claims.clone();
        claims.retain(|claim| self.calls_for(claim, effect));
        // One that is caught by what the main job runs need not wait for more.
        claims.sort_by_key(Claim::set);
        let words = |claim: &Claim| format!("{} · {}", claim.runs[0].solver, claim.quantity);
        let mut nothing = None;
        for claim in &claims {
            match self.error_without(claim, effect) {
                None => nothing = nothing.or_else(|| Some(format!("{}: no value without it", words(claim)))),
                Some((error, allowed)) if error.abs() > allowed => return Some(words(claim)),
                _ => {}
            }
        }
        nothing
    }

    fn calls_for(&self, claim: &Claim, effect: Effect) -> bool {
        claim
            .runs
            .iter()
            .any(|run| knows(run, effect) && self.runner.scene(run).is_ok_and(|scene| effect.is_on(&scene)))
    }

    fn blank(&self, piece: &Piece) -> Entry {
        Entry {
            case: self.case.name.to_owned(),
            variant: piece.variant.to_owned(),
            effect: piece.effect.word().to_owned(),
            on: piece.key.is_some(),
            key: piece.key.clone().unwrap_or_default(),
            worth: Worth::Untold,
            shifts: Vec::new(),
            counts: None,
            time: None,
            tried: Vec::new(),
        }
    }

    /// Asks every claim of the variant without the effect.
    fn switched_off(&mut self, piece: &Piece) -> Entry {
        let mut entry = self.blank(piece);
        let claims: Vec<Claim> = self
            .claims
            .iter()
            .filter(|claim| claim.runs[0].variant == piece.variant && self.calls_for(claim, piece.effect))
            .cloned()
            .collect();
        for claim in &claims {
            entry.shifts.push(self.shift(claim, piece.effect));
        }
        let red = entry.shifts.iter().any(|shift| shift.red);
        entry.worth = match (red, entry.shifts.is_empty()) {
            (true, _) => Worth::Needed,
            (false, false) => Worth::NotWorthSimulating,
            (false, true) => Worth::Untold,
        };
        if let Some(run) = claims.iter().flat_map(|claim| &claim.runs).find(|run| self.is_judged(run)) {
            let with = self.runner.run(run);
            if let (Ok(with), Ok(without)) = (with, self.run_without(run, piece.effect)) {
                let work = |record: &Record| record.cost.work() as f64;
                entry.counts = Some(work(&with.record) / work(&without.record).max(1.0));
                entry.time = ratio_of_times(&with.record, &without.record);
            }
        }
        entry
    }

    /// A claim with and without an effect.
    fn shift(&mut self, claim: &Claim, effect: Effect) -> Shift {
        let without = self.error_without(claim, effect);
        let row = self.runner.judge(claim);
        // What cannot be run or measured any more shows nothing, as in any control.
        let red = without.is_some_and(|(error, allowed)| error.abs() > allowed);
        Shift {
            quantity: claim.quantity.clone(),
            solver: claim.runs[0].solver.to_owned(),
            with: row.error,
            without: without.map(|(error, _)| error),
            allowed: row.allowed,
            red,
        }
    }

    /// The error of a claim without an effect and how large it may be; none when it cannot be run or measured any more.
    fn error_without(&mut self, claim: &Claim, effect: Effect) -> Option<(f64, f64)> {
        let done: Result<Vec<Done>, RunError> = claim.runs.iter().map(|run| self.run_without(run, effect)).collect();
        let done = done.ok()?;
        let error = (claim.measure)(&done).ok().map(|measured| measured.error()).filter(|error| error.is_finite())?;
        Some((error, self.runner.allowed(claim, &done)?.0))
    }

    /// A run of a claim whose solver is given the scene without the effect; the scene of the claim stays what it was,
    /// and so do the runs that others are judged by.
    fn run_without(&mut self, run: &Run, effect: Effect) -> Result<Done, RunError> {
        if !self.is_judged(run) {
            return self.runner.run(run);
        }
        let key = (effect, run.key());
        if let Some(done) = self.without.get(&key) {
            return done.clone();
        }
        let done = self.simulate_without(run, effect);
        self.without.insert(key, done.clone());
        done
    }

    fn simulate_without(&self, run: &Run, effect: Effect) -> Result<Done, RunError> {
        let scene = self.runner.scene(run)?;
        let mut given = (*scene).clone();
        effect.switch_off(&mut given);
        let unknown =
            || RunError::Unsupported { solver: run.solver.to_owned(), reason: "there is no such solver".to_owned() };
        let solver = self.solvers.find(run.solver).ok_or_else(unknown)?;
        let record = solver.run(&given, &run.resolution, &mut ())?;
        Ok(Done::new(scene, Arc::new(record)))
    }

    /// Whether a run is one of ours that is judged, and not one that others are judged by.
    fn is_judged(&self, run: &Run) -> bool {
        !run.aside && !self.solvers.is_program(run.solver)
    }

    /// The first run of the variant by each kind of solver that leaves the effect out, with the effect compiled in. It
    /// is inert where it is for all of them; counts and times are those of the first.
    fn idle(&self, piece: &Piece) -> Option<Entry> {
        let mut entry = Entry { worth: Worth::Inert, ..self.blank(piece) };
        for &method in piece.effect.left_out_by() {
            let Some((solver, idle)) = self.idle_with(piece, method) else { continue };
            if !idle.same {
                entry.worth = Worth::NotInert;
            }
            entry.counts.get_or_insert(idle.counts);
            entry.time = entry.time.or(idle.time);
            entry.tried.push(solver.to_owned());
        }
        (!entry.tried.is_empty()).then_some(entry)
    }

    fn idle_with(&self, piece: &Piece, method: Method) -> Option<(&'static str, Idle)> {
        let is_ours =
            |run: &&Run| self.is_judged(run) && run.variant == piece.variant && Method::of(run.solver) == Some(method);
        let run = self.claims.iter().flat_map(|claim| &claim.runs).find(is_ours)?;
        let mut scene = (*self.runner.scene(run).ok()?).clone();
        if method == Method::Grid {
            // A grid says its step only when it runs.
            let ran = self.runner.run(run).ok()?.record;
            scene.duration = Seconds(ran.provenance.time_step * ran.cost.steps.min(STEPS_OF_A_GRID) as f64);
        }
        let solver = self.solvers.find(run.solver)?;
        let idle = try_idly(&*solver, &scene, &run.resolution, piece.effect, PATIENCE).ok()??;
        Some((run.solver, idle))
    }
}

/// Whether the solver of a run knows an effect.
fn knows(run: &Run, effect: Effect) -> bool {
    Method::of(run.solver).is_none_or(|method| effect.concerns(method))
}
