//! Positions and volumes of material points in bodies.
//!
//! Points of a disc are on rings, and points of a sphere on shells. Radius and latitude are chosen so that mass, centre
//! and inertia tensor of the body are exact. Points of a box are on a lattice that fits the box.

use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Initial position and volume of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seed {
    /// Position (m).
    pub(crate) position: Vector3<f64>,
    /// Volume (m³; m² in two dimensions).
    pub(crate) volume: f64,
}

/// Returns the number of parts of about `spacing` in `length`, at least one.
pub(crate) fn parts(length: f64, spacing: f64) -> usize {
    (length / spacing).round().max(1.0) as usize
}

/// Fills a disc, or the ring between two radii (m), with rings of a width of about `spacing` (m).
///
/// Points of a ring from r₁ to r₂ are at √((r₁² + r₂²)/2), which gives the exact moment of inertia of the ring.
pub(crate) fn rings(centre: Vector3<f64>, inner: f64, outer: f64, spacing: f64) -> Vec<Seed> {
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
pub(crate) fn around(sector: usize, sectors: usize) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos((sector as f64 + 0.5) * TAU / sectors as f64);
    Vector3::new(cosine, sine, 0.0)
}

/// Fills a sphere with shells of a thickness of about `spacing` (m).
///
/// Points of a shell from r₁ to r₂ are at the radius with r² = (3/5)(r₂⁵ − r₁⁵)/(r₂³ − r₁³). Points of a band between
/// two latitudes are at the root mean square of the band's height.
pub(crate) fn shells(centre: Vector3<f64>, radius: f64, spacing: f64) -> Vec<Seed> {
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
pub(crate) fn directions(bands: usize) -> Vec<(Vector3<f64>, f64)> {
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
pub(crate) fn lattice(low: Vector3<f64>, high: Vector3<f64>, spacing: [f64; 3], dimensions: usize) -> Vec<Seed> {
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
}
