//! Effects study of a case: the influence of each physical effect on its claims.

use super::idle::{NeutralTrial, try_idly};
use super::{conclude, untested};
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::control::Control;
use grainbench_harness::run::{ExpectedOutcome, FinishedRun, Run, Set};
use grainbench_harness::runner::Runner;
use grainbench_harness::solvers::Solvers;
use grainbench_reports::study::effects::{EffectResult, Entry, Shift};
use grainbench_scene::effect::Effect;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Duration::Seconds;
use grainbench_solver::failure::RunError;
use std::sync::Arc;

/// Maximum number of steps of a grid method when an absent effect is tested.
const STEPS_OF_A_GRID: u64 = 200;

/// Effect in one scene of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneEffect {
    /// Name of the variant of the case that defines the scene.
    pub variant: &'static str,
    /// Physical effect, which is on or off in the scene.
    pub effect: Effect,
    /// Scene key that turns the effect on; `None` if the effect is off.
    pub key: Option<String>,
}

/// Effects study of a case. All claims share the runs without an effect.
pub struct Ledger {
    /// Case whose claims are evaluated.
    pub case: &'static Case,
    solvers: Arc<dyn Solvers>,
    runner: Runner,
    claims: Vec<Claim>,
}

impl Ledger {
    /// Returns the study of a case. It uses claims that are expected to pass, if all their runs are short and
    /// available.
    #[must_use]
    pub fn new(case: &'static Case, solvers: Arc<dyn Solvers>) -> Self {
        let runner = Runner::new(case, Arc::clone(&solvers));
        let mut claims = (case.claims)();
        claims.retain(|claim| {
            let is_short = |run: &Run| run.set < Set::Long && run.reading.is_none();
            claim.standing() == ExpectedOutcome::Passes && claim.runs.iter().all(is_short) && runner.is_available(claim)
        });
        Self { case, solvers, runner, claims }
    }

    /// Returns each pair of an effect and a variant that the claims use. The effect may be on or off.
    #[must_use]
    pub fn pieces(&self) -> Vec<SceneEffect> {
        let mut pieces: Vec<SceneEffect> = Vec::new();
        for run in self.claims.iter().flat_map(|claim| &claim.runs) {
            let Ok(scene) = self.runner.scene(run) else { continue };
            for effect in Effect::switches() {
                let key = effect.key(&scene).filter(|_| knows(run, effect));
                match pieces.iter_mut().find(|piece| piece.variant == run.variant && piece.effect == effect) {
                    // A claim may change its scene and thereby turn on an effect that is off in the case's scene.
                    Some(piece) => piece.key = piece.key.take().or(key),
                    None => pieces.push(SceneEffect { variant: run.variant, effect, key }),
                }
            }
        }
        pieces
    }

    /// Returns the entry of an effect, or `None` for an absent effect without a neutral value.
    #[must_use]
    pub fn entry(&self, piece: &SceneEffect) -> Option<Entry> {
        if piece.key.is_some() { Some(self.switched_off(piece)) } else { self.idle(piece) }
    }

    /// Returns, in words, the first claim whose error exceeds its limit if the effect is switched off.
    ///
    /// If there is none, returns a claim that has no value without the effect, such as the pressure under an unloaded
    /// wall.
    #[must_use]
    pub fn catches(&self, effect: Effect) -> Option<String> {
        let mut claims = self.claims.clone();
        claims.retain(|claim| self.calls_for(claim, effect));
        // Claims of the quick tiers come first, so that slow claims run only if needed.
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

    fn untested(&self, piece: &SceneEffect) -> Entry {
        untested(self.case.name, piece.variant, piece.effect, piece.key.clone())
    }

    /// Evaluates each claim of the variant without the effect.
    fn switched_off(&self, piece: &SceneEffect) -> Entry {
        let mut entry = self.untested(piece);
        let mut claims = self.claims.clone();
        claims.retain(|claim| claim.runs[0].variant == piece.variant && self.calls_for(claim, piece.effect));
        entry.shifts = claims.iter().map(|claim| self.shift(claim, piece.effect)).collect();
        let mut runs = claims.iter().flat_map(|claim| claim.runs.iter().map(move |run| (claim, run)));
        let runs = runs.find(|(_, run)| self.is_tested(run)).and_then(|(claim, run)| {
            let without = self.runner.run_wrong(&without(claim, piece.effect), run);
            Some([self.runner.run(run).ok()?.record, without.ok()?.record])
        });
        conclude(&mut entry, runs.as_ref().map(|runs| runs.each_ref().map(|record| &**record)));
        entry
    }

    /// Evaluates a claim with and without an effect.
    fn shift(&self, claim: &Claim, effect: Effect) -> Shift {
        let without = self.error_without(claim, effect);
        let row = self.runner.judge(claim);
        // A claim that cannot be run or measured without the effect does not count, as in negative controls.
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

    /// Returns the error of a claim without an effect and the limit of the error. Returns `None` if the claim cannot be
    /// run or measured.
    fn error_without(&self, claim: &Claim, effect: Effect) -> Option<(f64, f64)> {
        let wrong = without(claim, effect);
        let done: Result<Vec<FinishedRun>, RunError> =
            claim.runs.iter().map(|run| self.runner.run_wrong(&wrong, run)).collect();
        let done = done.ok()?;
        let error = (claim.measure)(&done).ok().map(|measured| measured.error()).filter(|error| error.is_finite())?;
        Some((error, self.runner.allowed(claim, &done)?.0))
    }

    /// Returns true for a run of our solver that is not a reference run.
    fn is_tested(&self, run: &Run) -> bool {
        !run.aside && !self.solvers.is_program(run.solver)
    }

    /// Tests an effect that is off. For each kind of solver that can omit the effect, uses the first run of the
    /// variant.
    ///
    /// The effect is inert if it changes no solver's result. Counts are from the first solver, and times from the first
    /// solver with runs that are long enough to time.
    fn idle(&self, piece: &SceneEffect) -> Option<Entry> {
        let mut entry = Entry { worth: EffectResult::Inert, ..self.untested(piece) };
        for &method in piece.effect.left_out_by() {
            let Some((solver, idle)) = self.idle_with(piece, method) else { continue };
            if !idle.same {
                entry.worth = EffectResult::NotInert;
            }
            entry.counts.get_or_insert(idle.counts);
            entry.time = entry.time.or(idle.time);
            entry.tried.push(solver.to_owned());
        }
        (!entry.tried.is_empty()).then_some(entry)
    }

    fn idle_with(&self, piece: &SceneEffect, method: Method) -> Option<(&'static str, NeutralTrial)> {
        let is_ours = |run: &&Run| {
            self.is_tested(run) && run.variant == piece.variant && Method::from_name(run.solver) == Some(method)
        };
        let run = self.claims.iter().flat_map(|claim| &claim.runs).find(is_ours)?;
        let mut scene = (*self.runner.scene(run).ok()?).clone();
        if method == Method::Grid {
            // The time step of a grid method is known only from a run.
            let ran = self.runner.run(run).ok()?.record;
            scene.duration = Seconds(ran.provenance.time_step * ran.cost.steps.min(STEPS_OF_A_GRID) as f64);
        }
        let solver = self.solvers.find(run.solver)?;
        let idle = try_idly(&*solver, &scene, &run.resolution, piece.effect).ok()??;
        Some((run.solver, idle))
    }
}

/// Returns a claim whose control switches off an effect. Reference runs and runs of other programs keep the effect. The
/// expected value is still computed from the scene with the effect.
fn without(claim: &Claim, effect: Effect) -> Claim {
    let control = Control::ours(effect.absence(), move |scene| effect.switch_off(scene));
    Claim { control, ..claim.clone() }
}

/// Returns true if the solver of a run supports an effect.
fn knows(run: &Run, effect: Effect) -> bool {
    Method::from_name(run.solver).is_none_or(|method| effect.concerns(method))
}
