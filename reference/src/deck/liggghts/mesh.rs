//! Walls as triangles in STL files.

use std::fmt::Write as _;

use grainbench_scene::scene::WallShape;
use nalgebra::Vector3;

/// Corners of a triangle (m).
pub(crate) type Triangle = [Vector3<f64>; 3];

/// Returns the triangles of a wall.
///
/// A plane becomes one triangle, so that no grain crosses an edge between two triangles. The triangle extends by at
/// least `reach` (m) from the point of the plane nearest to `centre`. In two dimensions, a segment becomes a rectangle
/// that extends by `reach` on both sides of the plane z = 0.
pub(crate) fn triangles(shape: &WallShape, centre: Vector3<f64>, reach: f64) -> Vec<Triangle> {
    match *shape {
        WallShape::Mesh(ref mesh) => mesh.triangles().collect(),
        WallShape::Plane { point, normal } => {
            let foot = centre - normal * (centre - point).dot(&normal);
            let (u, v) = tangents(normal);
            vec![[foot - (u + v) * reach, foot + (u * 3.0 - v) * reach, foot + (v * 3.0 - u) * reach]]
        }
        WallShape::Segment { ends: [a, b] } => {
            let depth = Vector3::z() * reach;
            rectangle(a - depth, [b - a, depth * 2.0])
        }
        WallShape::Rectangle { corner, edges } => rectangle(corner, edges),
        // Decks with round walls are refused earlier, because triangles are flat.
        WallShape::Round { .. } => Vec::new(),
    }
}

fn rectangle(corner: Vector3<f64>, [u, v]: [Vector3<f64>; 2]) -> Vec<Triangle> {
    vec![[corner, corner + u, corner + u + v], [corner, corner + u + v, corner + v]]
}

/// Returns two unit vectors that are orthogonal to a normal and to each other. If the normal is along an axis, the
/// vectors are along axes too, so that coordinates are exact.
fn tangents(normal: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let away = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
    let axis = Vector3::ith(away, 1.0);
    let u = (axis - normal * normal.dot(&axis)).normalize();
    (u, normal.cross(&u))
}

/// Returns the text of an STL file with these triangles.
pub(crate) fn stl(triangles: &[Triangle]) -> String {
    let mut text = "solid wall\n".to_owned();
    for triangle in triangles {
        let normal = (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0])).normalize();
        let _ = writeln!(text, " facet normal {:?} {:?} {:?}\n  outer loop", normal.x, normal.y, normal.z);
        for corner in triangle {
            let _ = writeln!(text, "   vertex {:?} {:?} {:?}", corner.x, corner.y, corner.z);
        }
        text.push_str("  endloop\n endfacet\n");
    }
    text + "endsolid wall\n"
}
