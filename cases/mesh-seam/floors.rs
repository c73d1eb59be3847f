//! Modified floors of the case, rotated or with an error for a negative control.

use grainbench_scene::mesh::stl::{Facet, Place};
use grainbench_scene::mesh::{Mesh, Reading, Surface};
use grainbench_scene::nalgebra::{Rotation3, Unit, Vector3};
use grainbench_scene::scene::{Scene, WallShape};

/// Returns a mesh with changed triangles, or the unchanged mesh if the changed triangles do not form a surface.
fn rebuilt(mesh: &Mesh, change: impl Fn([Vector3<f64>; 3]) -> [Vector3<f64>; 3]) -> Mesh {
    let facet = |(number, corners): (usize, &[Vector3<f64>; 3])| Facet {
        corners: change(*corners),
        normal: Vector3::zeros(),
        place: Place::Byte(number),
    };
    let facets: Vec<Facet> = mesh.surface.triangles().iter().enumerate().map(facet).collect();
    let reading = Reading { unit: 1.0, merge: 0.0, open: true, inward: false };
    Surface::new(&facets, reading).map_or_else(|_| mesh.clone(), Mesh::at_rest)
}

/// Rotates scene and gravity by 20° about an oblique axis, so that coordinates of floors have rounding errors.
pub(super) fn turned(scene: &mut Scene) {
    let axis = Unit::new_normalize(Vector3::new(0.6, 0.7, 0.2));
    let turn = Rotation3::from_axis_angle(&axis, 20.0_f64.to_radians());
    scene.gravity = turn * scene.gravity;
    for grain in scene.grains.iter_mut() {
        (grain.position, grain.velocity) = (turn * grain.position, turn * grain.velocity);
    }
    for wall in &mut scene.walls {
        wall.shape = match &wall.shape {
            WallShape::Plane { point, normal } => WallShape::Plane { point: turn * point, normal: turn * normal },
            WallShape::Mesh(mesh) => WallShape::Mesh(rebuilt(mesh, |corners| corners.map(|corner| turn * corner))),
            other => other.clone(),
        };
    }
}

/// Raises the floor beyond a line on the sphere's path by a thousandth of its radius, for a negative control.
pub(super) fn with_a_step(scene: &mut Scene) {
    let height = 1e-3 * scene.grains[0].radius;
    for wall in &mut scene.walls {
        let WallShape::Mesh(mesh) = &wall.shape else { continue };
        let lifted = rebuilt(mesh, |corners| {
            let middle = corners.iter().sum::<Vector3<f64>>() / 3.0;
            let up = if middle.x > middle.y { height } else { 0.0 };
            corners.map(|corner| corner + Vector3::z() * up)
        });
        wall.shape = WallShape::Mesh(lifted);
    }
}

/// Replaces the floor by two rectangles with a gap on the sphere's path, for a negative control. Because of the gap of
/// a millionth of a metre, the solver does not join the rectangles, and the sphere has a contact with each.
pub(super) fn of_two_rectangles(scene: &mut Scene) {
    let Some(mut second) = scene.walls.first().cloned() else { return };
    second.name.push_str(", again");
    let half =
        |x: f64| WallShape::Rectangle { corner: Vector3::new(x, -1.0, 0.0), edges: [Vector3::x(), Vector3::y() * 2.0] };
    scene.walls[0].shape = half(-1.0 - 1e-6);
    second.shape = half(0.0);
    scene.walls.push(second);
}
