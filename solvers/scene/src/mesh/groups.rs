//! Patches, ridges and corners of a surface, independent of its triangulation.

use nalgebra::Vector3;

/// Sine of the largest angle between a triangle and the first triangle of its patch, or between an edge and the first
/// edge of its ridge. Rounding to single precision in a file rotates the triangles of a plane by up to 10⁻⁵ rad.
/// Adjacent sides of a cylinder belong to different patches unless the cylinder has more than 60,000 sides.
const STRAIGHT: f64 = 1e-4;
/// Value for a triangle, edge or corner without a group.
const NONE: u32 = u32::MAX;

/// Edge between two corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    /// Adjacent triangles. An open edge has one, which is stored twice.
    pub(super) faces: [u32; 2],
    /// For each triangle in `faces`, the unit vector in the plane of the triangle that is perpendicular to the edge and
    /// points into the triangle.
    pub(super) into: [Vector3<f64>; 2],
}

impl Edge {
    pub(super) fn is_open(&self) -> bool {
        self.faces[0] == self.faces[1]
    }
}

/// Group of every triangle, edge and corner of a surface. A group is a patch, a ridge or a corner. Patches have the
/// lowest numbers, then ridges, then corners.
#[derive(Clone, Debug)]
pub(super) struct Groups {
    pub(super) of_face: Vec<u32>,
    pub(super) of_edge: Vec<u32>,
    pub(super) of_corner: Vec<u32>,
}

impl Groups {
    pub(super) fn new(
        corners: &[Vector3<f64>],
        faces: &[[u32; 3]],
        normals: &[Vector3<f64>],
        edges: &[Edge],
        sides: &[[u32; 3]],
    ) -> Self {
        let (of_face, patches) = patches(normals, edges, sides);
        let in_patch = |edge: &Edge| {
            let [a, b] = edge.faces.map(|face| of_face[face as usize]);
            (!edge.is_open() && a == b).then_some(a)
        };
        let mut of_edge: Vec<u32> = edges.iter().map(|edge| in_patch(edge).unwrap_or(NONE)).collect();
        // For each corner, its edges that do not lie inside a patch.
        let mut sharp: Vec<Vec<u32>> = vec![Vec::new(); corners.len()];
        for (number, edge) in edges.iter().enumerate().filter(|(number, _)| of_edge[*number] == NONE) {
            edge.ends.iter().for_each(|&end| sharp[end as usize].push(number as u32));
        }
        let ridges = ridges(corners, edges, &sharp, &mut of_edge, patches);
        let mut of_corner = vec![NONE; corners.len()];
        let mut several = vec![false; corners.len()];
        for (number, face) in faces.iter().enumerate() {
            for &corner in face {
                let corner = corner as usize;
                several[corner] |= of_corner[corner] != NONE && of_corner[corner] != of_face[number];
                of_corner[corner] = of_face[number];
            }
        }
        let mut next = patches + ridges;
        for corner in 0..corners.len() {
            match sharp[corner][..] {
                [] if !several[corner] => {}
                [a, b] if of_edge[a as usize] == of_edge[b as usize] => of_corner[corner] = of_edge[a as usize],
                _ => {
                    of_corner[corner] = next;
                    next += 1;
                }
            }
        }
        Self { of_face, of_edge, of_corner }
    }
}

/// Returns the patch of every triangle, and the number of patches.
fn patches(normals: &[Vector3<f64>], edges: &[Edge], sides: &[[u32; 3]]) -> (Vec<u32>, u32) {
    let mut of_face = vec![NONE; normals.len()];
    let (mut count, mut open) = (0, Vec::new());
    for first in 0..normals.len() {
        if of_face[first] != NONE {
            continue;
        }
        of_face[first] = count;
        open.push(first);
        while let Some(face) = open.pop() {
            for side in sides[face] {
                for other in edges[side as usize].faces.map(|other| other as usize) {
                    if of_face[other] == NONE && is_straight(normals[first], normals[other]) {
                        of_face[other] = count;
                        open.push(other);
                    }
                }
            }
        }
        count += 1;
    }
    (of_face, count)
}

/// Assigns a ridge to every edge that does not lie inside a patch. Returns the number of ridges.
fn ridges(corners: &[Vector3<f64>], edges: &[Edge], sharp: &[Vec<u32>], of_edge: &mut [u32], patches: u32) -> u32 {
    let along = |edge: &Edge| (corners[edge.ends[1] as usize] - corners[edge.ends[0] as usize]).normalize();
    let (mut count, mut open) = (0, Vec::new());
    for first in 0..edges.len() {
        if of_edge[first] != NONE {
            continue;
        }
        of_edge[first] = patches + count;
        open.push(first);
        let line = along(&edges[first]);
        while let Some(edge) = open.pop() {
            for end in edges[edge].ends {
                let [a, b] = sharp[end as usize][..] else { continue };
                let other = (if a as usize == edge { b } else { a }) as usize;
                let direction = along(&edges[other]);
                if of_edge[other] == NONE
                    && line.cross(&direction).norm() <= STRAIGHT
                    && goes_on(edges, edge, other, end, &along)
                {
                    of_edge[other] = patches + count;
                    open.push(other);
                }
            }
        }
        count += 1;
    }
    count
}

/// Returns true if edge b continues edge a beyond their common end, instead of turning back.
fn goes_on(edges: &[Edge], a: usize, b: usize, end: u32, along: &dyn Fn(&Edge) -> Vector3<f64>) -> bool {
    let away = |edge: &Edge| if edge.ends[0] == end { along(edge) } else { -along(edge) };
    away(&edges[a]).dot(&away(&edges[b])) < 0.0
}

fn is_straight(first: Vector3<f64>, other: Vector3<f64>) -> bool {
    first.dot(&other) > 0.0 && first.cross(&other).norm() <= STRAIGHT
}
