//! Contacts that the probes of a scene request, computed from positions of grains and from forces in dumps.

use grainbench_scene::overlap::{nearest_on_rectangle, nearest_on_round, nearest_on_segment};
use grainbench_scene::scene::{ProbeTarget, Scene, WallShape};
use grainbench_solver::record::{ContactState, GrainState, Partner};
use nalgebra::Vector3;

use crate::pair_forces::PairForce;

/// Returns the contacts that the probes request, if they exist. `force` returns the force on the grain, or on the first
/// grain, of a contact; `None` if the force is unknown, which counts as NaN. Normal force and magnitude of the shear force
/// are increased by `shift` times the uncertainty due to printed digits.
pub(crate) fn contacts(
    scene: &Scene,
    time: f64,
    step: u64,
    grains: &[GrainState],
    force: impl Fn(ProbeTarget) -> Option<PairForce>,
    shift: f64,
) -> Vec<ContactState> {
    let time_step = if step == 0 { 0.0 } else { time / step as f64 };
    let mut found = Vec::new();
    for probe in &scene.probes {
        let (grain, partner, (normal, distance), reach) = match probe.target {
            ProbeTarget::Pair(a, b) => {
                let reach = scene.grains[a].radius + scene.grains[b].radius;
                let between = nearest_image(scene, grains[b].position - grains[a].position);
                (a, Partner::Grain(b as u32 + 1), direction(between), reach)
            }
            ProbeTarget::GrainWall(grain, wall) => {
                let at = grains[grain].position;
                let (shape, motion) = (&scene.walls[wall].shape, &scene.walls[wall].motion);
                let shape = shape.moved(motion, &motion.displacement(time, time_step));
                (grain, Partner::Wall(wall as u16), to_wall(at, &shape), scene.grains[grain].radius)
            }
            _ => continue,
        };
        let (overlap, force) = (reach - distance, force(probe.target));
        // A force other than zero proves a contact, even if the computed overlap is not positive because few digits are
        // printed.
        let pushed = force.is_some_and(|known| known.force != Vector3::zeros());
        if !(overlap > 0.0 || pushed) {
            continue;
        }
        let known = force.unwrap_or(PairForce { force: Vector3::repeat(f64::NAN), open: 0.0 });
        let pushes = -known.force.dot(&normal);
        let shear = known.force + normal * pushes;
        let open = shift * known.open;
        found.push(ContactState {
            grain: grain as u32 + 1,
            partner,
            point: grains[grain].position + normal * (scene.grains[grain].radius - 0.5 * overlap),
            normal,
            overlap,
            normal_force: pushes + open,
            shear_force: if shear.norm() > 0.0 { shear * (1.0 + open / shear.norm()) } else { shear },
            slipping: false,
        });
    }
    found
}

/// Returns the direction and the length of a vector.
fn direction(line: Vector3<f64>) -> (Vector3<f64>, f64) {
    let length = line.norm();
    (line / length, length)
}

/// Returns direction and distance (m) from a grain to the nearest point of a wall. For a plane, the direction points
/// into the solid.
fn to_wall(at: Vector3<f64>, shape: &WallShape) -> (Vector3<f64>, f64) {
    match shape {
        WallShape::Plane { point, normal } => (-normal, (at - point).dot(normal)),
        WallShape::Segment { ends } => direction(nearest_on_segment(at, ends) - at),
        WallShape::Rectangle { corner, edges } => direction(nearest_on_rectangle(at, corner, edges) - at),
        WallShape::Round { axis, radii } => direction(nearest_on_round(at, axis, radii) - at),
        WallShape::Mesh(mesh) => direction(mesh.nearest(at) - at),
    }
}

/// Returns the vector `line` between two centres after the shift to the nearest image along periodic axes.
fn nearest_image(scene: &Scene, mut line: Vector3<f64>) -> Vector3<f64> {
    if let Some(domain) = &scene.domain {
        for axis in (0..3).filter(|&axis| domain.periodic[axis]) {
            let length = domain.high[axis] - domain.low[axis];
            line[axis] -= length * (line[axis] / length).round();
        }
    }
    line
}
