//! Invariance of a collision: in a moving, mirrored or rotated frame, or with the grains in another order, it ends in the same
//! state after the inverse transformation.

use super::end::{End, rounding};
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_scene::scene::Scene;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// Reason for the tolerance of a comparison of two runs.
const ROUNDING: &str = "rounding, summed over all steps: positions by εL, which changes velocities by ω²εLΔt, and velocities by \
                        εU; relative to the largest surface speed U of a grain";

pub(super) const GALILEAN: Property = Property {
    name: "galilean-invariance",
    claim: "if the same velocity is added to all grains, the final state moves with this velocity and does not change \
            otherwise",
    flaw: Flaw::Drag,
    evidence: Evidence::Invariant,
    source: "forces depend on relative positions and velocities",
    because: ROUNDING,
    check: |rows| {
        in_frame(rows, |scene| {
            let speed = if scenes::flat(scene) { SPEED - Vector3::z() * SPEED.z } else { SPEED };
            Frame { turn: Matrix3::identity(), speed }
        })
    },
};

pub(super) const MIRROR: Property = Property {
    name: "mirror-invariance",
    claim: "the final state of a mirrored scene is the mirror image of the final state",
    flaw: Flaw::Handed,
    evidence: Evidence::Invariant,
    source: "contact laws do not distinguish left and right",
    because: ROUNDING,
    check: |rows| {
        let turn = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
        in_frame(rows, |_| Frame { turn, speed: Vector3::zeros() })
    },
};

pub(super) const ROTATION: Property = Property {
    name: "rotation-invariance",
    claim: "the final state of a rotated scene is the rotated final state",
    flaw: Flaw::Anisotropic,
    evidence: Evidence::Invariant,
    source: "contact laws do not depend on the axes",
    because: ROUNDING,
    check: |rows| {
        in_frame(rows, |scene| {
            let axis = if scenes::flat(scene) { Vector3::z() } else { Vector3::new(1.0, 2.0, 3.0) };
            let turn = *Rotation3::from_axis_angle(&Unit::new_normalize(axis), ANGLE).matrix();
            Frame { turn, speed: Vector3::zeros() }
        })
    },
};

pub(super) const PERMUTATION: Property = Property {
    name: "permutation",
    claim: "the final state does not depend on the order in which the grains are listed",
    flaw: Flaw::Listed,
    evidence: Evidence::Invariant,
    source: "forces do not depend on the order of the grains",
    because: ROUNDING,
    check: |rows| {
        // A permutation that is neither the identity nor a reversal: the grain at index p comes from index 3p + 2
        // modulo the number of grains.
        let old_place = |place: usize, count: usize| (3 * place + 2) % count;
        unchanged(
            rows,
            |scene| {
                let count = scene.grains.len();
                let grains: Vec<_> = (0..count).map(|place| scene.grains[old_place(place, count)]).collect();
                scene.grains = grains.into();
            },
            |_, end| {
                let grains = end.grains.clone();
                let count = grains.len();
                for (place, grain) in grains.into_iter().enumerate() {
                    end.grains[old_place(place, count)] = grain;
                }
            },
        )
    },
};

/// Velocity of the moving frame (m/s). It is several times the speed of the fastest grain and parallel to no axis.
const SPEED: Vector3<f64> = Vector3::new(4.0, -3.0, 2.0);
/// Angle of the rotated frame (rad). It maps no coordinate axis onto another.
const ANGLE: f64 = 0.65;
/// Quantity and unit of a comparison of two final states.
pub(super) const APART: (&str, &str) = ("worst velocity, spin × radius or position / time apart, in the end", "m/s");

/// Transformation of a scene: x' = Q x + V t, v' = Q v + V, and ω' = det(Q) Q ω, because the spin ω is a pseudovector.
/// Q is `turn` and V is `speed` (m/s).
struct Frame {
    turn: Matrix3<f64>,
    speed: Vector3<f64>,
}

/// Compares collisions in two frames.
fn in_frame(rows: &Rows<'_>, frame: impl Fn(&Scene) -> Frame) -> Vec<Verdict> {
    let of_spin = |turn: Matrix3<f64>| turn * turn.determinant();
    unchanged(
        rows,
        |scene| {
            let Frame { turn, speed } = frame(scene);
            for grain in scene.grains.iter_mut() {
                grain.position = turn * grain.position;
                grain.velocity = turn * grain.velocity + speed;
                grain.spin = of_spin(turn) * grain.spin;
            }
        },
        |scene, end| {
            let Frame { turn, speed } = frame(scene);
            let back = turn.transpose();
            for grain in &mut end.grains {
                grain.position = back * (grain.position - speed * end.time);
                grain.velocity = back * (grain.velocity - speed);
                grain.spin = of_spin(turn).transpose() * grain.spin;
            }
        },
    )
}

/// Runs each collision and the changed collision, and returns the differences of the final states after the inverse
/// transformation `undo`.
fn unchanged(rows: &Rows<'_>, change: impl Fn(&mut Scene), undo: impl Fn(&Scene, &mut End)) -> Vec<Verdict> {
    let resolution = &rows.terms.resolution;
    rows.each(scenes::collisions(), resolution, APART, |named| {
        let mut changed = named.scene.clone();
        change(&mut changed);
        let straight = End::from_solver(rows.solver, &named.scene, resolution)?;
        let mut seen = End::from_solver(rows.solver, &changed, resolution)?;
        let allowed = rounding(&named.scene, [&straight, &seen]);
        undo(&named.scene, &mut seen);
        Ok(PropertyValue::deviation(straight.apart(&seen), straight.reach().1, allowed))
    })
}
