//! Known mistakes of solvers, and the search for a mistake that explains failed results.
//!
//! A mistake explains a failed result if our own solvers give the same error with the mistake, and pass without it. The
//! candidates are wrong scenes, such as another gravity or inertia, the negative control of the claim, and wrong
//! methods in [`small_dem`].

pub mod small_dem;

use crate::case::Case;
use crate::claim::Claim;
use crate::control::{Control, WrongPhysics};
use crate::evidence::Evidence;
use crate::run::{Run, Set};
use crate::runner::{Runner, RunnerOptions};
use crate::solvers::Solvers;
use crate::verdict::{Outcome, Verdict};
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::dimension::GrainShape;
use grainbench_scene::effect::Effect;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::resolution::Resolution;
use small_dem::{MethodMistake, SmallDem};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::thread;

/// Largest difference of two errors with the same cause, as a fraction of the error that was found.
const SAME: f64 = 0.05;
/// Largest relative difference between the errors with and without a mistake that has no effect.
const UNCHANGED: f64 = 1e-6;
/// Largest number of mistakes that a hint names.
const MOST_NAMED: usize = 2;
/// Largest number of steps times grains for a run with a wrong scene.
const SCENE_WORK: f64 = 2e7;
/// Largest number of steps times pairs for a run with a wrong method.
const METHOD_WORK: f64 = 5e6;
/// Time step of the small solver, as a fraction of the critical time step, if the claim's method has no contact springs.
const FRACTION: f64 = 0.05;

/// A mistake whose effect on a result can be computed.
#[derive(Clone)]
enum Mistake {
    /// A wrong scene.
    Scene(Control),
    /// The negative control with this name, in all claims that have it.
    Control(&'static str),
    /// A wrong method with this description.
    Method(MethodMistake, &'static str),
}

impl Mistake {
    const fn words(&self) -> &'static str {
        match self {
            Self::Scene(control) => control.name,
            Self::Control(name) | Self::Method(_, name) => name,
        }
    }
}

/// A claim of a case and its result.
struct ClaimResult<'a> {
    claim: &'a Claim,
    row: &'a Verdict,
}

/// Errors of all results with one mistake; none for a result whose error cannot be computed.
struct Candidate {
    words: &'static str,
    errors: Vec<Option<f64>>,
}

/// Appends "as if: …" to the details of failed results whose errors a known mistake reproduces.
///
/// `rows` are the results of `claims`, in the same order. All results of scenes with a failed result are examined. A
/// mistake is not named if it contradicts at least as many of them as it explains.
pub fn explain(case: &'static Case, solvers: &Arc<dyn Solvers>, claims: &[&Claim], rows: &mut [Verdict]) {
    let hints = hints(case, solvers, claims, rows);
    for (row, hint) in rows.iter_mut().zip(hints) {
        if let Some(hint) = hint {
            let detail = row.detail.take().map_or_else(String::new, |detail| format!("{detail}; "));
            row.detail = Some(format!("{detail}as if: {hint}"));
        }
    }
}

fn hints(case: &'static Case, solvers: &Arc<dyn Solvers>, claims: &[&Claim], rows: &[Verdict]) -> Vec<Option<String>> {
    let failed = |row: &Verdict| row.outcome == Outcome::Fail && row.error.is_some();
    let scenes = |claim: &Claim| claim.runs.iter().map(Run::scene_words).collect::<BTreeSet<String>>();
    let judged = || claims.iter().zip(rows).map(|(claim, row)| ClaimResult { claim, row });
    let in_question: BTreeSet<String> =
        judged().filter(|judged| failed(judged.row)).flat_map(|judged| scenes(judged.claim)).collect();
    if in_question.is_empty() {
        return vec![None; rows.len()];
    }
    let is_asked = |judged: &ClaimResult<'_>| {
        matches!(judged.row.outcome, Outcome::Fail | Outcome::Pass)
            && judged.row.error.is_some()
            && scenes(judged.claim).is_subset(&in_question)
    };
    let judged: Vec<ClaimResult<'_>> = judged().filter(is_asked).collect();
    let found = candidates(case, solvers, &judged);
    let scores: Vec<i64> = found.iter().map(|candidate| score(candidate, &judged)).collect();
    let hint_of = |row: &Verdict| {
        let place = judged.iter().position(|judged| std::ptr::eq(judged.row, row))?;
        let matches = |candidate: &Candidate| failed(row) && explains(candidate.errors[place], row);
        let mut best: Vec<(i64, f64, &'static str)> = found
            .iter()
            .zip(&scores)
            .filter(|(candidate, score)| **score > 0 && matches(candidate))
            .map(|(candidate, score)| (-score, distance(candidate.errors[place], row), candidate.words))
            .collect();
        best.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let top = best.first()?.0;
        let named: Vec<&str> = best.iter().filter(|(score, ..)| *score == top).map(|(.., words)| *words).collect();
        Some(named[..named.len().min(MOST_NAMED)].join(", or "))
    };
    rows.iter().map(hint_of).collect()
}

fn distance(error: Option<f64>, row: &Verdict) -> f64 {
    error.zip(row.error).map_or(f64::INFINITY, |(error, found)| (error - found).abs())
}

/// Returns true if a mistake explains a failed result. The error with the mistake must exceed the allowed error and be
/// close to the found error. The largest difference is the larger of two values: the fraction [`SAME`] of the found
/// error, and the allowed error, limited to half of the found error.
fn explains(error: Option<f64>, row: &Verdict) -> bool {
    let found = row.error.unwrap_or(f64::NAN).abs();
    error.is_some_and(|error| error.abs() > row.allowed)
        && distance(error, row) <= (SAME * found).max(row.allowed.min(0.5 * found))
}

/// Returns the number of failed results that a mistake explains, minus the number of results that contradict it.
fn score(candidate: &Candidate, judged: &[ClaimResult<'_>]) -> i64 {
    let agreement = |(error, judged): (&Option<f64>, &ClaimResult<'_>)| match (error, judged.row.outcome) {
        (None, _) => 0,
        (Some(_), Outcome::Fail) if explains(*error, judged.row) => 1,
        (Some(error), Outcome::Pass) if error.abs() <= 2.0 * judged.row.allowed => 0,
        _ => -1,
    };
    candidate.errors.iter().zip(judged).map(agreement).sum()
}

/// Computes the errors of all results with each mistake, on all processors.
fn candidates(case: &'static Case, solvers: &Arc<dyn Solvers>, judged: &[ClaimResult<'_>]) -> Vec<Candidate> {
    let plain = Runner::new(case, Arc::clone(solvers));
    let right = small(case, solvers, None);
    let can: Vec<[bool; 2]> = judged.iter().map(|judged| limits(&plain, judged.claim)).collect();
    // Errors without a mistake. A mistake that changes no error explains nothing. A solver that fails without the
    // mistake cannot show the effect of the mistake.
    let is_tried = |judged: &ClaimResult<'_>, can: &[bool; 2]| {
        can[0] || judged.row.outcome == Outcome::Fail && is_own(judged.claim)
    };
    let by_scene: Vec<Option<f64>> = judged
        .iter()
        .zip(&can)
        .map(|(judged, can)| is_tried(judged, can).then(|| plain.judge(judged.claim).error)?)
        .collect();
    let by_method: Vec<Option<f64>> =
        judged.iter().zip(&can).map(|(judged, can)| can[1].then(|| method_error(&right, judged))?).collect();
    let is_right =
        |error: Option<f64>, place: usize| error.is_some_and(|error| error.abs() <= judged[place].row.allowed);
    let passes = |place: usize| is_right(by_scene[place], place) || !is_tried(&judged[place], &can[place]);
    let changed = |error: Option<f64>, without: Option<f64>| {
        error.filter(|error| without.is_none_or(|without| (error - without).abs() > UNCHANGED * without.abs()))
    };
    let errors = |mistake: &Mistake| -> Vec<Option<f64>> {
        let runner = match mistake {
            Mistake::Method(slip, _) => small(case, solvers, Some(*slip)),
            Mistake::Scene(_) | Mistake::Control(_) => Runner::new(case, Arc::clone(solvers)),
        };
        let candidate_error = |(place, judged): (usize, &ClaimResult<'_>)| match mistake {
            Mistake::Method(..) if is_right(by_method[place], place) => {
                changed(method_error(&runner, judged), by_method[place])
            }
            Mistake::Scene(control) if can[place][0] && passes(place) => {
                changed(scene_error(&runner, judged.claim, control.clone()), by_scene[place])
            }
            Mistake::Control(name) if judged.claim.control.name == *name && is_own(judged.claim) && passes(place) => {
                scene_error(&runner, judged.claim, Control { resolution: None, ..judged.claim.control.clone() })
            }
            _ => None,
        };
        judged.iter().enumerate().map(candidate_error).collect()
    };
    let mistakes = mistakes(&plain, judged);
    let count = thread::available_parallelism().map_or(1, usize::from);
    let of_thread = |thread: usize| -> Vec<(usize, Candidate)> {
        let own = mistakes.iter().enumerate().skip(thread).step_by(count);
        own.map(|(place, mistake)| (place, Candidate { words: mistake.words(), errors: errors(mistake) })).collect()
    };
    let mut found: Vec<(usize, Candidate)> = thread::scope(|scope| {
        let threads: Vec<_> = (0..count).map(|thread| scope.spawn(move || of_thread(thread))).collect();
        threads.into_iter().filter_map(|thread| thread.join().ok()).flatten().collect()
    });
    found.sort_by_key(|(place, _)| *place);
    found.into_iter().map(|(_, candidate)| candidate).collect()
}

/// Returns a runner of the small solver, with or without a mistake.
fn small(case: &'static Case, solvers: &Arc<dyn Solvers>, mistake: Option<MethodMistake>) -> Runner {
    let external: Arc<dyn Solver> = Arc::new(SmallDem { mistake });
    let options = RunnerOptions { external: Some(external), controlled: false, ..RunnerOptions::default() };
    Runner::new(case, Arc::clone(solvers)).with(options)
}

/// Returns the error of a claim with a runner of the small solver.
fn method_error(runner: &Runner, judged: &ClaimResult<'_>) -> Option<f64> {
    let runs = judged.claim.runs.iter().map(with_step).collect();
    runner.judge(&Claim { runs, ..judged.claim.clone() }).error
}

/// Returns the run at its own resolution if that is a time step, otherwise at [`FRACTION`] of the critical time step.
fn with_step(run: &Run) -> Run {
    match run.resolution {
        Resolution::CriticalFraction(_) | Resolution::TimeStep(_) => run.clone(),
        Resolution::Rigid { .. } | Resolution::Grid { .. } => run.at(Resolution::CriticalFraction(FRACTION)),
    }
}

/// Returns the error of a claim with a wrong scene.
fn scene_error(runner: &Runner, claim: &Claim, control: Control) -> Option<f64> {
    runner.control(&Claim { control, ..claim.clone() }).error
}

/// Returns true if a claim uses only quick runs of our own solvers and compares with no other program or earlier value.
fn is_own(claim: &Claim) -> bool {
    let is_computed = !matches!(claim.evidence(), Evidence::OtherCode | Evidence::Regression);
    let is_short = |run: &Run| {
        Method::from_name(run.solver).is_some() && run.set == Set::Main && !run.kept && !run.aside && run.data.is_none()
    };
    is_computed && claim.control.set == Set::Main && claim.runs.iter().all(is_short)
}

/// Returns two flags: true if the runs of a claim are short enough to repeat them with a wrong scene (first flag) or with
/// a wrong method (second flag).
fn limits(runner: &Runner, claim: &Claim) -> [bool; 2] {
    let of_grains = |run: &Run| matches!(Method::from_name(run.solver), Some(Method::Dem | Method::Rigid));
    if !is_own(claim) || !claim.runs.iter().all(of_grains) {
        return [false; 2];
    }
    let work = |run: &Run| -> Option<[f64; 2]> {
        let scene = runner.scene(run).ok()?;
        let (_, steps) = with_step(run).resolution.steps(&scene).ok()?;
        let grains = scene.grains.len() as f64;
        let sides = 0.5 * (grains + 1.0) + scene.walls.len() as f64;
        Some([grains, grains * sides].map(|count| count * steps as f64))
    };
    let sum = claim
        .runs
        .iter()
        .map(work)
        .try_fold([0.0; 2], |sum, sums| sums.map(|sums| [sum[0] + sums[0], sum[1] + sums[1]]));
    sum.map_or([false; 2], |[scene, method]| [scene <= SCENE_WORK, method <= METHOD_WORK])
}

/// Returns the mistakes that can affect these results.
fn mistakes(runner: &Runner, judged: &[ClaimResult<'_>]) -> Vec<Mistake> {
    let mut known = BTreeSet::new();
    let mut found: Vec<Mistake> = Vec::new();
    let mut add = |mistake: Mistake| {
        if known.insert(mistake.words()) {
            found.push(mistake);
        }
    };
    for claim in judged.iter().map(|judged| judged.claim) {
        let scenes = claim.runs.iter().filter_map(|run| runner.scene(run).ok());
        scenes.flat_map(|scene| of_scene(&scene)).for_each(|control| add(Mistake::Scene(control)));
        if matches!(claim.control.wrong, WrongPhysics::Scene(_)) {
            add(Mistake::Control(claim.control.name));
        }
    }
    MethodMistake::ALL.into_iter().for_each(|(slip, words)| add(Mistake::Method(slip, words)));
    found
}

/// Returns common mistakes in a scene.
fn of_scene(scene: &Scene) -> Vec<Control> {
    let off = Effect::switches().filter(|effect| effect.is_on(scene)).map(Control::without);
    let laws = scene.laws.iter().flatten();
    let wrong_laws = LAWS.iter().filter(|(is_affected, ..)| laws.clone().any(is_affected));
    let wrong_laws = wrong_laws.map(|&(_, name, change)| Control::contact_law(name, change));
    off.chain(of_gravity(scene)).chain(of_inertia(scene.grain_shape)).chain(wrong_laws).collect()
}

fn of_gravity(scene: &Scene) -> Vec<Control> {
    let size = scene.gravity.norm();
    if size == 0.0 {
        return Vec::new();
    }
    let rounded = [
        ("gravity of 9.8 m/s²", 9.8),
        ("gravity of 9.80665 m/s²", 9.80665),
        ("gravity of 9.81 m/s²", 9.81),
        ("gravity of 10 m/s²", 10.0),
    ];
    let is_near = |to: f64| (size - 9.8).abs() < 0.3 && (size - to).abs() > 1e-9 * size;
    let near = rounded.into_iter().filter(|&(_, to)| is_near(to));
    let near = near.map(|(name, to)| Control::scene(name, move |scene| scene.gravity *= to / size));
    let is_oblique = scene.gravity.x != 0.0 && scene.gravity.y != 0.0;
    let exchanged = is_oblique.then(|| {
        Control::scene("sine and cosine of the slope exchanged", |scene| {
            let [x, y] = [scene.gravity.x, scene.gravity.y];
            (scene.gravity.x, scene.gravity.y) = (y.abs().copysign(x), x.abs().copysign(y));
        })
    });
    near.chain(exchanged).collect()
}

fn of_inertia(shape: GrainShape) -> [Control; 4] {
    let scaled = |name: &'static str, by: f64| Control::grains(name, move |grain| grain.inertia *= by);
    let [other_shape, hollow] = match shape {
        GrainShape::Disc => [("the inertia of a sphere in a disc", 0.8), ("the inertia of a ring", 2.0)],
        GrainShape::Sphere => {
            [("the inertia of a disc in a sphere", 1.25), ("the inertia of a hollow sphere", 5.0 / 3.0)]
        }
    };
    [
        scaled(other_shape.0, other_shape.1),
        scaled(hollow.0, hollow.1),
        scaled("grains that do not rotate", 1e12),
        Control::grains("half the mass of each grain", |grain| {
            (grain.mass, grain.inertia) = (0.5 * grain.mass, 0.5 * grain.inertia);
        }),
    ]
}

/// Mistake in contact laws: contact laws that it affects, name and change.
type LawMistake = (fn(&ContactLaw) -> bool, &'static str, fn(&mut ContactLaw));

/// Common mistakes in contact laws.
const LAWS: [LawMistake; 12] = [
    (|law| law.friction > 0.0, "half the friction", |law| law.friction *= 0.5),
    (|law| law.friction > 0.0, "twice the friction", |law| law.friction *= 2.0),
    (|law| law.rolling_friction > 0.0, "half the rolling resistance", |law| law.rolling_friction *= 0.5),
    (|law| law.rolling_friction > 0.0, "twice the rolling resistance", |law| law.rolling_friction *= 2.0),
    (
        |law| law.damping_ratio > 0.0,
        "the restitution taken as the damping ratio",
        |law| {
            if law.damping_ratio > 0.0 {
                law.damping_ratio = law.restitution();
            }
        },
    ),
    (is_damped, "half the normal damping", |law| {
        (law.damping_ratio, law.normal_damping) = (0.5 * law.damping_ratio, 0.5 * law.normal_damping);
    }),
    (is_damped, "twice the normal damping", |law| {
        (law.damping_ratio, law.normal_damping) = ((2.0 * law.damping_ratio).min(0.99), 2.0 * law.normal_damping);
    }),
    (|law| law.tangential_damping > 0.0, "no tangential damping", |law| law.tangential_damping = 0.0),
    (ContactLaw::has_stiffness, "half the stiffness", |law| law.springs = law.springs.scaled([0.5; 2])),
    (ContactLaw::has_stiffness, "twice the stiffness", |law| law.springs = law.springs.scaled([2.0; 2])),
    (ContactLaw::has_stiffness, "half the tangential stiffness", |law| law.scale_tangential(0.5)),
    (ContactLaw::has_stiffness, "a tangential stiffness equal to the normal one", |law| {
        let [normal, tangential] = law.springs.constants();
        if tangential > 0.0 {
            law.scale_tangential(normal / tangential);
        }
    }),
];

fn is_damped(law: &ContactLaw) -> bool {
    law.damping_ratio > 0.0 || law.normal_damping > 0.0
}
