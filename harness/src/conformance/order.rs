//! Smooth motion converges with the order that the solver claims.

use super::end::End;
use super::row::{Found, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::expect::{Bound, Expected, Measured};
use crate::tolerance::{ASYMPTOTIC, Made, asymptotic};
use crate::verdict::Verdict;

pub(super) const PROPERTY: Property = Property {
    name: "order",
    claim: "halving the step divides the error by 2 to the claimed order",
    flaw: Flaw::FirstOrder,
    evidence: Evidence::Convergence,
    source: "the solver's own claim",
    because: ASYMPTOTIC,
    check,
};

/// No rows where no order is claimed.
fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let Some(order) = terms.order else { return Vec::new() };
    rows.each(scenes::held(), &order.levels[0], ("order in the time step of the end", "1"), |named| {
        let run = |at: usize| End::of(solver, &named.scene, &order.levels[at]);
        let ends = [run(0)?, run(1)?, run(2)?];
        // The solver's own finer runs stand for the exact answer, so that no convention of a law is judged.
        let (coarse, fine) = (ends[0].apart(&ends[1]), ends[1].apart(&ends[2]));
        let expected = Expected::Bound(Bound::Order(order.expected));
        Ok(Found {
            measured: Measured::new((coarse / fine).log2(), expected, 1.0),
            allowed: asymptotic(order.expected).of(&[]),
            made: Made::Required,
        })
    })
}
