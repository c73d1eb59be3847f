//! Rotation invariance: a rotated collision ends with the rotated original final state.

use super::moved::{APART, ROUNDING, View};
use super::row::Rows;
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use nalgebra::{Rotation3, Unit, Vector3};

pub(super) const PROPERTY: Property = Property {
    name: "rotation-invariance",
    claim: "the final state of a rotated scene is the rotated final state",
    flaw: Flaw::Anisotropic,
    evidence: Evidence::Invariant,
    source: "contact laws do not depend on the axes",
    because: ROUNDING,
    check,
};

/// Angle of rotation (rad). It maps no coordinate axis onto another.
const ANGLE: f64 = 0.65;

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    rows.each(scenes::collisions(), &terms.resolution, APART, |named| {
        let axis = if scenes::flat(&named.scene) { Vector3::z() } else { Vector3::new(1.0, 2.0, 3.0) };
        let turn = Rotation3::from_axis_angle(&Unit::new_normalize(axis), ANGLE);
        View::turned(*turn.matrix()).compare(solver, &named.scene, terms)
    })
}
