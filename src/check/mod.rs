//! Judging what any program left of a case: by the exact answers of the case's gates, by what our solvers make of the
//! same scene, and by the stored runs of other programs.

mod covered;
mod exact;
mod figures;
mod ours;
mod stored;
mod subject;

pub use subject::Subject;

use covered::Covered;
use exact::exact;
use figures::figures;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::Measured;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::{OutputError, Outputs};
use grainbench_reports::{Section, number};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_scene::solver::Resolution;
use ours::{compare, ours};
use subject::Candidate;
use thiserror::Error;

/// Why outputs cannot be judged.
#[derive(Debug, Error)]
pub enum NotChecked {
    /// The files are damaged or lack something.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The case's scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Several variants start as they do.
    #[error("{file}: expected the name of a variant, for several of {case} start so; found none of {variants}")]
    Ambiguous {
        /// The files.
        file: String,
        /// The case.
        case: String,
        /// The variants that start so.
        variants: String,
    },
    /// They are of another scene.
    #[error("{file}: expected the start of a scene of {case}, {expected}; found {found}")]
    OtherScene {
        /// The files.
        file: String,
        /// The case, with its variant.
        case: String,
        /// Where the first grain that differs should be.
        expected: String,
        /// Where it is.
        found: String,
    },
}

/// How far a start may be off, in radii, beside the printed digits.
const START: f64 = 1e-9;
/// Judges outputs of a case's scene, of one variant or of whichever they start as, or of a scene of the user's own.
///
/// Where they do not reach the end of the run, a row of its own is red, or amber where `partial` says that a part is
/// meant, and claims of the whole run are not judged.
///
/// # Errors
/// When the files cannot be read, or start as no scene of the case does.
pub fn check(subject: &Subject<'_>, outputs: &Outputs, partial: bool) -> Result<Section, NotChecked> {
    let mut first_miss = None;
    let mut matching: Vec<(Candidate, Observed)> = Vec::new();
    for candidate in subject.candidates()? {
        let observed = outputs.observe(&candidate.scene);
        let observed = match (observed, &first_miss) {
            (Ok(observed), _) => observed,
            // Another variant may have another number of grains; the first one is what is told.
            (Err(error), None) => {
                first_miss = Some(NotChecked::Output(error));
                continue;
            }
            (Err(_), Some(_)) => continue,
        };
        match misplaced(&candidate.scene, &observed) {
            None => matching.push((candidate, observed)),
            Some((expected, found)) if first_miss.is_none() => {
                first_miss =
                    Some(NotChecked::OtherScene { file: outputs.name(), case: subject.place(), expected, found });
            }
            Some(_) => {}
        }
    }
    let mut variants: Vec<&str> = matching.iter().map(|(candidate, _)| candidate.variant.as_str()).collect();
    variants.dedup();
    if variants.len() > 1 {
        let variants = variants.join(", ");
        return Err(NotChecked::Ambiguous { file: outputs.name(), case: subject.name(), variants });
    }
    if let Some((candidate, observed)) = matching.first_mut() {
        let covered = Covered::of(&candidate.scene, outputs.time_step(), observed);
        return Ok(section(subject, candidate, outputs, observed, &covered, partial));
    }
    Err(first_miss.unwrap_or_else(|| NotChecked::OtherScene {
        file: outputs.name(),
        case: subject.name(),
        expected: "a variant with a scene".to_owned(),
        found: "none".to_owned(),
    }))
}

/// Where the first grain that does not start as in the scene should be, and where it is.
fn misplaced(scene: &Scene, observed: &Observed) -> Option<(String, String)> {
    let time = observed.series.time.first().copied()?;
    if time.abs() > 0.0 {
        return Some(("at time 0".to_owned(), format!("a first sample at {time} s")));
    }
    for (at, column) in observed.series.columns.iter().enumerate() {
        let (probe, quantity) = column.name.rsplit_once('.')?;
        let probe = scene.probes.iter().find(|other| other.name == probe)?;
        let (ProbeTarget::Grain(grain), Some(axis)) =
            (probe.target, ["x", "y", "z"].iter().position(|axis| *axis == quantity))
        else {
            continue;
        };
        let (expected, radius) = (scene.grains[grain].position[axis], scene.grains[grain].radius);
        let (found, open) = (observed.series.values[at][0], observed.uncertainty[at][0]);
        if (found - expected).abs() > open + START * radius {
            return Some((format!("{} = {expected:?} m", column.name), format!("{found:?} m")));
        }
    }
    None
}

fn section(
    subject: &Subject<'_>,
    candidate: &Candidate,
    outputs: &Outputs,
    observed: &Observed,
    covered: &Covered,
    partial: bool,
) -> Section {
    let file = outputs.name();
    let step = outputs.time_step();
    let row = |quantity: String, unit: &str| {
        let resolution = step.map_or_else(|| "step not told".to_owned(), |step| Resolution::TimeStep(step).to_string());
        Verdict {
            variant: candidate.variant.clone(),
            solver: file.clone(),
            resolution,
            evidence: Evidence::OtherCode,
            outcome: Outcome::NoReference,
            ..Verdict::open(subject.name(), quantity, unit)
        }
    };
    let mut verdicts = vec![covered.row(partial, row("time of the last sample".to_owned(), "s"))];
    verdicts.extend(candidate.claims.iter().map(|claim| exact(claim, candidate, outputs, observed, covered, &row)));
    let (compared, figures) = step.map_or_else(
        || (Err("the files do not tell the time step (--dt gives it)".to_owned()), Vec::new()),
        |step| match ours(&candidate.scene, step, observed) {
            Ok(ours) => (
                Ok(compare(&candidate.scene, &ours, outputs, observed, covered, &row)),
                figures(&ours, &file, observed),
            ),
            Err(reason) => (Err(reason), Vec::new()),
        },
    );
    match compared {
        Ok(rows) => verdicts.extend(rows),
        Err(reason) => {
            let quantity = "comparison with our solvers".to_owned();
            let row = Verdict { because: "none was made".to_owned(), ..row(quantity, "1") };
            verdicts.push(row.left(Outcome::NoReference, reason));
        }
    }
    if let Some(case) = subject.as_stored() {
        verdicts.extend(stored::compare(case, candidate, outputs, observed, &row));
    }
    let (derivation, weak) = match subject.case() {
        Some(case) => (case.derivation, case.weakness),
        None => ("", "Of a scene that is no case there is no exact answer here: our solvers alone are the measure."),
    };
    Section {
        name: subject.name(),
        title: format!("{}: {file}", subject.title()),
        claim: format!(
            "The output of another program, `{file}`, printed with up to {} significant digits, against exact answers where \
             they hold, against our solvers on the same scene, and against stored runs of it where there are some.",
            outputs.significant_digits()
        ),
        derivation: derivation.to_owned(),
        weak: weak.to_owned(),
        figures,
        verdicts,
        controls: Vec::new(),
        runs: Vec::new(),
    }
}

/// The row of what was found, its tolerance widened by what the printed digits leave open. What may be off by as much as
/// it is itself tells nothing.
fn judged(row: Verdict, open: f64, outputs: &Outputs, found: &Measured) -> Verdict {
    widened(row, open, outputs).judged(found).unless_all_passes()
}

/// The row with its tolerance widened by what the printed digits leave open.
fn widened(mut row: Verdict, open: f64, outputs: &Outputs) -> Verdict {
    row.allowed += open;
    // Below a thousandth of the tolerance nobody need know.
    if open > 1e-3 * row.allowed {
        let digits = outputs.significant_digits();
        let words = format!("; widened by {} for the digits printed, {digits} at most", number::fraction(open));
        row.because.push_str(&words);
    }
    row
}
