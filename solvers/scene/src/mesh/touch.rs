//! Where a sphere touches a surface.
//!
//! It touches wherever the distance from its centre has a least value along the surface that is below its radius: on a triangle
//! at the foot of its centre; on an edge where all that hangs on it goes away from the centre; at a corner likewise. That is the
//! contact of a sphere with the solid itself: one on a plane, two in the corner of two planes, one on the ridge of two. Which
//! side of a triangle the centre is on does not matter, but what lies behind another triangle is not touched.

use super::build::Surface;
use super::geometry::{Part, lies_across, nearest};
use nalgebra::Vector3;

/// Cosine up to which what hangs on an edge counts as going away: rounding, with which a sphere over a seam is over one side or
/// over both, and never over none.
const ROUNDING: f64 = 1e-9;

/// A place at which a sphere touches, in the coordinates of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// The patch, ridge or corner.
    pub group: u32,
    /// The point (m).
    pub point: Vector3<f64>,
    /// Unit vector from the centre to it.
    pub direction: Vector3<f64>,
    /// Distance between the two (m).
    pub distance: f64,
}

impl Surface {
    /// Finds where a sphere touches, among triangles that are near. Of each patch, ridge and corner that is one place at most.
    pub fn touched(&self, centre: Vector3<f64>, radius: f64, near: &[u32], found: &mut Vec<Touched>) {
        found.clear();
        for &face in near {
            let Some(touched) = self.candidate(centre, radius, face as usize) else { continue };
            // A place on the border of two parts is one place: with rounding both may claim it.
            let same = |other: &Touched| {
                other.group == touched.group || (other.point - touched.point).norm() <= 10.0 * ROUNDING * radius
            };
            match found.iter_mut().find(|other| same(other)) {
                None => found.push(touched),
                Some(other) if other.group == touched.group && touched.distance >= other.distance => {}
                Some(other) if other.group < touched.group => {}
                Some(other) => *other = touched,
            }
        }
        if found.len() > 1 {
            found.retain(|touched| {
                !near.iter().any(|&face| lies_across(centre, touched.point, &self.triangles[face as usize]))
            });
        }
    }

    /// The point of a triangle that is nearest, where the sphere touches it there.
    fn candidate(&self, centre: Vector3<f64>, radius: f64, face: usize) -> Option<Touched> {
        let triangle = &self.triangles[face];
        let (point, part) = nearest(centre, triangle);
        if part == Part::Face {
            let height = (centre - triangle[0]).dot(&self.normals[face]);
            let (direction, distance) = (self.normals[face] * -height.signum(), height.abs());
            let touched =
                Touched { group: self.groups.of_face[face], point: centre + direction * distance, direction, distance };
            return (distance < radius).then_some(touched);
        }
        let to = point - centre;
        let distance = to.norm();
        if distance >= radius || distance == 0.0 {
            return None;
        }
        let direction = to / distance;
        let goes_away = |way: &Vector3<f64>| direction.dot(way) >= -ROUNDING;
        let (group, is_least) = match part {
            Part::Side(side) => {
                let edge = self.sides[face][side] as usize;
                (self.groups.of_edge[edge], self.edges[edge].into.iter().all(goes_away))
            }
            Part::Corner(corner) => {
                let corner = self.faces[face][corner] as usize;
                let from = self.from_corner[corner] as usize..self.from_corner[corner + 1] as usize;
                (self.groups.of_corner[corner], self.directions[from].iter().all(goes_away))
            }
            Part::Face => return None,
        };
        is_least.then_some(Touched { group, point, direction, distance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Reading;
    use crate::mesh::stl::{Facet, Place};

    fn surface(triangles: &[[[f64; 3]; 3]], open: bool) -> Surface {
        let facet = |corners: &[[f64; 3]; 3]| Facet {
            corners: corners.map(Vector3::from),
            normal: Vector3::zeros(),
            place: Place::Byte(0),
        };
        let facets: Vec<Facet> = triangles.iter().map(facet).collect();
        Surface::new(&facets, Reading { unit: 1.0, merge: 0.0, open, inward: false }).unwrap()
    }

    fn touched(surface: &Surface, centre: [f64; 3], radius: f64) -> Vec<Touched> {
        let (mut near, mut found) = (Vec::new(), Vec::new());
        surface.near(centre.into(), radius, &mut near);
        surface.touched(centre.into(), radius, &near, &mut found);
        found
    }

    /// A cube of edges of 1 m from the origin.
    fn cube() -> Surface {
        let corner = |bits: usize| [0, 1, 2].map(|axis| f64::from((bits >> axis & 1) as u8));
        let mut triangles = Vec::new();
        for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            triangles.push([a, b, c].map(corner));
            triangles.push([a, c, d].map(corner));
        }
        surface(&triangles, false)
    }

    #[test]
    fn a_cube_has_six_patches_twelve_ridges_and_eight_corners() {
        assert_eq!(cube().parts(), [6, 12, 8]);
    }

    /// A plane of many triangles: one contact wherever the sphere is, on seams and on the corners of triangles too.
    #[test]
    fn a_plane_is_touched_once_everywhere() {
        let at = |i: u32, j: u32| [0.1 * f64::from(i) + 0.017 * f64::from(j), 0.1 * f64::from(j), 0.3];
        let mut triangles = Vec::new();
        for i in 0..12 {
            for j in 0..12 {
                triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        let plane = surface(&triangles, true);
        assert_eq!(plane.parts()[0], 1);
        for number in 0..4000 {
            // Every other one on the diagonals of the triangles, as nearly as rounding has it.
            let (part, row) = ((f64::from(number) * 0.754_877).fract(), f64::from(number % 10) * 0.1 + 0.1);
            let [x, y] =
                if number % 2 == 0 { [0.2 + part, 0.3 + 0.5 * part] } else { [row + 0.117 * part, row + 0.1 * part] };
            let found = touched(&plane, [x, y, 0.39], 0.1);
            assert_eq!(found.len(), 1, "{x} {y}: {found:?}");
            assert!((found[0].distance - 0.09).abs() < 1e-15 && found[0].group == 0, "{found:?}");
        }
    }

    /// Beside a cube: a face, a ridge and a corner from without; three faces in a corner from within.
    #[test]
    fn a_cube_is_touched_as_a_cube() {
        let cube = cube();
        for (centre, distance) in [
            ([0.5, 0.5, 1.1], 0.1),
            ([0.2, 0.2, 1.1], 0.1),
            ([1.06, 0.5, 1.08], 0.1),
            ([1.02, 1.03, 1.06], 0.07),
            ([1.0, 0.5, 1.1], 0.1),
            ([1.0, 1.0, 1.1], 0.1),
        ] {
            let found = touched(&cube, centre, 0.12);
            assert_eq!(found.len(), 1, "{centre:?}: {found:?}");
            assert!((found[0].distance - distance).abs() < 1e-14, "{found:?}");
        }
        let found = touched(&cube, [0.1, 0.11, 0.09], 0.12);
        assert_eq!(found.len(), 3);
        assert!(touched(&cube, [0.5, 0.5, 0.5], 0.4).is_empty());
    }

    /// The far side of a thin plate lies behind the near one.
    #[test]
    fn a_thin_plate_is_touched_on_one_side() {
        let thin = |bits: usize| {
            [f64::from((bits & 1) as u8), f64::from((bits >> 1 & 1) as u8), 1e-3 * f64::from((bits >> 2) as u8)]
        };
        let mut triangles = Vec::new();
        for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            triangles.push([a, b, c].map(thin));
            triangles.push([a, c, d].map(thin));
        }
        let plate = surface(&triangles, false);
        for [x, y] in [[0.5, 0.4], [0.5, 0.5], [1.0, 0.3]] {
            assert_eq!(touched(&plate, [x, y, 0.091], 0.1).len(), 1);
        }
    }
}
