//! Mirror invariance: a mirrored collision ends with the mirror image of the original final state.

use super::moved::{APART, ROUNDING, View};
use super::row::Rows;
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use nalgebra::{Matrix3, Vector3};

pub(super) const PROPERTY: Property = Property {
    name: "mirror-invariance",
    claim: "the final state of a mirrored scene is the mirror image of the final state",
    flaw: Flaw::Handed,
    evidence: Evidence::Invariant,
    source: "contact laws do not distinguish left and right",
    because: ROUNDING,
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let mirror = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
    rows.each(scenes::collisions(), &terms.resolution, APART, |named| {
        View::turned(mirror).compare(solver, &named.scene, terms)
    })
}
