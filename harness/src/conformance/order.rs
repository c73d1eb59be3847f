//! Order of convergence in smooth motion, compared with the order that the solver claims.

use super::end::{End, NoEnd};
use super::row::{PropertyValue, Rows};
use super::scenes::NamedScene;
use super::{Flaw, Property, scenes, turning};
use crate::evidence::Evidence;
use crate::expect::{Bound, ExpectedValue, Measurement};
use crate::tolerance::{ASYMPTOTIC, ToleranceOrigin, asymptotic};
use crate::verdict::Verdict;
use grainbench_solver::resolution::Resolution;

pub(super) const PROPERTY: Property = Property {
    name: "order",
    claim: "half the time step reduces the error by the factor 2ᵖ, with the claimed order p",
    flaw: Flaw::FirstOrder,
    evidence: Evidence::Convergence,
    source: "the order that the solver claims",
    because: ASYMPTOTIC,
    check,
};

/// Returns no results if the solver claims no order.
fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let terms = rows.terms;
    let Some(order) = terms.order else { return Vec::new() };
    let held = rows.each(scenes::held(), &order.levels[0], QUANTITY, |named| {
        observed(rows, named, order.levels, Bound::Order(order.expected))
    });
    // Runs with rotating walls are longer, so they use larger time steps. Errors of second order may cancel at these
    // time steps, so a higher order also passes.
    let levels = [4.0, 2.0, 1.0].map(|factor| terms.resolution.coarser(factor).unwrap_or(terms.resolution));
    let turning = rows.each(turning::smooth(), &levels[0], QUANTITY, |named| {
        observed(rows, named, levels, Bound::AtLeast(order.expected))
    });
    [held, turning].concat()
}

const QUANTITY: (&str, &str) = ("order in the time step of the end", "1");

/// Returns the observed order from three levels. The reference is the solver's own finest run, so the contact
/// convention has no effect.
fn observed(
    rows: &Rows<'_>,
    named: &NamedScene,
    levels: [Resolution; 3],
    bound: Bound,
) -> Result<PropertyValue, NoEnd> {
    let run = |at: usize| End::from_solver(rows.solver, &named.scene, &levels[at]);
    let ends = [run(0)?, run(1)?, run(2)?];
    let (coarse, fine) = (ends[0].apart(&ends[1]), ends[1].apart(&ends[2]));
    let claimed = rows.terms.order.map_or(f64::NAN, |order| order.expected);
    Ok(PropertyValue {
        measured: Measurement::new((coarse / fine).log2(), ExpectedValue::Bound(bound), 1.0),
        allowed: asymptotic(claimed).allowed(&[]),
        made: ToleranceOrigin::Required,
    })
}
