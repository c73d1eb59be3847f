//! What every solver owes, whatever its method: conservation, symmetries, exact flight, order, determinism.
//!
//! A property runs scenes of its own, in two and three dimensions, with friction and without, and gives rows as gates
//! do: measured value, tolerance and why. Every property has a [`Flaw`] that it must see in the same solver.

mod end;
mod flaw;
mod free_flight;
mod galilean;
mod mirror;
mod momentum;
mod moved;
mod objectivity;
mod once;
mod order;
mod passivity;
mod permutation;
mod rerun;
mod restart;
mod rotation;
mod row;
mod scenes;
mod turning;

use once::Once;
use row::Rows;

pub use flaw::{Flaw, Flawed};

use crate::control::Red;
use crate::evidence::Evidence;
use crate::verdict::{Control, Outcome, Verdict};
use grainbench_scene::solver::Solver;
use grainbench_scene::terms::Terms;
use std::time::Instant;

/// A property that every solver owes.
#[derive(Clone, Copy, Debug)]
pub struct Property {
    /// Name, such as `galilean-invariance`; in rows it is the variant's first part.
    pub name: &'static str,
    /// What is claimed.
    pub claim: &'static str,
    /// The flaw that it must see.
    pub flaw: Flaw,
    /// What kind of evidence its rows are.
    pub evidence: Evidence,
    /// Where it comes from.
    pub source: &'static str,
    /// Why its tolerance is what it is.
    pub because: &'static str,
    check: fn(&Rows<'_>) -> Vec<Verdict>,
}

impl Property {
    /// A row for every scene.
    #[must_use]
    pub fn check(&self, solver: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
        self.check_again(solver, solver, terms)
    }

    /// The same, where runs of the solver may be finished ones: what is done `again`, or watched, is done by the solver itself.
    fn check_again(&self, solver: &dyn Solver, again: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
        (self.check)(&Rows { solver, again, terms, property: self })
    }

    /// The flaw that it must see: where free fall may be off by gΔt/2, one that is larger than that.
    fn flaw(&self, terms: &Terms) -> Flaw {
        let is_rough = self.name == free_flight::PROPERTY.name && terms.order.is_none();
        if is_rough { Flaw::StrongDrag } else { self.flaw }
    }
}

/// Every property.
pub const ALL: [Property; 11] = [
    momentum::PROPERTY,
    galilean::PROPERTY,
    mirror::PROPERTY,
    rotation::PROPERTY,
    permutation::PROPERTY,
    free_flight::PROPERTY,
    objectivity::PROPERTY,
    passivity::PROPERTY,
    order::PROPERTY,
    rerun::PROPERTY,
    restart::PROPERTY,
];

/// The rows of every property, and for each that passes whether the flaw that its property must see turned it red. What
/// a method owes less is no pass, and has no control.
#[must_use]
pub fn judge(solver: &dyn Solver, terms: &Terms) -> (Vec<Verdict>, Vec<Control>) {
    judge_kept(solver, solver, terms)
}

/// The same, with runs of the solver taken from `kept`, which may hold finished ones; what is to be done again, or watched, is
/// done by the solver `itself`.
#[must_use]
pub fn judge_kept(itself: &dyn Solver, kept: &dyn Solver, terms: &Terms) -> (Vec<Verdict>, Vec<Control>) {
    let (mut rows, mut controls) = (Vec::new(), Vec::new());
    let once = Once::new(kept);
    for property in ALL {
        let found = property.check_again(&once, itself, terms);
        let passed = |row: &Verdict| {
            let same = |other: &&Verdict| other.variant == row.variant && other.quantity == row.quantity;
            found.iter().find(same).is_some_and(|other| other.outcome == Outcome::Pass)
        };
        if found.iter().any(|row| row.outcome == Outcome::Pass) {
            let start = Instant::now();
            let flaw = property.flaw(terms);
            // Runs that are wrong may be finished ones too: they are there to be told apart.
            let [flawed, again] = [Flawed::new(&once, flaw), Flawed::again(kept, flaw)];
            // What a method owes less excuses no flaw.
            let flawed = property.check_again(&flawed, &again, &terms.owing_less(&[]));
            let seconds = start.elapsed().as_secs_f64() / flawed.len() as f64;
            let tried = flawed.into_iter().filter(passed);
            controls.extend(tried.map(|row| Control::of(row, flaw.words(), Red::Value, seconds)));
        }
        rows.extend(found);
    }
    (rows, controls)
}

/// Every row that failed or broke, every control that did not turn red as it must, and that nothing passed if nothing
/// did: a line each, for tests of solvers.
#[must_use]
pub fn failures(solver: &dyn Solver, terms: &Terms) -> Vec<String> {
    let (rows, controls) = judge(solver, terms);
    let red = rows.iter().filter(|row| matches!(row.outcome, Outcome::Fail | Outcome::Broken));
    let mut lines: Vec<String> = red
        .map(|row| {
            let error = row.error.map_or_else(|| "no finite number".to_owned(), |error| format!("{error:e}"));
            let detail = row.detail.as_deref().unwrap_or_default();
            format!("{} {}: off {error}, allowed {:e} {detail}", row.variant, row.quantity, row.allowed)
        })
        .collect();
    for control in controls.iter().filter(|control| !control.turned_red) {
        lines.push(format!("{} {}: did not see {}", control.variant, control.quantity, control.wrong_physics));
    }
    for less in terms.less {
        let owed = |row: &&Verdict| {
            row.outcome == Outcome::Known
                && row.variant.starts_with(less.property)
                && row.quantity.starts_with(less.quantity)
        };
        if !rows.iter().any(|row| owed(&row)) {
            lines.push(format!("{} {}: said to be owed less, and kept", less.property, less.quantity));
        }
    }
    if rows.iter().all(|row| row.outcome != Outcome::Pass) {
        lines.push(format!("{}: no row passed", solver.name()));
    }
    lines
}
