//! Finds grains that overlap at the start, so that a mistyped position is an error and not an explosion.

use crate::scene::{Domain, Grain, Wall, WallShape};
use nalgebra::Vector3;

/// The deepest overlap of a scene relative to the smaller radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deepest {
    /// Two grains, by place.
    Grains(usize, usize, f64),
    /// A grain and a wall, by place.
    GrainWall(usize, usize, f64),
}

impl Deepest {
    /// Overlap divided by the smaller radius.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        match self {
            Self::Grains(_, _, ratio) | Self::GrainWall(_, _, ratio) => *ratio,
        }
    }

    /// Who overlaps, and by how much.
    #[must_use]
    pub fn words(&self, walls: &[Wall]) -> String {
        let pair = match self {
            Self::Grains(a, b, _) => format!("grains {} and {}", a + 1, b + 1),
            Self::GrainWall(grain, wall, _) => format!("grain {} and wall {}", grain + 1, walls[*wall].name),
        };
        format!("{pair} overlapping by {:.4} of the radius", self.ratio())
    }
}

/// The deepest overlap among grains, and of grains with walls, if anything overlaps. Where one among grains is deeper than
/// `enough` no deeper ones are looked for: of many grains in one place all pairs would be compared.
#[must_use]
pub fn deepest(grains: &[Grain], walls: &[Wall], domain: Option<&Domain>, enough: f64) -> Option<Deepest> {
    let pairs = grain_pairs(grains, domain, enough);
    let contacts = grains.iter().enumerate().flat_map(|(g, grain)| {
        walls
            .iter()
            .enumerate()
            .map(move |(w, wall)| Deepest::GrainWall(g, w, 1.0 - distance(grain.position, &wall.shape) / grain.radius))
    });
    pairs.into_iter().chain(contacts).filter(|found| found.ratio() > 0.0).max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
}

/// Sorts along x and compares only grains whose extents meet there.
fn grain_pairs(grains: &[Grain], domain: Option<&Domain>, enough: f64) -> Option<Deepest> {
    let periodic = domain.filter(|domain| domain.periodic[0]);
    // Grains may start lengths away from a periodic domain; where they are in it is where others are near.
    let x = |at: usize| {
        let x = grains[at].position.x;
        let outside = periodic.filter(|domain| !(domain.low.x..=domain.high.x).contains(&x));
        outside.map_or(x, |domain| domain.low.x + (x - domain.low.x).rem_euclid(domain.high.x - domain.low.x))
    };
    let left = |at: usize| x(at) - grains[at].radius;
    let mut order: Vec<usize> = (0..grains.len()).collect();
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    let mut worst: Option<Deepest> = None;
    let deeper = |worst: Option<Deepest>, a: usize, b: usize| {
        let between = nearest_image(grains[b].position - grains[a].position, domain);
        let (ra, rb) = (grains[a].radius, grains[b].radius);
        let ratio = (ra + rb - between.norm()) / ra.min(rb);
        let is_deeper = ratio > worst.map_or(0.0, |deepest| deepest.ratio());
        if is_deeper { Some(Deepest::Grains(a.min(b), a.max(b), ratio)) } else { worst }
    };
    let wrap = periodic.map(|domain| domain.high.x - domain.low.x);
    let largest = grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
    for (at, &a) in order.iter().enumerate() {
        let right = x(a) + grains[a].radius;
        let beside = order[at + 1..].iter().take_while(|&&b| left(b) < right);
        worst = beside.fold(worst, |worst, &b| deeper(worst, a, b));
        // Across a periodic face: the first grains of the order come again one length to the right.
        if let Some(length) = wrap.filter(|length| right + largest > x(order[0]) + length - 2.0 * largest) {
            let again = order.iter().take_while(|&&b| left(b) + length < right);
            worst = again.filter(|&&b| b != a).fold(worst, |worst, &b| deeper(worst, a, b));
        }
        if worst.is_some_and(|deepest| deepest.ratio() > enough) {
            break;
        }
    }
    worst
}

fn nearest_image(mut between: Vector3<f64>, domain: Option<&Domain>) -> Vector3<f64> {
    if let Some(domain) = domain {
        for axis in 0..3 {
            if domain.periodic[axis] {
                let length = domain.high[axis] - domain.low[axis];
                between[axis] -= length * (between[axis] / length).round();
            }
        }
    }
    between
}

/// Distance from a point to a wall at the start (m); negative inside the solid of a plane.
#[must_use]
pub fn distance(point: Vector3<f64>, shape: &WallShape) -> f64 {
    match shape {
        WallShape::Plane { point: on, normal } => (point - on).dot(normal),
        WallShape::Segment { ends } => (point - nearest_on_segment(point, ends)).norm(),
        WallShape::Rectangle { corner, edges } => (point - nearest_on_rectangle(point, corner, edges)).norm(),
    }
}

/// The point of a segment that is nearest to `point`.
#[must_use]
pub fn nearest_on_segment(point: Vector3<f64>, ends: &[Vector3<f64>; 2]) -> Vector3<f64> {
    let along = ends[1] - ends[0];
    ends[0] + along * ((point - ends[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}

/// The point of a rectangle that is nearest to `point`.
#[must_use]
pub fn nearest_on_rectangle(point: Vector3<f64>, corner: &Vector3<f64>, edges: &[Vector3<f64>; 2]) -> Vector3<f64> {
    edges
        .iter()
        .fold(*corner, |at, edge| at + edge * ((point - corner).dot(edge) / edge.norm_squared()).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two grains whose places in the domain are .15 m apart, though one starts a thousand lengths away.
    #[test]
    fn grains_far_from_a_periodic_domain_meet_those_within() {
        let grain = |x: f64| Grain {
            material: 0,
            radius: 0.1,
            mass: 1.0,
            inertia: 1.0,
            position: Vector3::new(x, 0.5, 0.0),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        };
        let domain = Domain { low: Vector3::zeros(), high: Vector3::repeat(4.0), periodic: [true, false, false] };
        let found = deepest(&[grain(4001.0), grain(2.5), grain(1.15)], &[], Some(&domain), 1.0).unwrap();
        assert!(matches!(found, Deepest::Grains(0, 2, _)) && (found.ratio() - 0.5).abs() < 1e-9, "{found:?}");
    }

    /// A million grains in one place: of all pairs this would take hours.
    #[test]
    fn grains_in_one_place_are_found_at_once() {
        let grain = Grain {
            material: 0,
            radius: 0.1,
            mass: 1.0,
            inertia: 1.0,
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        };
        assert!(deepest(&vec![grain; 1_000_000], &[], None, 1.0).is_some_and(|found| found.ratio() == 2.0));
    }
}
