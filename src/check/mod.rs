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
pub use ours::CONVENTION_NAMES;
pub use power::{Power, is_of_power, power_words};
pub use subject::{DeclaredScene, StartFile};
pub use summary::sentence;

use covered::{CheckedOutput, Coverage};
use exact::exact;
use figures::figures;
use grainbench_cases::solvers::Registry;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::mistake;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::{Outputs, steps_in_words};
use grainbench_reports::Section;
use grainbench_solver::resolution::Resolution;
use horizon::OwnRuns;
use judgement::is_outside;
use ours::Plan;
use start::{adopt, continuous, distance, misplaced};
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
    /// Name of our solver with whose contact convention the output is compared. Every error outside its own tolerance is
    /// red. `None` selects the nearest of our conventions. An error outside its own tolerance is then amber if it is smaller
    /// than the difference between our conventions, because the output may have a convention that we do not have.
    pub convention: Option<&'static str>,
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
    let mut first_miss: Option<CheckError> = None;
    let mut matching: Vec<(Candidate, DumpRecord)> = Vec::new();
    for mut candidate in subject.candidates()? {
        let observed = match outputs.observe(&candidate.scene) {
            Ok(observed) => DumpRecord { series: continuous(&candidate.scene, observed.series), ..observed },
            // Variants may differ in their numbers of grains. Only the first error is reported.
            Err(error) => {
                first_miss.get_or_insert(error.into());
                continue;
            }
        };
        adopt(&mut candidate.scene, &candidate.moved, &observed);
        match misplaced(&candidate.scene, outputs, &observed) {
            None => matching.push((candidate, observed)),
            Some((expected, found)) => {
                first_miss.get_or_insert_with(|| {
                    let found = found + &stiffness::at_start(&candidate.scene, &observed);
                    other_scene(outputs, &subject.place(), &expected, &found)
                });
            }
        }
    }
    let mut variants: Vec<&str> = matching.iter().map(|(candidate, _)| candidate.variant.as_str()).collect();
    variants.dedup();
    if variants.len() > 1 {
        let (file, case, variants) = (outputs.name(), subject.name(), variants.join(", "));
        return Err(CheckError::Other(format!(
            "{file}: expected the name of a variant, because several variants of {case} have this start; found none of \
             {variants}"
        )));
    }
    // If few digits are printed, several scenes of a variant can match. The nearest scene is used.
    let starts = matching.len();
    let distance = |(candidate, observed): &(Candidate, DumpRecord)| distance(&candidate.scene, observed);
    matching.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    if let Some((candidate, observed)) = matching.first_mut() {
        let covered = Coverage::new(candidate, outputs.time_step(), observed, options.partial);
        // At or above the critical time step, our own solvers would be unstable.
        let is_unstable = |step: &f64| candidate.scene.is_unstable_at(*step) && !options.allow_unstable;
        if let Some(step) = outputs.time_step().filter(is_unstable) {
            let (file, critical) = (outputs.name(), candidate.scene.critical_time_step());
            return Err(CheckError::Other(format!(
                "{file}: expected a time step below the critical one of the scene, 2√(m_min/k_max) = {critical:.6e} s; found \
                 {step} s, {:.3} of it (--allow-unstable permits it)",
                step / critical
            )));
        }
        let open = open(subject, candidate, outputs);
        let output = CheckedOutput { candidate, outputs, observed, covered, open };
        let mut section = section(subject, &output, options);
        if let Some(row) = section.verdicts.first_mut().filter(|_| starts > 1) {
            let words = "scenes of the variant match the first sample within the printed digits; the nearest is used";
            row.because += &format!("; {starts} {words}");
        }
        return Ok(section);
    }
    Err(first_miss.unwrap_or_else(|| other_scene(outputs, &subject.name(), "a variant with a scene", "none")))
}

/// Returns the error of output that belongs to another scene. `expected` and `found` are the values in the scene and in the
/// output of the first quantity that differs.
fn other_scene(outputs: &Outputs, case: &str, expected: &str, found: &str) -> CheckError {
    let file = outputs.name();
    CheckError::Other(format!("{file}: expected the start of a scene of {case}, {expected}; found {found}"))
}

/// Returns a result without a quantity, for the files and the scene to which they belong.
fn open(subject: &DeclaredScene<'_>, candidate: &Candidate, outputs: &Outputs) -> Verdict {
    let resolution = match outputs.time_steps() {
        None => "step unknown".to_owned(),
        Some([shortest, longest]) if shortest == longest => Resolution::TimeStep(longest).to_string(),
        Some(steps) => format!("dt={}", steps_in_words(steps)),
    };
    Verdict {
        variant: candidate.variant.clone(),
        solver: outputs.name(),
        resolution,
        evidence: Evidence::OtherCode,
        outcome: Outcome::NoReference,
        ..Verdict::open(subject.name(), "", "")
    }
}

fn section(subject: &DeclaredScene<'_>, output: &CheckedOutput<'_>, options: Options) -> Section {
    let CheckedOutput { candidate, outputs, observed, covered, .. } = output;
    let file = outputs.name();
    let mut verdicts = vec![covered.row(outputs, output.row("time of the last sample", "s"))];
    let mut of_claims: Vec<Verdict> = candidate.claims.iter().map(|claim| exact(claim, output)).collect();
    if let Some(case) = subject.as_stored() {
        let solvers: Arc<dyn Solvers> = Arc::new(Registry);
        mistake::explain(case, &solvers, &candidate.claims.iter().collect::<Vec<_>>(), &mut of_claims);
    }
    verdicts.extend(of_claims);
    let amber = |reason: String| (Outcome::NoReference, reason);
    let unknown = || amber("the files do not contain the time step (--time-step sets it)".to_owned());
    let plan = outputs.time_steps().ok_or_else(unknown).and_then(|steps| Plan::new(observed, steps));
    let run = |plan| OwnRuns::new(&candidate.scene, plan, observed, options.convention).map_err(amber);
    let (verdicts_of_ours, figures) = match plan.and_then(run) {
        Ok(runs) => {
            let mut rows = runs.compare(output);
            if rows.is_empty() {
                let reason = "fewer than two samples are at times of our runs, or the files contain no quantity that can be \
                              compared";
                rows.push(no_comparison(output, Outcome::NoReference, reason.to_owned()));
            }
            let power = if subject.case().is_some() { Power::Off } else { options.power };
            rows.extend(power::rows(&runs, output, power));
            let is_other = rows.iter().any(|row| row.outcome == Outcome::Fail || is_outside(row));
            // Contacts of grains that flow out do not carry a static load.
            let is_at_rest = candidate.scene.stays.removal.is_none();
            let hint = runs.end.as_ref().filter(|_| is_other && is_at_rest);
            rows.extend(hint.and_then(|end| stiffness::at_end(output, end)));
            (rows, figures(&runs.peers, &file, observed))
        }
        Err((outcome, reason)) => {
            let (outcome, words) = match outcome {
                Outcome::Fail if options.partial => (Outcome::NoReference, "; accepted because of --partial"),
                Outcome::Fail => (Outcome::Fail, "; --partial judges the existing samples"),
                outcome => (outcome, ""),
            };
            (vec![no_comparison(output, outcome, reason + words)], Vec::new())
        }
    };
    let dense = |row: Verdict| if is_of_power(&row) { row } else { covered.dense(row) };
    verdicts.extend(verdicts_of_ours.into_iter().map(dense));
    if let Some(case) = subject.as_stored() {
        verdicts.extend(stored::compare(case, output));
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
            outputs.significant_digits
        ),
        derivation: derivation.to_owned(),
        weak: weak.to_owned(),
        figures,
        verdicts,
        ..Section::default()
    };
    Section { claim: format!("{} {}", sentence(&section), section.claim), ..section }
}

fn no_comparison(output: &CheckedOutput<'_>, outcome: Outcome, reason: String) -> Verdict {
    let row =
        Verdict { because: "no comparison was made".to_owned(), ..output.row("comparison with our solvers", "1") };
    row.left(outcome, reason)
}
