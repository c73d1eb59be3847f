//! Checks the output of any program for a case. It compares the output with the exact solutions of the claims, with our
//! solvers, and with stored runs of other programs.

mod covered;
mod error;
mod exact;
mod figures;
mod horizon;
mod judgement;
mod ours;
mod power;
mod start;
mod stiffness;
mod stored;
mod subject;
mod summary;

pub use error::CheckError;
pub use ours::ConventionChoice;
pub use power::{Power, is_of_power, power_words};
pub use subject::{DeclaredScene, StartFile};
pub use summary::sentence;

use covered::Coverage;
use exact::exact;
use figures::figures;
use grainbench_cases::solvers::Registry;
use grainbench_harness::compare::peers::Peer;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::mistake;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::{Outputs, steps_in_words};
use grainbench_reports::Section;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Snapshot;
use grainbench_solver::resolution::Resolution;
use horizon::Ensemble;
use judgement::is_outside;
use ours::{Plan, nearest_first, ours};
use power::CheckInputs;
use start::{adopt, distance, misplaced};
use std::sync::Arc;
use subject::Candidate;

/// Options of a check: accepted incompleteness, accepted time steps and extent of the power search.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// True if the output may end early or have few samples.
    pub partial: bool,
    /// True if time steps at or above the critical one are accepted.
    pub allow_unstable: bool,
    /// Extent of the search for changes of the scene that the output reveals.
    pub power: Power,
    /// Contact convention with which the output is compared.
    pub convention: ConventionChoice,
}

/// Checks output against a case or a scene file. If no variant of a case is named, the first sample selects the variant.
///
/// If the output ends before the end of the run, claims about the whole run have no result. The result about the
/// coverage is then red, or amber with `partial`.
///
/// # Errors
/// When the files cannot be read, when their first sample matches no scene of the case, or when a time step is at or
/// above the critical one.
pub fn check(subject: &DeclaredScene<'_>, outputs: &Outputs, options: Options) -> Result<Section, CheckError> {
    let mut first_miss = None;
    let mut matching: Vec<(Candidate, DumpRecord)> = Vec::new();
    for mut candidate in subject.candidates()? {
        let observed = outputs.observe(&candidate.scene);
        let observed = match (observed, &first_miss) {
            (Ok(observed), _) => observed,
            // Variants may differ in their numbers of grains. Only the first error is reported.
            (Err(error), None) => {
                first_miss = Some(CheckError::Output(error));
                continue;
            }
            (Err(_), Some(_)) => continue,
        };
        adopt(&mut candidate.scene, &candidate.moved, &observed);
        match misplaced(&candidate.scene, outputs, &observed) {
            None => matching.push((candidate, observed)),
            Some((expected, found)) if first_miss.is_none() => {
                let found = found + &stiffness::at_start(&candidate.scene, &observed);
                first_miss =
                    Some(CheckError::OtherScene { file: outputs.name(), case: subject.place(), expected, found });
            }
            Some(_) => {}
        }
    }
    let mut variants: Vec<&str> = matching.iter().map(|(candidate, _)| candidate.variant.as_str()).collect();
    variants.dedup();
    if variants.len() > 1 {
        let variants = variants.join(", ");
        return Err(CheckError::Ambiguous { file: outputs.name(), case: subject.name(), variants });
    }
    // If few digits are printed, several scenes of a variant can match. The nearest scene is used.
    let starts = matching.len();
    let distance = |(candidate, observed): &(Candidate, DumpRecord)| distance(&candidate.scene, observed);
    matching.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    if let Some((candidate, observed)) = matching.first_mut() {
        let covered = Coverage::new(candidate, outputs.time_step(), observed, options.partial);
        refuse_unstable(&candidate.scene, outputs, options)?;
        let mut section = section(subject, candidate, outputs, observed, &covered, options);
        if let Some(row) = section.verdicts.first_mut().filter(|_| starts > 1) {
            let words = format!(
                "; {starts} scenes of the variant match the first sample within the printed digits; the \
                         nearest is used"
            );
            row.because.push_str(&words);
        }
        return Ok(section);
    }
    Err(first_miss.unwrap_or_else(|| CheckError::OtherScene {
        file: outputs.name(),
        case: subject.name(),
        expected: "a variant with a scene".to_owned(),
        found: "none".to_owned(),
    }))
}

/// Rejects time steps at or above the critical one, because our own solvers would be unstable.
fn refuse_unstable(scene: &Scene, outputs: &Outputs, options: Options) -> Result<(), CheckError> {
    let critical = scene.critical_time_step();
    match outputs.time_step() {
        Some(step) if scene.is_unstable_at(step) && !options.allow_unstable => {
            Err(CheckError::Unstable { file: outputs.name(), critical, step })
        }
        _ => Ok(()),
    }
}

fn section(
    subject: &DeclaredScene<'_>,
    candidate: &Candidate,
    outputs: &Outputs,
    observed: &DumpRecord,
    covered: &Coverage,
    options: Options,
) -> Section {
    let file = outputs.name();
    let steps = outputs.time_steps();
    let row = |quantity: String, unit: &str| {
        let resolution = match steps {
            None => "step unknown".to_owned(),
            Some([shortest, longest]) if shortest == longest => Resolution::TimeStep(longest).to_string(),
            Some(steps) => format!("dt={}", steps_in_words(steps)),
        };
        Verdict {
            variant: candidate.variant.clone(),
            solver: file.clone(),
            resolution,
            evidence: Evidence::OtherCode,
            outcome: Outcome::NoReference,
            ..Verdict::open(subject.name(), quantity, unit)
        }
    };
    let mut verdicts = vec![covered.row(outputs, row("time of the last sample".to_owned(), "s"))];
    let judge = |claim| exact(claim, candidate, outputs, observed, covered, &row);
    let mut of_claims: Vec<Verdict> = candidate.claims.iter().map(judge).collect();
    if let Some(case) = subject.as_stored() {
        let solvers: Arc<dyn Solvers> = Arc::new(Registry);
        mistake::explain(case, &solvers, &candidate.claims.iter().collect::<Vec<_>>(), &mut of_claims);
    }
    verdicts.extend(of_claims);
    let amber = |reason: String| (Outcome::NoReference, reason);
    let unknown = || amber("the files do not contain the time step (--time-step sets it)".to_owned());
    let plan = steps.ok_or_else(unknown).and_then(|steps| Plan::new(observed, steps));
    let run = |plan| against_ours(&candidate.scene, plan, observed, options.convention).map_err(amber);
    let of_ours = plan.and_then(run);
    let (verdicts_of_ours, figures) = match of_ours {
        Ok(of_ours) => {
            let made = of_ours.made(candidate, outputs, observed, covered);
            let power = if subject.case().is_some() { Power::Off } else { options.power };
            let mut rows = rows_of_ours(&made, power, &row);
            let is_other = rows.iter().any(|row| row.outcome == Outcome::Fail || is_outside(row));
            // Contacts of grains that flow out do not carry a static load.
            let is_at_rest = candidate.scene.stays.removal.is_none();
            let hint = of_ours.end.as_ref().filter(|_| is_other && is_at_rest);
            rows.extend(hint.and_then(|end| stiffness::at_end(&candidate.scene, observed, end, &row)));
            (rows, figures(&of_ours.peers, &file, observed))
        }
        Err((Outcome::Fail, reason)) if options.partial => {
            let reason = format!("{reason}; accepted because of --partial");
            (vec![no_comparison(&row, Outcome::NoReference, reason)], Vec::new())
        }
        Err((Outcome::Fail, reason)) => {
            let reason = format!("{reason}; --partial judges the existing samples");
            (vec![no_comparison(&row, Outcome::Fail, reason)], Vec::new())
        }
        Err((outcome, reason)) => (vec![no_comparison(&row, outcome, reason)], Vec::new()),
    };
    let dense = |row: Verdict| if is_of_power(&row) { row } else { covered.dense(row) };
    verdicts.extend(verdicts_of_ours.into_iter().map(dense));
    if let Some(case) = subject.as_stored() {
        verdicts.extend(stored::compare(case, candidate, outputs, observed, covered, &row));
    }
    let (derivation, weak) = match subject.case() {
        Some(case) => (case.derivation, case.weakness),
        None => ("", "A scene without a case has no exact solution here. Our solvers are the only reference."),
    };
    let section = Section {
        name: subject.name(),
        title: format!("{}: {file}", subject.title()),
        claim: format!(
            "The output of another program, `{file}`, has up to {} significant digits. It is compared with exact \
             solutions if the scene has any, with our solvers on the same scene, and with stored runs if there are \
             any.",
            outputs.significant_digits()
        ),
        derivation: derivation.to_owned(),
        weak: weak.to_owned(),
        figures,
        verdicts,
        ..Section::default()
    };
    Section { claim: format!("{} {}", sentence(&section), section.claim), ..section }
}

/// Our runs of a scene.
struct OwnRuns {
    plan: Plan,
    choice: ConventionChoice,
    /// Runs, with the nearest or chosen convention first.
    peers: Vec<Peer>,
    /// Last snapshot of the first run.
    end: Option<Snapshot>,
    /// Our runs after the predictability horizon; `None` if the run is predictable to its end.
    ensemble: Option<Ensemble>,
}

impl OwnRuns {
    fn made<'c>(
        &'c self,
        candidate: &'c Candidate,
        outputs: &'c Outputs,
        observed: &'c DumpRecord,
        covered: &'c Coverage,
    ) -> CheckInputs<'c> {
        let (plan, ours, ensemble, scene) = (&self.plan, &self.peers, self.ensemble.as_ref(), &candidate.scene);
        CheckInputs { scene, plan, ours, choice: self.choice, ensemble, outputs, observed, covered }
    }
}

fn against_ours(scene: &Scene, plan: Plan, observed: &DumpRecord, choice: ConventionChoice) -> Result<OwnRuns, String> {
    let (mut peers, mut ends) = ours(scene, &plan)?;
    let parting = horizon::find(scene, &plan, &peers, choice)?;
    let horizon = parting.as_ref().and_then(|parting| parting.time);
    let nearest = nearest_first(scene, &plan, &mut peers, observed, horizon, choice)?;
    let ensemble = parting.map_or(Ok(None), |parting| horizon::ensemble(scene, &plan, (&peers, choice), parting))?;
    Ok(OwnRuns { plan, choice, peers, end: ends.swap_remove(nearest), ensemble })
}

/// Compares the output with our runs, sample by sample up to the horizon and by means after it. Adds the results about
/// the power of the check.
fn rows_of_ours(made: &CheckInputs<'_>, power: Power, row: &dyn Fn(String, &str) -> Verdict) -> Vec<Verdict> {
    let mut rows = made.compare(made.observed, row);
    if rows.is_empty() {
        let reason = "fewer than two samples are at times of our runs, or the files contain no quantity that can be \
                      compared";
        rows.push(no_comparison(row, Outcome::NoReference, reason.to_owned()));
    }
    rows.extend(made.power(power, row));
    rows
}

fn no_comparison(row: &dyn Fn(String, &str) -> Verdict, outcome: Outcome, reason: String) -> Verdict {
    let row =
        Verdict { because: "no comparison was made".to_owned(), ..row("comparison with our solvers".to_owned(), "1") };
    row.left(outcome, reason)
}
