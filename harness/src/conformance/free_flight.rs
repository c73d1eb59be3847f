//! Free flight: grains without contacts move along straight lines or parabolas.

use super::end::End;
use super::invariance::APART;
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;

pub(super) const PROPERTY: Property = Property {
    name: "free-flight",
    claim: "grains without contact keep their velocity and spin, and fall as x + vt + gt²/2",
    flaw: Flaw::Drag,
    evidence: Evidence::Analytic,
    source: "x + vt + gt²/2, constant spin",
    because: "rounding of velocity and position by ε per step; under gravity also gΔt/2 if the solver does not claim \
              second order; relative to the speed of the fastest grain",
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let second_order = terms.order.is_some_and(|order| order.expected >= 2.0);
    rows.each(scenes::flights(), &terms.resolution, APART, |named| {
        let end = End::from_solver(solver, &named.scene, &terms.resolution)?;
        let (time, gravity) = (end.time, named.scene.gravity);
        let mut exact = end.clone();
        for (grain, start) in exact.grains.iter_mut().zip(&named.scene.grains) {
            grain.position = start.position + start.velocity * time + gravity * (0.5 * time * time);
            grain.velocity = start.velocity + gravity * time;
            grain.spin = start.spin;
        }
        let (far, fast) = exact.reach();
        let lag = if second_order { 0.0 } else { 0.5 * gravity.norm() * end.time_step };
        let allowed = f64::EPSILON * end.steps * (fast + far / time) + lag;
        Ok(PropertyValue::deviation(end.apart(&exact), fast, allowed))
    })
}
