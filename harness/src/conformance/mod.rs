//! Conformance properties, which every solver must satisfy: conservation, symmetries, free flight, objectivity,
//! passivity, order of convergence, determinism and restart.
//!
//! A property runs its own scenes, in two and three dimensions, with and without friction. Its results have the form of
//! claim results: measured value, tolerance and reason. Every property has a [`Flaw`] of a solver that it must detect.

mod determinism;
mod end;
mod flaw;
mod free_flight;
mod invariance;
mod momentum;
mod objectivity;
mod once;
mod order;
mod passivity;
mod row;
mod scenes;
mod turning;

use once::CachedRuns;
use row::Rows;

pub use determinism::HalfwayCheckpoint;
pub use flaw::{Flaw, FlawedSolver};

use crate::control::FailureMode;
use crate::evidence::Evidence;
use crate::verdict::{ControlResult, Outcome, Verdict};
use grainbench_solver::Solver;
use grainbench_solver::terms::Terms;
use std::time::Instant;

/// A property that every solver must satisfy.
#[derive(Clone, Copy, Debug)]
pub struct Property {
    /// Name, such as `galilean-invariance`. It is the first part of the variant in results.
    pub name: &'static str,
    /// Property in words.
    pub claim: &'static str,
    /// Flaw that the property must detect.
    pub flaw: Flaw,
    /// Kind of evidence of its results.
    pub evidence: Evidence,
    /// Source of the expectation.
    pub source: &'static str,
    /// Reason for the tolerance.
    pub because: &'static str,
    check: fn(&Rows<'_>) -> Vec<Verdict>,
}

impl Property {
    /// Checks a solver and returns one result for each scene.
    #[must_use]
    pub fn check(&self, solver: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
        self.check_again(solver, solver, terms)
    }

    /// Checks a solver and returns one result for each scene. `solver` may return cached runs. `again` is the same solver
    /// without a cache.
    fn check_again(&self, solver: &dyn Solver, again: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
        (self.check)(&Rows { solver, again, terms, property: self })
    }

    /// Returns the flaw that the property must detect. For free flight, the flaw is larger if the solver claims no order,
    /// because the velocity error in free fall may then be gΔt/2.
    fn flaw(&self, terms: &Terms) -> Flaw {
        let is_rough = self.name == free_flight::PROPERTY.name && terms.order.is_none();
        if is_rough { Flaw::StrongDrag } else { self.flaw }
    }
}

/// All conformance properties.
pub const ALL: [Property; 11] = [
    momentum::PROPERTY,
    invariance::GALILEAN,
    invariance::MIRROR,
    invariance::ROTATION,
    invariance::PERMUTATION,
    free_flight::PROPERTY,
    objectivity::PROPERTY,
    passivity::PROPERTY,
    order::PROPERTY,
    determinism::RERUN,
    determinism::RESTART,
];

/// Returns the results of all properties, and a control for each result that passes.
///
/// A control checks that the property detects its flaw. A result that fails because of a stated exception has no control.
#[must_use]
pub fn judge(solver: &dyn Solver, terms: &Terms) -> (Vec<Verdict>, Vec<ControlResult>) {
    judge_with_cache(solver, solver, terms)
}

/// Returns the results and the controls of all properties. `cached` is the solver with a cache of finished runs.
///
/// `solver` does the runs that are repeated or observed.
#[must_use]
pub fn judge_with_cache(solver: &dyn Solver, cached: &dyn Solver, terms: &Terms) -> (Vec<Verdict>, Vec<ControlResult>) {
    let (mut rows, mut controls) = (Vec::new(), Vec::new());
    let once = CachedRuns::new(cached);
    for property in ALL {
        let found = property.check_again(&once, solver, terms);
        let passed = |row: &Verdict| {
            let same = |other: &&Verdict| other.variant == row.variant && other.quantity == row.quantity;
            found.iter().find(same).is_some_and(|other| other.outcome == Outcome::Pass)
        };
        if found.iter().any(|row| row.outcome == Outcome::Pass) {
            let start = Instant::now();
            let flaw = property.flaw(terms);
            // Runs with a flaw may also come from the cache, because only the flaw must be detected.
            let [flawed, again] = [FlawedSolver::new(&once, flaw), FlawedSolver::again(cached, flaw)];
            // The stated exceptions of the solver do not apply to flawed runs.
            let flawed = property.check_again(&flawed, &again, &terms.owing_less(&[]));
            let seconds = start.elapsed().as_secs_f64() / flawed.len() as f64;
            let tried = flawed.into_iter().filter(passed);
            controls.extend(tried.map(|row| ControlResult::new(row, flaw.words(), FailureMode::Value, seconds)));
        }
        rows.extend(found);
    }
    (rows, controls)
}

/// Returns one line for each failure, for tests of solvers.
///
/// A line reports a red result, an undetected flaw, or a stated exception of which no result makes use. A solver without
/// judged results also has a line.
#[must_use]
pub fn failures(solver: &dyn Solver, terms: &Terms) -> Vec<String> {
    let (rows, controls) = judge(solver, terms);
    let red = rows.iter().filter(|row| row.outcome.is_red());
    let mut lines: Vec<String> = red
        .map(|row| {
            let error = row.error.map_or_else(|| "no finite number".to_owned(), |error| format!("{error:e}"));
            let detail = row.detail.as_deref().unwrap_or_default();
            format!("{} {}: error {error}, allowed {:e} {detail}", row.variant, row.quantity, row.allowed)
        })
        .collect();
    for control in controls.iter().filter(|control| !control.turned_red) {
        lines.push(format!("{} {}: did not detect {}", control.variant, control.quantity, control.wrong_physics));
    }
    for less in terms.less {
        let owed = |row: &&Verdict| {
            row.outcome == Outcome::Known
                && row.variant.starts_with(less.property)
                && row.quantity.starts_with(less.quantity)
        };
        if !rows.iter().any(|row| owed(&row)) {
            lines.push(format!("{} {}: documented as an exception, but satisfied", less.property, less.quantity));
        }
    }
    if !rows.iter().any(|row| row.outcome.is_judged()) {
        lines.push(format!("{}: nothing was judged", solver.name()));
    }
    lines
}
