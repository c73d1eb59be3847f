//! Conservation of momentum in collisions, and of angular momentum without friction.
//!
//! With friction, the conservation of angular momentum depends on the contact convention. Lever arms R₁ and R₂ violate
//! it if the centres are closer than R₁ + R₂. The case `collision` distinguishes these conventions.

use super::end::End;
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use nalgebra::Vector3;

pub(super) const PROPERTY: Property = Property {
    name: "momentum",
    claim: "collisions conserve momentum, and without friction also angular momentum",
    flaw: Flaw::Drag,
    evidence: Evidence::Invariant,
    source: "equal and opposite forces, along the line of centres without friction",
    because: "rounding of the momentum of each grain by ε per step; relative to the sum of their magnitudes",
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let linear = rows.each(scenes::collisions(), &terms.resolution, ("momentum in the end", "kg m/s"), |named| {
        let end = End::from_solver(solver, &named.scene, &terms.resolution)?;
        let before: Vec<Vector3<f64>> = named.scene.grains.iter().map(|grain| grain.velocity * grain.mass).collect();
        let after: Vec<Vector3<f64>> = end.grains.iter().map(|grain| grain.velocity * grain.mass).collect();
        Ok(kept(&before, &after, end.steps))
    });
    let frictionless =
        scenes::collisions().map(|all| all.into_iter().filter(|named| !named.frictional).collect::<Vec<_>>());
    let quantity = ("angular momentum in the end", "kg m²/s");
    let angular = rows.each(frictionless, &terms.resolution, quantity, |named| {
        let end = End::from_solver(solver, &named.scene, &terms.resolution)?;
        let grains = &named.scene.grains;
        let orbital = |position: &Vector3<f64>, velocity: &Vector3<f64>, mass: f64| position.cross(velocity) * mass;
        let before = grains.iter().map(|grain| orbital(&grain.position, &grain.velocity, grain.mass));
        let before: Vec<_> = before.chain(grains.iter().map(|grain| grain.spin * grain.inertia)).collect();
        let after = end.grains.iter().map(|grain| orbital(&grain.position, &grain.velocity, grain.mass));
        let spins = end.grains.iter().zip(grains.iter()).map(|(grain, start)| grain.spin * start.inertia);
        let after: Vec<_> = after.chain(spins).collect();
        Ok(kept(&before, &after, end.steps))
    });
    [linear, angular].concat()
}

/// Returns the magnitude of the change of a sum. Its scale is the sum of the norms of the terms, before or after,
/// whichever is larger.
fn kept(before: &[Vector3<f64>], after: &[Vector3<f64>], steps: f64) -> PropertyValue {
    let change = after.iter().sum::<Vector3<f64>>() - before.iter().sum::<Vector3<f64>>();
    let size = |parts: &[Vector3<f64>]| parts.iter().map(Vector3::norm).sum::<f64>();
    let scale = size(before).max(size(after));
    PropertyValue::deviation(change.norm(), scale, scale * f64::EPSILON * steps)
}
