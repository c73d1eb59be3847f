//! What accuracy is measured by: a quantity with an exact answer, and the scene in which each kind of solver is asked
//! for it.
//!
//! A case's subjects are taken from its own claims, so that a new case has its diagram without another line: rows of
//! one quantity against an analytic answer, each solver in the scene that its row gives it. A folder with a `cost.rs`
//! says more, such as a sweep of stiffness.

use crate::case::Case;
use crate::claim::{Claim, Measure};
use crate::evidence::Evidence;
use crate::run::{Change, Standing};
use crate::scope::Scope;
use grainbench_scene::solver::{Method, Resolution};

/// The scene in which one kind of solver is asked.
#[derive(Clone)]
pub struct Lane {
    /// The kind.
    pub method: Method,
    /// Knobs beside the resolution, in words; empty where there are none.
    pub knobs: String,
    /// What makes the case's scene that of this lane.
    pub prepare: Option<Change>,
    /// Resolution about which the solver's knobs are turned.
    pub about: Resolution,
}

/// A quantity with an exact answer.
#[derive(Clone)]
pub struct Subject {
    /// The case.
    pub case: &'static Case,
    /// Variant of its scene.
    pub variant: &'static str,
    /// Quantity, in words.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// Where the answer comes from.
    pub source: String,
    /// How it is measured.
    pub measure: Measure,
    /// Who is asked.
    pub lanes: Vec<Lane>,
}

/// Subjects taken from claims, of one case at most.
const MOST: usize = 2;

/// Subjects from the claims of a case: of those with the most kinds of solvers, the first of each variant.
#[must_use]
pub fn from_claims(case: &'static Case) -> Vec<Subject> {
    let mut subjects: Vec<Subject> = Vec::new();
    for claim in (case.claims)() {
        add(case, &claim, &mut subjects);
    }
    let kinds = |subject: &Subject| {
        let mut kinds: Vec<Method> = subject.lanes.iter().map(|lane| lane.method).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds.len()
    };
    subjects.sort_by_key(|subject| std::cmp::Reverse(kinds(subject)));
    let mut chosen: Vec<Subject> = Vec::new();
    for subject in subjects {
        if chosen.len() < MOST && chosen.iter().all(|known| known.variant != subject.variant) {
            chosen.push(subject);
        }
    }
    chosen
}

/// Adds what a claim asks for to the subjects so far.
fn add(case: &'static Case, claim: &Claim, subjects: &mut Vec<Subject>) {
    let [run] = claim.runs.as_slice() else { return };
    let Some(method) = Method::of(run.solver) else { return };
    // What is read of many snapshots takes long runs.
    if claim.evidence() != Evidence::Analytic
        || run.standing == Standing::Refused
        || run.reading.is_some()
        || run.data.is_some()
    {
        return;
    }
    // Rows of one quantity, word for word, have one expectation: what follows a comma may be what is expected.
    let quantity = claim.quantity.clone();
    let lane = |method, about| Lane {
        method,
        knobs: run.adjustment.as_ref().map(|(name, _)| name.clone()).unwrap_or_default(),
        prepare: run.adjustment.as_ref().map(|(_, change)| change.clone()),
        about,
    };
    let mut lanes = vec![lane(method, run.resolution)];
    if claim.scope == Scope::AnySolver && method == Method::Dem {
        lanes.push(lane(Method::Rigid, Resolution::substeps(8)));
    }
    match subjects.iter_mut().find(|known| known.variant == run.variant && known.quantity == quantity) {
        Some(known) => {
            for lane in lanes {
                if known.lanes.iter().all(|other| other.method != lane.method || other.knobs != lane.knobs) {
                    known.lanes.push(lane);
                }
            }
        }
        None => subjects.push(Subject {
            case,
            variant: run.variant,
            quantity,
            unit: claim.unit,
            source: claim.source.words(),
            measure: claim.measure.clone(),
            lanes,
        }),
    }
}
