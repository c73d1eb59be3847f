//! Detection of grains that overlap at the start. A mistyped position is thus an error. Without this check, the contact
//! springs would eject the grains.

use crate::near::near_pairs;
use crate::scene::{Domain, Grain, Wall, WallShape, across};
use nalgebra::Vector3;
use std::ops::ControlFlow;

/// Deepest overlap of a scene, relative to the smaller radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeepestOverlap {
    /// Two grains, by index, and the overlap divided by the smaller radius.
    Grains(usize, usize, f64),
    /// Grain and wall, by index, and the overlap divided by the radius.
    GrainWall(usize, usize, f64),
}

impl DeepestOverlap {
    /// Returns the overlap divided by the smaller radius.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        match self {
            Self::Grains(_, _, ratio) | Self::GrainWall(_, _, ratio) => *ratio,
        }
    }

    /// Converts the grain indices from a subset of the grains to the scene. `places` holds the index in the scene for
    /// each grain of the subset.
    pub(crate) fn among(self, places: &[usize]) -> Self {
        match self {
            Self::Grains(a, b, ratio) => Self::Grains(places[a], places[b], ratio),
            Self::GrainWall(grain, wall, ratio) => Self::GrainWall(places[grain], wall, ratio),
        }
    }

    /// Returns a description of the overlapping bodies and of the depth of the overlap.
    #[must_use]
    pub fn words(&self, walls: &[Wall]) -> String {
        let pair = match self {
            Self::Grains(a, b, _) => format!("grains {} and {}", a + 1, b + 1),
            Self::GrainWall(grain, wall, _) => format!("grain {} and wall {}", grain + 1, walls[*wall].name),
        };
        format!("{pair} overlapping by {:.4} of the radius", self.ratio())
    }
}

/// Returns the deepest overlap among grains, and between grains and walls; `None` if nothing overlaps. The search among
/// grains ends at the first overlap ratio above `enough`. Without this limit, many grains at one position would require
/// a comparison of all pairs. The time is almost proportional to the number of grains.
#[must_use]
pub fn deepest(grains: &[Grain], walls: &[Wall], domain: Option<&Domain>, enough: f64) -> Option<DeepestOverlap> {
    let pairs = grain_pairs(grains, domain, enough);
    let contacts = grains.iter().enumerate().flat_map(|(g, grain)| {
        walls.iter().enumerate().map(move |(w, wall)| {
            DeepestOverlap::GrainWall(g, w, 1.0 - distance(grain.position, &wall.shape) / grain.radius)
        })
    });
    pairs.into_iter().chain(contacts).filter(|found| found.ratio() > 0.0).max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
}

/// Returns the deepest overlap among grains. Of overlaps with equal depth, it is the one with the lowest grain indices.
fn grain_pairs(grains: &[Grain], domain: Option<&Domain>, enough: f64) -> Option<DeepestOverlap> {
    let centres: Vec<Vector3<f64>> = grains.iter().map(|grain| grain.position).collect();
    let radii: Vec<f64> = grains.iter().map(|grain| grain.radius).collect();
    let mut worst = (0.0, usize::MAX, usize::MAX);
    // The search ends early at an overlap that is deep enough, because deeper overlaps are not reported.
    let _ = near_pairs(&centres, &radii, 0.0, domain, |a, b| {
        let (between, reach) = (nearest_image(centres[b] - centres[a], domain), radii[a] + radii[b]);
        // Most pairs do not overlap, and this test needs no square root.
        if between.norm_squared() >= reach * reach {
            return ControlFlow::Continue(());
        }
        let ratio = (reach - between.norm()) / radii[a].min(radii[b]);
        let (first, second) = (a.min(b), a.max(b));
        if ratio > worst.0 || (ratio == worst.0 && (first, second) < (worst.1, worst.2)) {
            worst = (ratio, first, second);
        }
        if worst.0 > enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let (ratio, first, second) = worst;
    (ratio > 0.0).then_some(DeepestOverlap::Grains(first, second, ratio))
}

/// Returns the shortest vector (m) between the periodic images of two positions. `between` is their difference (m).
#[must_use]
pub fn nearest_image(mut between: Vector3<f64>, domain: Option<&Domain>) -> Vector3<f64> {
    if let Some(domain) = domain {
        for axis in 0..3 {
            if domain.periodic[axis] {
                let length = domain.high[axis] - domain.low[axis];
                if between[axis].abs() > 0.5 * length {
                    between[axis] -= length * (between[axis] / length).round();
                }
            }
        }
    }
    between
}

/// Returns the distance (m) from a point to a wall shape; negative in the solid half-space of a plane.
#[must_use]
pub fn distance(point: Vector3<f64>, shape: &WallShape) -> f64 {
    match shape {
        WallShape::Plane { point: on, normal } => (point - on).dot(normal),
        WallShape::Segment { ends } => (point - nearest_on_segment(point, ends)).norm(),
        WallShape::Rectangle { corner, edges } => (point - nearest_on_rectangle(point, corner, edges)).norm(),
        WallShape::Round { axis, radii } => (point - nearest_on_round(point, axis, radii)).norm(),
        WallShape::Mesh(mesh) => (point - mesh.nearest(point)).norm(),
    }
}

/// Returns the point of a segment nearest to `point`.
#[must_use]
pub fn nearest_on_segment(point: Vector3<f64>, ends: &[Vector3<f64>; 2]) -> Vector3<f64> {
    let along = ends[1] - ends[0];
    ends[0] + along * ((point - ends[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}

/// Returns the point of a rectangle nearest to `point`.
#[must_use]
pub fn nearest_on_rectangle(point: Vector3<f64>, corner: &Vector3<f64>, edges: &[Vector3<f64>; 2]) -> Vector3<f64> {
    edges
        .iter()
        .fold(*corner, |at, edge| at + edge * ((point - corner).dot(edge) / edge.norm_squared()).clamp(0.0, 1.0))
}

/// Returns the point of the lateral surface of a cylinder or cone nearest to `point`. It lies in the half-plane that
/// contains `point` and is bounded by the axis. In this half-plane, the surface is a segment. For a point on the axis,
/// the result is one of many nearest points.
#[must_use]
pub fn nearest_on_round(point: Vector3<f64>, axis: &[Vector3<f64>; 2], radii: &[f64; 2]) -> Vector3<f64> {
    let line = axis[1] - axis[0];
    let length = line.norm();
    let along = line / length;
    let from = point - axis[0];
    let height = from.dot(&along);
    let away = from - along * height;
    let distance = away.norm();
    let out = if distance > 1e-12 * (radii[0] + radii[1]) { away / distance } else { across(line) };
    let widening = radii[1] - radii[0];
    let part = (height * length + (distance - radii[0]) * widening) / (length * length + widening * widening);
    let part = part.clamp(0.0, 1.0);
    axis[0] + line * part + out * (radii[0] + widening * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In the domain, the centres of two grains of radius .1 m are .15 m apart, although one grain starts a thousand
    /// periods away. They overlap by half a radius.
    #[test]
    fn grains_far_from_a_periodic_domain_meet_those_within() {
        let grain = |x: f64| Grain { radius: 0.1, position: Vector3::new(x, 0.5, 0.0), ..Grain::default() };
        let domain = Domain { low: Vector3::zeros(), high: Vector3::repeat(4.0), periodic: [true, false, false] };
        let found = deepest(&[grain(4001.0), grain(2.5), grain(1.15)], &[], Some(&domain), 1.0).unwrap();
        assert!(matches!(found, DeepestOverlap::Grains(0, 2, _)) && (found.ratio() - 0.5).abs() < 1e-9, "{found:?}");
    }

    /// Compares the result with sampled points of the cone: none of them is nearer. The result lies on the cone.
    #[test]
    fn the_nearest_point_of_a_cone_is_nearest() {
        let axis = [Vector3::new(0.3, -0.2, 0.1), Vector3::new(1.3, 0.8, 2.1)];
        for radii in [[0.4, 1.5], [1.0, 1.0], [0.0, 2.0]] {
            let line = axis[1] - axis[0];
            let (u, length) = (across(line), line.norm());
            let v = line.cross(&u) / length;
            let surface_point = |part: f64, angle: f64| {
                axis[0] + line * part + (u * angle.cos() + v * angle.sin()) * (radii[0] + (radii[1] - radii[0]) * part)
            };
            for number in 0..200 {
                let odd = |times: f64| (f64::from(number) * times).fract() * 5.0 - 2.0;
                let point = Vector3::new(odd(0.754_877), odd(0.569_840), odd(0.328_117));
                let found = nearest_on_round(point, &axis, &radii);
                let mut nearest = f64::INFINITY;
                for at in 0..40 * 90 {
                    let sample =
                        surface_point(f64::from(at / 90) / 39.0, f64::from(at % 90) * std::f64::consts::TAU / 90.0);
                    nearest = nearest.min((sample - point).norm());
                }
                let distance = (found - point).norm();
                assert!(distance <= nearest + 1e-12 && distance > nearest - 0.06, "{distance} {nearest}");
                let height = (found - axis[0]).dot(&line) / length;
                let away = (found - axis[0] - line * (height / length)).norm();
                assert!((away - radii[0] - (radii[1] - radii[0]) * height / length).abs() < 1e-12);
            }
            // On the axis, all directions are equivalent, so the result is only required to be finite.
            let middle = nearest_on_round(axis[0] + line * 0.5, &axis, &radii);
            assert!(middle.iter().all(|number| number.is_finite()));
        }
    }

    /// Comparing all pairs of a million grains at one position would take hours.
    #[test]
    fn grains_in_one_place_are_found_at_once() {
        let grain = Grain { radius: 0.1, ..Grain::default() };
        assert!(deepest(&vec![grain; 1_000_000], &[], None, 1.0).is_some_and(|found| found.ratio() == 2.0));
    }
}
