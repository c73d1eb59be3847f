//! Galilean invariance: a collision has the same result in a moving frame.

use super::moved::{APART, ROUNDING, View};
use super::row::Rows;
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use nalgebra::Vector3;

pub(super) const PROPERTY: Property = Property {
    name: "galilean-invariance",
    claim: "if the same velocity is added to all grains, the final state moves with this velocity and does not change \
            otherwise",
    flaw: Flaw::Drag,
    evidence: Evidence::Invariant,
    source: "forces depend on relative positions and velocities",
    because: ROUNDING,
    check,
};

/// Velocity of the frame (m/s). It is several times the speed of the fastest grain and parallel to no axis.
const SPEED: Vector3<f64> = Vector3::new(4.0, -3.0, 2.0);

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    rows.each(scenes::collisions(), &terms.resolution, APART, |named| {
        let speed = if scenes::flat(&named.scene) { SPEED - Vector3::z() * SPEED.z } else { SPEED };
        View::moving(speed).compare(solver, &named.scene, terms)
    })
}
