//! In a mirror, collisions are the same.

use super::moved::{APART, ROUNDING, View};
use super::row::Rows;
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_scene::solver::Solver;
use grainbench_scene::terms::Terms;
use nalgebra::{Matrix3, Vector3};

pub(super) const PROPERTY: Property = Property {
    name: "mirror-invariance",
    claim: "the mirror image of a scene ends as the mirror image of its end",
    flaw: Flaw::Handed,
    check,
};

fn check(solver: &dyn Solver, terms: &Terms) -> Vec<Verdict> {
    let rows = Rows {
        solver,
        terms,
        property: PROPERTY.name,
        evidence: Evidence::Invariant,
        source: "contact laws know no left and right",
        because: ROUNDING,
    };
    let mirror = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
    rows.each(scenes::collisions(), &terms.resolution, APART, |named| {
        View::turned(mirror).compare(solver, &named.scene, terms)
    })
}
