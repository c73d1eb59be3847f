//! Permutation: the result does not depend on the order of the grains.

use super::end::{End, rounding};
use super::moved::{APART, ROUNDING};
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;

pub(super) const PROPERTY: Property = Property {
    name: "permutation",
    claim: "the final state does not depend on the order in which the grains are listed",
    flaw: Flaw::Listed,
    evidence: Evidence::Invariant,
    source: "forces do not depend on the order of the grains",
    because: ROUNDING,
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    rows.each(scenes::collisions(), &terms.resolution, APART, |named| {
        let straight = End::from_solver(solver, &named.scene, &terms.resolution)?;
        let mut permuted = named.scene.clone();
        // A permutation that is neither the identity nor a reversal: the grain at index p comes from index 3p + 2
        // modulo the number of grains.
        let count = permuted.grains.len();
        let old_place = |place: usize| (3 * place + 2) % count;
        permuted.grains = (0..count).map(|place| named.scene.grains[old_place(place)]).collect();
        let end = End::from_solver(solver, &permuted, &terms.resolution)?;
        let mut restored = straight.clone();
        for place in 0..count {
            restored.grains[old_place(place)] = end.grains[place].clone();
        }
        let allowed = rounding(&named.scene, [&straight, &end]);
        Ok(PropertyValue::deviation(straight.apart(&restored), straight.reach().1, allowed))
    })
}
