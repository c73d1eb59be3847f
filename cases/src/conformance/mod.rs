//! What every solver owes, whatever its method: conservation, symmetries, exact flight, order, determinism.
//!
//! A property runs scenes of its own, in two and three dimensions, with friction and without, and gives rows as gates do:
//! measured value, tolerance and why. Every property has a [`Flaw`] that it must see in the same solver.

mod end;
mod flaw;
mod free_flight;
mod galilean;
mod mirror;
mod momentum;
mod moved;
mod order;
mod permutation;
mod rerun;
mod restart;
mod rotation;
mod row;
mod scenes;

pub use flaw::{Flaw, Flawed};

use crate::verdict::{Control, Outcome, Verdict};
use grainbench_scene::solver::{Resolution, Solver};

/// What a solver claims of itself, and how finely it is to be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Resolution of all runs but those that show the order. The collisions last some 30 critical steps.
    pub resolution: Resolution,
    /// Order in the time step; none where the solver claims none.
    pub order: Option<Order>,
}

/// A claim about the order in the time step, for smooth motion without dashpots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The order.
    pub expected: f64,
    /// Three resolutions, each of half the time step of the one before. The run lasts ten critical steps.
    pub ladder: [Resolution; 3],
}

impl Terms {
    /// Central differences at steps that suit springs: second order.
    pub const SECOND_ORDER: Self = Self {
        resolution: Resolution::CriticalFraction(0.02),
        order: Some(Order {
            expected: 2.0,
            ladder: [
                Resolution::CriticalFraction(0.01),
                Resolution::CriticalFraction(0.005),
                Resolution::CriticalFraction(0.0025),
            ],
        }),
    };

    /// No claim about the order.
    #[must_use]
    pub const fn at(resolution: Resolution) -> Self {
        Self { resolution, order: None }
    }
}

/// A property that every solver owes.
#[derive(Clone, Copy, Debug)]
pub struct Property {
    /// Name, such as `galilean-invariance`; in rows it is the variant's first part.
    pub name: &'static str,
    /// What is claimed.
    pub claim: &'static str,
    /// The flaw that it must see.
    pub flaw: Flaw,
    check: fn(&dyn Solver, &Terms) -> Vec<Verdict>,
}

impl Property {
    /// A row for every scene.
    #[must_use]
    pub fn check(&self, solver: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
        (self.check)(solver, terms)
    }

    /// The same with the flaw built into the solver: for every row that the solver can run, whether it turned red.
    #[must_use]
    pub fn control(&self, solver: &dyn Solver, terms: &Terms) -> Vec<Control> {
        let rows = self.check(&Flawed::new(solver, self.flaw), terms);
        let tried = rows.into_iter().filter(|row| row.outcome != Outcome::Unsupported);
        tried
            .map(|row| Control {
                turned_red: matches!(row.outcome, Outcome::Fail | Outcome::Broken),
                case: row.case,
                variant: row.variant,
                solver: row.solver,
                quantity: row.quantity,
                wrong_physics: self.flaw.words().to_owned(),
                error: row.error,
                allowed: row.allowed,
            })
            .collect()
    }
}

/// Every property.
pub const ALL: [Property; 9] = [
    momentum::PROPERTY,
    galilean::PROPERTY,
    mirror::PROPERTY,
    rotation::PROPERTY,
    permutation::PROPERTY,
    free_flight::PROPERTY,
    order::PROPERTY,
    rerun::PROPERTY,
    restart::PROPERTY,
];

/// The rows of every property.
#[must_use]
pub fn check(solver: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
    ALL.iter().flat_map(|property| property.check(solver, terms)).collect()
}

/// The negative controls of every property.
#[must_use]
pub fn controls(solver: &dyn Solver, terms: &Terms) -> Vec<Control> {
    ALL.iter().flat_map(|property| property.control(solver, terms)).collect()
}
