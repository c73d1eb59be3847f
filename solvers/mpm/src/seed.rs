//! Material points in bodies, and tracers on their surfaces.
//!
//! Points of a disc are on rings, and points of a sphere on shells. Radius and latitude are chosen so that mass, centre
//! and inertia tensor of the body are exact. Points of a box are on a lattice that fits the box.

use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Initial position and volume of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// Position (m).
    pub position: Vector3<f64>,
    /// Volume (m³; m² in two dimensions).
    pub volume: f64,
}

/// Surface element of a tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Position on the surface (m).
    pub position: Vector3<f64>,
    /// Area times outward unit normal (m²; m in two dimensions).
    pub area: Vector3<f64>,
}

/// Returns the number of parts of about `spacing` in `length`, at least one.
fn parts(length: f64, spacing: f64) -> usize {
    (length / spacing).round().max(1.0) as usize
}

/// Fills a disc, or the ring between two radii (m), with rings of a width of about `spacing` (m).
///
/// Points of a ring from r₁ to r₂ are at √((r₁² + r₂²)/2), which gives the exact moment of inertia of the ring.
#[must_use]
pub fn rings(centre: Vector3<f64>, inner: f64, outer: f64, spacing: f64) -> Vec<Seed> {
    let count = parts(outer - inner, spacing);
    let width = (outer - inner) / count as f64;
    let mut seeds = Vec::new();
    for ring in 0..count {
        let (low, high) = (inner + ring as f64 * width, inner + (ring + 1) as f64 * width);
        let sectors = 4 * parts(PI * (low + high) / 4.0, width);
        let radius = ((low * low + high * high) * 0.5).sqrt();
        let volume = PI * (high * high - low * low) / sectors as f64;
        seeds.extend((0..sectors).map(|sector| Seed { position: centre + around(sector, sectors) * radius, volume }));
    }
    seeds
}

/// Returns the direction to the middle of a sector.
fn around(sector: usize, sectors: usize) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos((sector as f64 + 0.5) * TAU / sectors as f64);
    Vector3::new(cosine, sine, 0.0)
}

/// Fills a sphere with shells of a thickness of about `spacing` (m).
///
/// Points of a shell from r₁ to r₂ are at the radius with r² = (3/5)(r₂⁵ − r₁⁵)/(r₂³ − r₁³). Points of a band between
/// two latitudes are at the root mean square of the band's height.
#[must_use]
pub fn shells(centre: Vector3<f64>, radius: f64, spacing: f64) -> Vec<Seed> {
    let count = parts(radius, spacing);
    let width = radius / count as f64;
    let mut seeds = Vec::new();
    for shell in 0..count {
        let (low, high) = (shell as f64 * width, (shell + 1) as f64 * width);
        let cubes = high.powi(3) - low.powi(3);
        let at = (0.6 * (high.powi(5) - low.powi(5)) / cubes).sqrt();
        let volume = 4.0 / 3.0 * PI * cubes;
        seeds.extend(
            directions(parts(PI * at, width))
                .into_iter()
                .map(|(direction, share)| Seed { position: centre + direction * at, volume: volume * share }),
        );
    }
    seeds
}

/// Returns unit vectors n over the sphere in an even number of latitude bands, each with its share of the area: Σ share
/// = 1, Σ share n = 0 and Σ share n nᵀ = 1/3.
fn directions(bands: usize) -> Vec<(Vector3<f64>, f64)> {
    let bands = bands.div_ceil(2).max(1) * 2;
    let mut all = Vec::new();
    for band in 0..bands {
        let edge = |number: usize| libm::cos(number as f64 * PI / bands as f64);
        let (upper, lower) = (edge(band), edge(band + 1));
        let squared = (upper * upper + upper * lower + lower * lower) / 3.0;
        let height = squared.sqrt().copysign(upper + lower);
        let ring = (1.0 - squared).sqrt();
        let sectors = 4 * parts(TAU * ring / (PI / bands as f64) / 4.0, 1.0);
        let share = 0.5 * (upper - lower) / sectors as f64;
        all.extend((0..sectors).map(|sector| (around(sector, sectors) * ring + Vector3::new(0.0, 0.0, height), share)));
    }
    all
}

/// Fills a box from `low` to `high` (m) with a lattice of about `spacing` (m) along each axis.
#[must_use]
pub fn lattice(low: Vector3<f64>, high: Vector3<f64>, spacing: [f64; 3], dimensions: usize) -> Vec<Seed> {
    let mut count = [1; 3];
    let mut step = Vector3::zeros();
    for axis in 0..dimensions {
        let length = high[axis] - low[axis];
        count[axis] = parts(length, spacing[axis]);
        step[axis] = length / count[axis] as f64;
    }
    let volume = step.iter().take(dimensions).product();
    let mut seeds = Vec::with_capacity(count.iter().product());
    for k in 0..count[2] {
        for j in 0..count[1] {
            for i in 0..count[0] {
                let middle = Vector3::new(i as f64 + 0.5, j as f64 + 0.5, k as f64 + 0.5);
                seeds.push(Seed { position: low + middle.component_mul(&step), volume });
            }
        }
    }
    seeds
}

/// Returns the surface of a disc, counter-clockwise. Tracers are at most `spacing` (m) apart, and their number is a
/// multiple of four. With `outward` = −1 the result is the surface of a hole, clockwise.
#[must_use]
pub fn circle(centre: Vector3<f64>, radius: f64, spacing: f64, outward: f64) -> Vec<Patch> {
    let count = 4 * (TAU * radius / spacing / 4.0).ceil().max(1.0) as usize;
    let length = TAU * radius / count as f64;
    let at = |number: usize| if outward < 0.0 { count - 1 - number } else { number };
    (0..count)
        .map(|number| around(at(number), count))
        .map(|direction| Patch { position: centre + direction * radius, area: direction * (length * outward) })
        .collect()
}

/// Returns the surface of a sphere, in elements with an area of about `spacing`² (m²).
#[must_use]
pub fn globe(centre: Vector3<f64>, radius: f64, spacing: f64) -> Vec<Patch> {
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
#[must_use]
pub fn rectangle(low: Vector3<f64>, high: Vector3<f64>, spacing: f64) -> Vec<Patch> {
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
#[must_use]
pub fn faces(low: Vector3<f64>, high: Vector3<f64>, spacing: f64) -> Vec<Patch> {
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

    fn moments(seeds: &[Seed]) -> (f64, Vector3<f64>, Vector3<f64>) {
        let mass = seeds.iter().map(|seed| seed.volume).sum();
        let centre = seeds.iter().map(|seed| seed.position * seed.volume).sum();
        let squares = seeds.iter().map(|seed| seed.position.component_mul(&seed.position) * seed.volume).sum();
        (mass, centre, squares)
    }

    /// Mass, centre and inertia are exact at any resolution.
    #[test]
    fn moments_are_exact() {
        for spacing in [0.5, 0.19, 0.04] {
            let (mass, centre, squares) = moments(&rings(Vector3::zeros(), 0.0, 1.0, spacing));
            assert!((mass / PI - 1.0).abs() < 1e-13 && centre.norm() < 1e-13);
            assert!((squares.x / (PI / 4.0) - 1.0).abs() < 1e-12 && (squares.y / (PI / 4.0) - 1.0).abs() < 1e-12);
            let (mass, centre, squares) = moments(&shells(Vector3::zeros(), 1.0, spacing));
            assert!((mass / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-13 && centre.norm() < 1e-12);
            assert!(squares.iter().all(|square| (square / (4.0 / 15.0 * PI) - 1.0).abs() < 1e-12), "{squares:?}");
        }
    }

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
