//! Target quantities of accuracy studies. Each has an exact solution, and a scene for each method.
//!
//! The target quantities of a case come from its claims, so that a new case has its diagram without further input. They
//! are quantities with an analytic solution, each method with the scene of its claim. A case folder with a `cost.rs`
//! adds others, such as a sweep of stiffness.

use crate::case::Case;
use crate::claim::{Claim, Measure};
use crate::evidence::Evidence;
use crate::run::{Change, ExpectedOutcome};
use crate::scope::Scope;
use grainbench_scene::solver::{Method, Resolution};

/// Solver setup: the scene and the resolution of one method.
#[derive(Clone)]
pub struct SolverSetup {
    /// Discrete elements, rigid bodies or a grid.
    pub method: Method,
    /// Parameters other than the resolution, in words; empty if there are none.
    pub knobs: String,
    /// Change that turns the scene of the case into the scene of this setup.
    pub prepare: Option<Change>,
    /// Resolution about which the study varies the resolution.
    pub about: Resolution,
}

/// A target quantity with an exact solution.
#[derive(Clone)]
pub struct TargetQuantity {
    /// Case that defines the scene.
    pub case: &'static Case,
    /// Variant of its scene.
    pub variant: &'static str,
    /// Quantity in words.
    pub quantity: String,
    /// Unit of the quantity; `1` for a pure number.
    pub unit: &'static str,
    /// Source of the exact solution.
    pub source: String,
    /// Reads the measured value from the runs.
    pub measure: Measure,
    /// One setup for each solver or choice of parameters.
    pub lanes: Vec<SolverSetup>,
}

/// Largest number of target quantities from the claims of one case.
const MOST: usize = 2;

/// Returns the target quantities from the claims of a case: the first of each variant, those with the most methods
/// first.
#[must_use]
pub fn from_claims(case: &'static Case) -> Vec<TargetQuantity> {
    let mut subjects: Vec<TargetQuantity> = Vec::new();
    for claim in (case.claims)() {
        add(case, &claim, &mut subjects);
    }
    let kinds = |subject: &TargetQuantity| {
        let mut kinds: Vec<Method> = subject.lanes.iter().map(|lane| lane.method).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds.len()
    };
    subjects.sort_by_key(|subject| std::cmp::Reverse(kinds(subject)));
    let mut chosen: Vec<TargetQuantity> = Vec::new();
    for subject in subjects {
        if chosen.len() < MOST && chosen.iter().all(|known| known.variant != subject.variant) {
            chosen.push(subject);
        }
    }
    chosen
}

/// Adds the quantity of a claim to the target quantities.
fn add(case: &'static Case, claim: &Claim, subjects: &mut Vec<TargetQuantity>) {
    let [run] = claim.runs.as_slice() else { return };
    let Some(method) = Method::from_name(run.solver) else { return };
    // Readings of many snapshots need long runs.
    if claim.evidence() != Evidence::Analytic
        || run.standing == ExpectedOutcome::Refused
        || run.reading.is_some()
        || run.data.is_some()
    {
        return;
    }
    // Claims with the same wording have the same expectation, because text after a comma may state it.
    let quantity = claim.quantity.clone();
    let lane = |method, about| SolverSetup {
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
        None => subjects.push(TargetQuantity {
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
