//! Target quantities of accuracy studies. Each has an exact solution, and a scene for each method.
//!
//! The target quantities of a case come from its claims, so that a new case has a cost diagram without further input.
//! They are quantities with an analytic solution, and each method uses the scene of its claim. A case replaces them by other
//! quantities, such as a parameter study of the stiffness, with [`Case::priced_by`].

use crate::case::Case;
use crate::claim::{Claim, Expectation, Measure};
use crate::evidence::Evidence;
use crate::run::{Change, ExpectedOutcome};
use crate::scope::Scope;
use grainbench_scene::method::Method;
use grainbench_solver::resolution::Resolution;
use std::collections::BTreeSet;

/// Solver setup: the scene and the resolution of one method.
#[derive(Clone)]
pub struct SolverSetup {
    /// Method of the solver: DEM, rigid bodies or MPM.
    pub method: Method,
    /// Choice of parameters other than the resolution, in words; empty if there is none.
    pub knobs: String,
    /// Change that turns the scene of the case into the scene of this setup.
    pub prepare: Option<Change>,
    /// Resolution in the middle of the range that the study covers.
    pub about: Resolution,
}

/// A target quantity with an exact solution.
#[derive(Clone)]
pub struct TargetQuantity {
    /// Case that defines the scene.
    pub case: &'static Case,
    /// Variant of the case that the solvers run.
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

/// Returns the target quantities from the claims of a case, at most one per variant. Quantities with the most methods come first.
#[must_use]
pub fn from_claims(case: &'static Case) -> Vec<TargetQuantity> {
    let mut chosen = of_each_variant(case);
    chosen.truncate(MOST);
    chosen
}

/// Returns one target quantity for each variant that has any. Quantities with the most methods come first.
#[must_use]
pub fn of_each_variant(case: &'static Case) -> Vec<TargetQuantity> {
    let mut subjects: Vec<TargetQuantity> = Vec::new();
    for claim in (case.claims)() {
        add(case, &claim, &mut subjects);
    }
    let kinds =
        |subject: &TargetQuantity| subject.lanes.iter().map(|lane| lane.method).collect::<BTreeSet<Method>>().len();
    subjects.sort_by_key(|subject| std::cmp::Reverse(kinds(subject)));
    let mut chosen: Vec<TargetQuantity> = Vec::new();
    for subject in subjects {
        if chosen.iter().all(|known| known.variant != subject.variant) {
            chosen.push(subject);
        }
    }
    chosen
}

/// Adds the quantity of a claim to the list, or adds the claim's solver setup if the list contains the quantity. Ignores
/// claims with several runs, without an analytic value, or with an unsupported scene. A bound is no value: every result
/// within it has the error zero.
fn add(case: &'static Case, claim: &Claim, subjects: &mut Vec<TargetQuantity>) {
    let [run] = claim.runs.as_slice() else { return };
    let Some(method) = Method::from_name(run.solver) else { return };
    // Runs whose snapshots are read are long.
    if claim.evidence() != Evidence::Analytic
        || claim.expectation == Expectation::Bound
        || run.standing == ExpectedOutcome::Refused
        || run.reading.is_some()
        || run.data.is_some()
    {
        return;
    }
    // Claims with the same wording are about the same quantity. If their expectations differ, the wording states them
    // after a comma.
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
