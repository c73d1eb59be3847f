//! Positions and areas of tracers on the surfaces of bodies.

use crate::points::seed::{around, directions, lattice, parts};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Surface element of a tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Patch {
    /// Position on the surface (m).
    pub(crate) position: Vector3<f64>,
    /// Area times outward unit normal (m²; m in two dimensions).
    pub(crate) area: Vector3<f64>,
}

/// Returns the surface of a disc, counter-clockwise. Tracers are at most `spacing` (m) apart, and their number is a
/// multiple of four. With `outward` = −1 the result is the surface of a hole, clockwise.
pub(crate) fn circle(centre: Vector3<f64>, radius: f64, spacing: f64, outward: f64) -> Vec<Patch> {
    let count = 4 * (TAU * radius / spacing / 4.0).ceil().max(1.0) as usize;
    let length = TAU * radius / count as f64;
    let at = |number: usize| if outward < 0.0 { count - 1 - number } else { number };
    (0..count)
        .map(|number| around(at(number), count))
        .map(|direction| Patch { position: centre + direction * radius, area: direction * (length * outward) })
        .collect()
}

/// Returns the surface of a sphere, in elements with an area of about `spacing`² (m²).
pub(crate) fn globe(centre: Vector3<f64>, radius: f64, spacing: f64) -> Vec<Patch> {
    let area = 4.0 * PI * radius * radius;
    directions(parts(PI * radius, spacing))
        .into_iter()
        .map(|(direction, share)| {
            let direction = direction.normalize();
            Patch { position: centre + direction * radius, area: direction * (area * share) }
        })
        .collect()
}

/// Returns the surface of a rectangle, counter-clockwise: the centres of elements with a length of at most `spacing`
/// (m).
///
/// No tracer is on a corner, because it would belong to two sides there.
pub(crate) fn rectangle(low: Vector3<f64>, high: Vector3<f64>, spacing: f64) -> Vec<Patch> {
    let corners = [low, Vector3::new(high.x, low.y, 0.0), high, Vector3::new(low.x, high.y, 0.0)];
    let mut patches = Vec::new();
    for side in 0..4 {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        let along = to - from;
        let count = (along.norm() / spacing).ceil().max(1.0) as usize;
        let step = along / count as f64;
        let area = Vector3::new(step.y, -step.x, 0.0);
        patches.extend((0..count).map(|number| Patch { position: from + step * (number as f64 + 0.5), area }));
    }
    patches
}

/// Returns the surface of a box in three dimensions: the centres of rectangles with edges of about `spacing` (m).
pub(crate) fn faces(low: Vector3<f64>, high: Vector3<f64>, spacing: f64) -> Vec<Patch> {
    let mut patches = Vec::new();
    for axis in 0..3 {
        for (end, sign) in [(low, -1.0), (high, 1.0)] {
            let (mut from, mut to) = (low, high);
            (from[axis], to[axis]) = (end[axis] - 0.5, end[axis] + 0.5);
            let mut normal = Vector3::zeros();
            normal[axis] = sign;
            let mut width = [spacing; 3];
            width[axis] = 1.0;
            let seeds = lattice(from, to, width, 3);
            patches.extend(seeds.into_iter().map(|seed| Patch { position: seed.position, area: normal * seed.volume }));
        }
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area vectors of a closed surface sum to zero, and the volume ∮ x·n/d converges.
    #[test]
    fn surfaces_are_closed() {
        let globe = globe(Vector3::zeros(), 1.0, 0.1);
        let volume: f64 = globe.iter().map(|patch| patch.position.dot(&patch.area) / 3.0).sum();
        assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-12);
        let rectangle = rectangle(Vector3::zeros(), Vector3::new(2.0, 1.0, 0.0), 0.3);
        assert!(rectangle.iter().map(|patch| patch.area).sum::<Vector3<f64>>().norm() < 1e-12);
        // Tracers on a side cover exactly this side.
        let below: f64 = rectangle.iter().filter(|patch| patch.position.y == 0.0).map(|patch| patch.area.norm()).sum();
        assert!((below - 2.0).abs() < 1e-12);
        let circle = circle(Vector3::zeros(), 1.0, 0.3, 1.0);
        assert_eq!(circle.len() % 4, 0);
        assert!(circle.iter().map(|patch| patch.area).sum::<Vector3<f64>>().norm() < 1e-12);
    }
}
