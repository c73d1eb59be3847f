//! Contacts between a sphere and a surface.
//!
//! The distance to the centre of the sphere is a function on the surface. A contact is a local minimum of this function
//! below the radius. On a triangle, the minimum is the foot of the perpendicular from the centre. On an edge or at a
//! corner, it is the nearest point, provided that all adjacent parts lead away from the centre. A sphere thus has one
//! contact on a plane, two contacts in a concave edge between two planes, and one contact on a convex edge. The centre
//! may be on either side of a triangle. A point behind another triangle is not in contact.

use super::build::Surface;
use super::geometry::{Part, lies_across, nearest};
use nalgebra::Vector3;

/// Tolerance of the cosine of the angle at which an adjacent part counts as leading away from the centre. A sphere may
/// lie over the common edge of two triangles in one plane. Rounding then gives a contact with one triangle or with
/// both, but not with none.
const ROUNDING: f64 = 1e-9;

/// Contact of a sphere, in the coordinates of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereContact {
    /// Number of the patch, ridge or corner.
    pub group: u32,
    /// Contact point (m).
    pub point: Vector3<f64>,
    /// Unit vector from the centre to the contact point.
    pub direction: Vector3<f64>,
    /// Distance between centre and contact point (m).
    pub distance: f64,
}

impl Surface {
    /// Replaces `found` by the contacts of a sphere with the triangles in `near`: at most one for each patch, ridge and
    /// corner.
    pub fn touched(&self, centre: Vector3<f64>, radius: f64, near: &[u32], found: &mut Vec<SphereContact>) {
        found.clear();
        for &face in near {
            let Some(touched) = self.candidate(centre, radius, face as usize) else { continue };
            // A point on the border of two parts is one contact, even if both parts report it because of rounding.
            let same = |other: &SphereContact| {
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

    /// Returns the contact at the nearest point of a triangle; `None` if the sphere is not in contact there.
    fn candidate(&self, centre: Vector3<f64>, radius: f64, face: usize) -> Option<SphereContact> {
        let triangle = &self.triangles[face];
        let (point, part) = nearest(centre, triangle);
        if part == Part::Face {
            let height = (centre - triangle[0]).dot(&self.normals[face]);
            let (direction, distance) = (self.normals[face] * -height.signum(), height.abs());
            let touched = SphereContact {
                group: self.groups.of_face[face],
                point: centre + direction * distance,
                direction,
                distance,
            };
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
        is_least.then_some(SphereContact { group, point, direction, distance })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Reading;
    use crate::mesh::groups::Groups;
    use crate::mesh::stl::{Facet, Place};
    use std::collections::BTreeSet;

    fn surface(triangles: &[[[f64; 3]; 3]], open: bool) -> Surface {
        let facet = |corners: &[[f64; 3]; 3]| Facet {
            corners: corners.map(Vector3::from),
            normal: Vector3::zeros(),
            place: Place::Byte(0),
        };
        let facets: Vec<Facet> = triangles.iter().map(facet).collect();
        Surface::new(&facets, Reading { unit: 1.0, merge: 0.0, open, inward: false }).unwrap()
    }

    fn touched(surface: &Surface, centre: [f64; 3], radius: f64) -> Vec<SphereContact> {
        let (mut near, mut found) = (Vec::new(), Vec::new());
        surface.near(centre.into(), radius, &mut near);
        surface.touched(centre.into(), radius, &near, &mut found);
        found
    }

    /// Returns the numbers of patches, ridges and corners that can be in contact with a sphere.
    fn parts(surface: &Surface) -> [usize; 3] {
        let Groups { of_face, of_edge, of_corner } = &surface.groups;
        let mut known = BTreeSet::new();
        [of_face, of_edge, of_corner].map(|groups| groups.iter().filter(|&&group| known.insert(group)).count())
    }

    /// Returns a block with edges of 1 m along x and y, a height (m) along z, and a corner at the origin.
    fn block(height: f64) -> Surface {
        let corner = |bits: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| f64::from((bits >> axis & 1) as u8));
            [x, y, height * z]
        };
        let mut triangles = Vec::new();
        for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            triangles.push([a, b, c].map(corner));
            triangles.push([a, c, d].map(corner));
        }
        surface(&triangles, false)
    }

    #[test]
    fn a_cube_has_six_patches_twelve_ridges_and_eight_corners() {
        assert_eq!(parts(&block(1.0)), [6, 12, 8]);
    }

    /// A sphere on a plane of many triangles has one contact at every position.
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
        assert_eq!(parts(&plane)[0], 1);
        for number in 0..4000 {
            // Every second position lies on a line parallel to the diagonals, which are edges of two triangles.
            let (part, row) = ((f64::from(number) * 0.754_877).fract(), f64::from(number % 10) * 0.1 + 0.1);
            let [x, y] =
                if number % 2 == 0 { [0.2 + part, 0.3 + 0.5 * part] } else { [row + 0.117 * part, row + 0.1 * part] };
            let found = touched(&plane, [x, y, 0.39], 0.1);
            assert_eq!(found.len(), 1, "{x} {y}: {found:?}");
            assert!((found[0].distance - 0.09).abs() < 1e-15 && found[0].group == 0, "{found:?}");
        }
    }

    /// A sphere outside a cube has one contact, at a face, a ridge or a corner. A sphere inside, near a corner, has
    /// three.
    #[test]
    fn a_cube_is_touched_as_a_cube() {
        let cube = block(1.0);
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

    /// The far side of a thin plate lies behind the near side, so a sphere is in contact with the near side only.
    #[test]
    fn a_thin_plate_is_touched_on_one_side() {
        let plate = block(1e-3);
        for [x, y] in [[0.5, 0.4], [0.5, 0.5], [1.0, 0.3]] {
            assert_eq!(touched(&plate, [x, y, 0.091], 0.1).len(), 1);
        }
    }
}
