//! Joints of walls. A joint is an end of a segment or an edge of a rectangle that lies on another wall. A grain at a
//! joint touches both walls at one point, but only one of them exerts a force there.

use crate::contact::MEMORY;
use crate::geometry::Geometry;
use crate::grains::Grains;
use crate::walls::MovingWall;
use grainbench_scene::overlap::distance;
use grainbench_scene::scene::{Wall, WallShape};
use nalgebra::Vector3;

/// Largest distance of an edge from another wall at which the edge counts as lying on it, relative to the length of the
/// edge's wall.
const ON_WALL: f64 = 1e-9;
/// Relative difference up to which two distances count as equal.
const ROUNDING: f64 = 1e-12;

/// Edges of each wall that lie on other walls.
#[derive(Debug, Default)]
pub(crate) struct Joints {
    /// Joined edges of each wall, as pairs of the index of the edge and the indices of the walls on which it lies. The
    /// list is empty if there are no joints.
    of: Vec<Vec<(usize, Vec<usize>)>>,
}

impl Joints {
    /// Finds the joined edges. Walls that move differently have no joint.
    pub(crate) fn new(walls: &[Wall]) -> Self {
        let joined_edges = walls.iter().enumerate().map(|(number, wall)| {
            let joined = |edge: &Edge| -> Vec<usize> {
                let others = walls.iter().enumerate().filter(|(other, _)| *other != number);
                let on = others.filter(|(_, other)| moves_alike(wall, other) && edge.lies_on(other));
                on.map(|(other, _)| other).collect()
            };
            let edges = edges(&wall.shape).into_iter().enumerate().map(|(edge, ends)| (edge, joined(&ends)));
            edges.filter(|(_, on)| !on.is_empty()).collect()
        });
        let edge_lists: Vec<Vec<(usize, Vec<usize>)>> = joined_edges.collect();
        if edge_lists.iter().all(Vec::is_empty) { Self::default() } else { Self { of: edge_lists } }
    }

    /// Marks the grains at joined edges whose contact belongs to another wall. It moves their contact history to that
    /// wall, so that a grain keeps its springs when it moves over a joint.
    pub(crate) fn look<S: Geometry>(&self, walls: &mut [MovingWall], grains: &Grains<S>) {
        for (number, edges) in self.of.iter().enumerate().filter(|(_, edges)| !edges.is_empty()) {
            let mut near = std::mem::take(&mut walls[number].kept.near);
            let mut covered = std::mem::take(&mut walls[number].covered);
            covered.clear();
            for (slot, memory) in &mut near {
                let at = grains.position(*slot as usize);
                let owner = owner(walls, number, edges, at);
                covered.push(owner.is_some());
                let Some(owner) = owner.filter(|_| *memory != [0.0; MEMORY]) else { continue };
                let theirs = walls[owner].kept.near.iter_mut().find(|(other, _)| other == slot);
                if let Some((_, theirs)) = theirs.filter(|(_, theirs)| *theirs == [0.0; MEMORY]) {
                    *theirs = *memory;
                }
                *memory = [0.0; MEMORY];
            }
            (walls[number].kept.near, walls[number].covered) = (near, covered);
        }
    }
}

/// Returns the wall to which the contact of a grain at `at` (m) belongs; `None` if it is wall `number`. The contact
/// belongs to the nearer of two joined walls. At equal distances, it belongs to the wall with the smaller index.
fn owner(walls: &[MovingWall], number: usize, edges: &[(usize, Vec<usize>)], at: Vector3<f64>) -> Option<usize> {
    let wall = &walls[number];
    let distance = wall.facing(at).distance;
    let nearest = nearest_edges(&wall.shape, at);
    let joined = edges.iter().filter(|(edge, _)| nearest.contains(&Some(*edge))).flat_map(|(_, on)| on);
    let is_owner = |&&other: &&usize| {
        let theirs = walls[other].facing(at).distance;
        let is_nearer = theirs < distance * (1.0 - ROUNDING);
        !walls[other].kept.gone && (is_nearer || (other < number && theirs <= distance * (1.0 + ROUNDING)))
    };
    joined.filter(is_owner).min().copied()
}

/// Edge of a wall, given by its two end points (m). Both points are equal if the edge is an end of a segment.
struct Edge {
    ends: [Vector3<f64>; 2],
    /// Length of the segment, or of the longer side of the rectangle (m).
    size: f64,
}

impl Edge {
    fn lies_on(&self, wall: &Wall) -> bool {
        let [first, last] = self.ends;
        let on = |point: Vector3<f64>| distance(point, &wall.shape).abs() <= ON_WALL * self.size;
        on(first) && on(last) && on((first + last) * 0.5)
    }
}

/// Returns the edges of a wall. A segment has two ends. A rectangle has four sides, at the start and the end of each of
/// its two directions.
fn edges(shape: &WallShape) -> Vec<Edge> {
    match shape {
        WallShape::Segment { ends } => {
            let size = (ends[1] - ends[0]).norm();
            ends.iter().map(|&end| Edge { ends: [end; 2], size }).collect()
        }
        WallShape::Rectangle { corner, edges: [u, v] } => {
            let size = u.norm().max(v.norm());
            let sides = [
                [*corner, corner + v],
                [corner + u, corner + u + v],
                [*corner, corner + u],
                [corner + v, corner + u + v],
            ];
            sides.into_iter().map(|ends| Edge { ends, size }).collect()
        }
        _ => Vec::new(),
    }
}

/// Returns the indices of the edges on which the nearest point of a wall to `at` (m) lies; `None` if this point is in
/// the interior.
fn nearest_edges(shape: &WallShape, at: Vector3<f64>) -> [Option<usize>; 2] {
    let end = |from: &Vector3<f64>, along: Vector3<f64>, first: usize| {
        let part = (at - from).dot(&along) / along.norm_squared();
        if part <= 0.0 { Some(first) } else { (part >= 1.0).then_some(first + 1) }
    };
    match shape {
        WallShape::Segment { ends } => [end(&ends[0], ends[1] - ends[0], 0), None],
        WallShape::Rectangle { corner, edges } => [end(corner, edges[0], 0), end(corner, edges[1], 2)],
        _ => [None; 2],
    }
}

/// Returns true if two walls keep their relative position. Two walls of which one is a piston never do, because forces
/// move a piston.
fn moves_alike(wall: &Wall, other: &Wall) -> bool {
    wall.motion == other.motion && wall.piston.is_none() && other.piston.is_none()
}
