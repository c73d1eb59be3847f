//! Construction of a surface from the facets of a file. Corners are merged, errors are detected, and the connectivity
//! is computed.

use super::geometry::{Part, nearest};
use super::groups::{Edge, Groups};
use super::stl::{Facet, flaw};
use super::tree::Tree;
use crate::error::SceneError;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Smallest ratio of a triangle's height to its longest side. Below it, the direction of the normal is dominated by
/// rounding.
const FLAT: f64 = 1e-9;

/// Options for reading a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Length of one unit of the coordinates (m).
    pub unit: f64,
    /// Largest distance between corners that are merged (m). Equal corners are always merged.
    pub merge: f64,
    /// True if an edge may belong to only one triangle.
    pub open: bool,
    /// True if the normals must point into the enclosed volume.
    pub inward: bool,
}

/// Surface of triangles.
pub struct Surface {
    pub(super) corners: Vec<Vector3<f64>>,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) triangles: Vec<[Vector3<f64>; 3]>,
    pub(super) normals: Vec<Vector3<f64>>,
    /// Edges of each triangle: edge i leads from corner i of the triangle to the next corner.
    pub(super) sides: Vec<[u32; 3]>,
    pub(super) edges: Vec<Edge>,
    /// Start of the range of each corner in `directions`. The range contains the unit vectors from the corner along its
    /// edges.
    pub(super) from_corner: Vec<u32>,
    pub(super) directions: Vec<Vector3<f64>>,
    pub(super) groups: Groups,
    pub(super) tree: Tree,
}

/// Surfaces are equal if their triangles are equal.
impl PartialEq for Surface {
    fn eq(&self, other: &Self) -> bool {
        self.triangles == other.triangles
    }
}

/// Prints the number and the hash of the triangles. Fingerprints of scenes use this text.
impl std::fmt::Debug for Surface {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut hash = blake3::Hasher::new();
        for number in self.triangles.iter().flatten().flatten() {
            hash.update(&number.to_bits().to_le_bytes());
        }
        write!(formatter, "Surface({}, {})", self.triangles.len(), hash.finalize().to_hex())
    }
}

impl Surface {
    /// Builds the surface from facets.
    ///
    /// # Errors
    /// - When a triangle has no area or occurs twice.
    /// - When a normal contradicts the order of the corners, or two adjacent triangles have opposite orientations.
    /// - When an edge belongs to more than two triangles, or to only one although open edges are not allowed.
    /// - When a corner of an open edge lies on another open edge, between its ends.
    /// - When the normals of a closed surface point inwards instead of outwards, or the reverse for `inward`.
    pub fn new(facets: &[Facet], reading: Reading) -> Result<Self, SceneError> {
        let (corners, faces) = merged(facets, reading);
        let triangles: Vec<_> = faces.iter().map(|face| face.map(|corner| corners[corner as usize])).collect();
        let names = Names(facets);
        let normals = normals(facets, &faces, &triangles, names)?;
        refuse_twice(&faces, names)?;
        let (edges, sides) = edges(&faces, &corners, &normals, names)?;
        let tree = Tree::new(&triangles);
        let open: Vec<&Edge> = edges.iter().filter(|edge| edge.is_open()).collect();
        if let Some(edge) = open.first().filter(|_| !reading.open) {
            return Err(open_flaw(edge, open.len(), &corners, names));
        }
        let (from_corner, directions) = directions(&corners, &edges);
        let groups = Groups::new(&corners, &faces, &normals, &edges, &sides);
        let surface = Self { corners, faces, triangles, normals, sides, edges, from_corner, directions, groups, tree };
        if reading.open {
            surface.refuse_corners_on_edges(reading.merge, names)?;
        } else {
            surface.refuse_wrong_side(reading.inward)?;
        }
        Ok(surface)
    }

    /// Returns the three corners of every triangle (m).
    #[must_use]
    pub fn triangles(&self) -> &[[Vector3<f64>; 3]] {
        &self.triangles
    }

    /// Returns the corners of the bounding box (m).
    #[must_use]
    pub fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        self.corners.iter().fold(start, |(low, high), corner| (low.inf(corner), high.sup(corner)))
    }

    /// Returns the enclosed volume (m³). It is negative if the normals point inwards.
    fn volume(&self) -> f64 {
        let middle = self.corners.iter().sum::<Vector3<f64>>() / self.corners.len() as f64;
        let tetrahedron = |[a, b, c]: &[Vector3<f64>; 3]| (a - middle).dot(&(b - middle).cross(&(c - middle))) / 6.0;
        self.triangles.iter().map(tetrahedron).sum()
    }

    fn refuse_wrong_side(&self, inward: bool) -> Result<(), SceneError> {
        match (self.volume() < 0.0, inward) {
            (true, false) => {
                Err(flaw(None, "normals that point out of the enclosed volume", "all point into the enclosed volume")
                    .help("the triangles are inverted; if this is intended, set `inward = true`"))
            }
            (false, true) => Err(flaw(
                None,
                "normals that point into the enclosed volume (`inward`)",
                "all point out of the enclosed volume",
            )),
            _ => Ok(()),
        }
    }

    /// Rejects a surface if a corner of an open edge lies on another open edge, between its ends. The surface seems to
    /// be closed there but has two rims, and a grain would be in contact with both rims.
    fn refuse_corners_on_edges(&self, merge: f64, names: Names<'_>) -> Result<(), SceneError> {
        let (low, high) = self.bounds();
        let near = merge.max(1e-9 * (high - low).norm());
        for edge in self.edges.iter().filter(|edge| edge.is_open()) {
            for end in edge.ends {
                let corner = self.corners[end as usize];
                let mut on = None;
                self.tree.near(corner, |face| {
                    if let Some(face) = face {
                        let open = self.sides[face as usize].map(|side| &self.edges[side as usize]);
                        let is_on = |other: &&&Edge| {
                            let [a, b] = other.ends.map(|end| self.corners[end as usize]);
                            let (line, from) = (b - a, corner - a);
                            let part = from.dot(&line) / line.norm_squared();
                            let within = near / line.norm();
                            other.is_open()
                                && part > within
                                && part < 1.0 - within
                                && (from - line * part).norm() <= near
                        };
                        on = on.or(open.iter().find(is_on).map(|_| face));
                    }
                    near
                });
                if let Some(face) = on {
                    let found = format!(
                        "one of {} on a side of {}: {:?}",
                        names.name(edge.faces[0] as usize),
                        names.name(face as usize),
                        corner.as_slice()
                    );
                    return Err(names
                        .flaw(edge.faces[0], "corners only at the ends of edges", &found)
                        .help("divide the neighbouring triangle at this corner, or separate the edges"));
                }
            }
        }
        Ok(())
    }

    /// Returns the point of the surface nearest to a position (m).
    #[must_use]
    pub fn nearest(&self, place: Vector3<f64>) -> Vector3<f64> {
        let mut point = nearest(place, &self.triangles[0]).0;
        let mut least = (point - place).norm();
        self.tree.near(place, |face| {
            if let Some(face) = face {
                let other = nearest(place, &self.triangles[face as usize]).0;
                let distance = (other - place).norm();
                if distance < least {
                    (point, least) = (other, distance);
                }
            }
            least
        });
        point
    }

    fn distance_to(&self, place: Vector3<f64>, face: usize) -> f64 {
        match nearest(place, &self.triangles[face]) {
            (_, Part::Face) => (place - self.triangles[face][0]).dot(&self.normals[face]).abs(),
            (point, _) => (point - place).norm(),
        }
    }

    /// Appends the indices of the triangles within the distance `reach` (m) of a position (m) to `list`, in ascending
    /// order.
    pub fn near(&self, place: Vector3<f64>, reach: f64, list: &mut Vec<u32>) {
        let from = list.len();
        self.tree.near(place, |face| {
            list.extend(face.filter(|&face| self.distance_to(place, face as usize) <= reach));
            reach
        });
        list[from..].sort_unstable();
    }
}

/// Returns the corners after merging, and the corner indices of each facet.
fn merged(facets: &[Facet], reading: Reading) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let mut corners: Vec<Vector3<f64>> = Vec::new();
    let mut known: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let merge = reading.merge;
    let mut number = |corner: &Vector3<f64>| {
        // Addition of zero turns −0 into +0.
        let corner = corner * reading.unit + Vector3::zeros();
        let cell: [i64; 3] = if merge > 0.0 {
            (corner / merge).map(|part| part.floor() as i64).into()
        } else {
            corner.map(|part| part.to_bits() as i64).into()
        };
        let around = if merge > 0.0 { -1..=1 } else { 0..=0 };
        for i in around.clone() {
            for j in around.clone() {
                for k in around.clone() {
                    let beside = [0, 1, 2].map(|axis| cell[axis].wrapping_add([i, j, k][axis]));
                    let found = known.get(&beside).and_then(|there| {
                        there.iter().find(|&&there| (corners[there as usize] - corner).norm() <= merge)
                    });
                    if let Some(&found) = found {
                        return found;
                    }
                }
            }
        }
        let new = corners.len() as u32;
        corners.push(corner);
        known.entry(cell).or_default().push(new);
        new
    };
    let faces = facets.iter().map(|facet| facet.corners.each_ref().map(&mut number)).collect();
    (corners, faces)
}

/// Names of facets in error messages.
#[derive(Clone, Copy)]
struct Names<'a>(&'a [Facet]);

impl Names<'_> {
    fn name(self, face: usize) -> String {
        format!("facet {} ({})", face + 1, self.0[face].place)
    }

    /// Returns an error at the position of a facet.
    fn flaw(self, face: u32, expected: &str, found: &str) -> SceneError {
        flaw(Some(self.0[face as usize].place), expected, found)
    }
}

fn normals(
    facets: &[Facet],
    faces: &[[u32; 3]],
    triangles: &[[Vector3<f64>; 3]],
    names: Names<'_>,
) -> Result<Vec<Vector3<f64>>, SceneError> {
    let triangle_normal = |number: usize| {
        let ([a, b, c], [i, j, k]) = (triangles[number], faces[number]);
        let across = (b - a).cross(&(c - a));
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let height = across.norm() / longest;
        if i == j || j == k || k == i || height.is_nan() || height <= FLAT * longest {
            let found = format!("{}: {:?}, {:?}, {:?}", names.name(number), a.as_slice(), b.as_slice(), c.as_slice());
            return Err(names.flaw(number as u32, "triangles with an area", &found));
        }
        let normal = across.normalize();
        if normal.dot(&facets[number].normal) < 0.0 {
            let found = format!("{}, whose normal points to the opposite side", names.name(number));
            return Err(names
                .flaw(number as u32, "normals on the side from which the corners run counter-clockwise", &found)
                .help("the triangle is inverted, or its normal is wrong"));
        }
        Ok(normal)
    };
    (0..facets.len()).map(triangle_normal).collect()
}

fn refuse_twice(faces: &[[u32; 3]], names: Names<'_>) -> Result<(), SceneError> {
    let mut known = BTreeMap::new();
    for (number, face) in faces.iter().enumerate() {
        let mut sorted = *face;
        sorted.sort_unstable();
        if let Some(first) = known.insert(sorted, number) {
            let found = format!("{} and {} with the same corners", names.name(first), names.name(number));
            return Err(names.flaw(first as u32, "each triangle only once", &found));
        }
    }
    Ok(())
}

/// Returns the edges, and the edge indices of each triangle.
fn edges(
    faces: &[[u32; 3]],
    corners: &[Vector3<f64>],
    normals: &[Vector3<f64>],
    names: Names<'_>,
) -> Result<(Vec<Edge>, Vec<[u32; 3]>), SceneError> {
    let (mut edges, mut sides): (Vec<Edge>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    let mut known: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for (number, face) in faces.iter().enumerate() {
        let mut own = [0; 3];
        for side in 0..3 {
            let ends = [face[side], face[(side + 1) % 3]];
            let [a, b] = ends.map(|end| corners[end as usize]);
            let into = normals[number].cross(&(b - a)).normalize();
            let between = || format!("between {:?} and {:?}", a.as_slice(), b.as_slice());
            let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let Some(&at) = known.get(&key) else {
                known.insert(key, edges.len() as u32);
                own[side] = edges.len() as u32;
                edges.push(Edge { ends, faces: [number as u32; 2], into: [into; 2] });
                continue;
            };
            own[side] = at;
            let edge = &mut edges[at as usize];
            let first = edge.faces[0] as usize;
            if !edge.is_open() {
                let found = format!(
                    "{}, {} and {} {}",
                    names.name(first),
                    names.name(edge.faces[1] as usize),
                    names.name(number),
                    between()
                );
                return Err(names
                    .flaw(first as u32, "no more than two triangles at an edge", &found)
                    .help("split a branching surface into several walls"));
            }
            if edge.ends == ends {
                let found = format!(
                    "{} and {} {}, which face different sides",
                    names.name(first),
                    names.name(number),
                    between()
                );
                return Err(names
                    .flaw(first as u32, "neighbours that face the same side", &found)
                    .help("one of them is inverted"));
            }
            (edge.faces[1], edge.into[1]) = (number as u32, into);
        }
        sides.push(own);
    }
    Ok((edges, sides))
}

fn open_flaw(edge: &Edge, count: usize, corners: &[Vector3<f64>], names: Names<'_>) -> SceneError {
    let [a, b] = edge.ends.map(|end| corners[end as usize]);
    let found = format!(
        "{count} edges of one triangle, the first of {} between {:?} and {:?}",
        names.name(edge.faces[0] as usize),
        a.as_slice(),
        b.as_slice()
    );
    // If another corner is very close to corner a, rounding has probably separated two equal corners.
    let size = (b - a).norm();
    let nearly =
        corners.iter().map(|corner| (corner - a).norm()).filter(|&away| away > 0.0).fold(f64::INFINITY, f64::min);
    let help = if nearly < 1e-3 * size {
        format!("another corner is {nearly:e} m from the first one: `merge` (m) merges both")
    } else {
        "if this is intended, as for a funnel, set `open = true`".to_owned()
    };
    names.flaw(edge.faces[0], "two triangles at every edge", &found).help(&help)
}

/// Returns the start of the range of each corner, and the unit vectors from the corners along their edges.
fn directions(corners: &[Vector3<f64>], edges: &[Edge]) -> (Vec<u32>, Vec<Vector3<f64>>) {
    let mut from = vec![0; corners.len() + 1];
    edges.iter().flat_map(|edge| edge.ends).for_each(|end| from[end as usize + 1] += 1);
    (1..from.len()).for_each(|at| from[at] += from[at - 1]);
    let mut next = from.clone();
    let mut directions = vec![Vector3::zeros(); 2 * edges.len()];
    for edge in edges {
        for [a, b] in [edge.ends, [edge.ends[1], edge.ends[0]]] {
            directions[next[a as usize] as usize] = (corners[b as usize] - corners[a as usize]).normalize();
            next[a as usize] += 1;
        }
    }
    (from, directions)
}
