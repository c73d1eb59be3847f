//! Generation of grains on lattices and at random positions from a seed.

use crate::dimension::Dimension;
use crate::near::images;
use crate::packing::{filled, random_position};
use crate::radii::Radii;
use crate::scene::Domain;
use nalgebra::Vector3;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::cell::Cell;

/// Returns the centres of a square or simple-cubic lattice (m); x varies fastest.
#[must_use]
pub fn lattice(origin: Vector3<f64>, spacing: Vector3<f64>, count: [u32; 3]) -> Vec<Vector3<f64>> {
    let mut centres = Vec::new();
    for k in 0..count[2] {
        for j in 0..count[1] {
            for i in 0..count[0] {
                let steps = Vector3::new(f64::from(i), f64::from(j), f64::from(k));
                centres.push(origin + spacing.component_mul(&steps));
            }
        }
    }
    centres
}

/// Returns the centres of a close-packed lattice (m). Rows lie along x, and every second row is shifted by half the
/// spacing. In three dimensions, the grains of each layer lie above the hollows of the layer below. The fourth layer
/// lies exactly above the first (face-centred cubic).
#[must_use]
pub fn close_packed(origin: Vector3<f64>, spacing: f64, count: [u32; 3]) -> Vec<Vector3<f64>> {
    let row = spacing * 0.75_f64.sqrt();
    let mut centres = lattice(Vector3::zeros(), Vector3::new(1.0, 1.0, 1.0), count);
    for centre in &mut centres {
        let [i, j, k] = [centre.x, centre.y, centre.z];
        let layer = k % 3.0;
        let along = i + 0.5 * ((j + layer) % 2.0);
        let shifted = Vector3::new(spacing * along, row * (j + layer / 3.0), spacing * (2.0 / 3.0_f64).sqrt() * k);
        *centre = origin + shifted;
    }
    centres
}

/// Displaces each position by a random vector from a disc or ball of radius `most` (m), with uniform probability.
pub fn perturb(places: &mut [Vector3<f64>], most: f64, seed: u64, dimension: Dimension) {
    let mut generator = Pcg64::seed_from_u64(seed);
    for place in places {
        let share: f64 = generator.random();
        let size = most * if dimension == Dimension::Two { share.sqrt() } else { libm::cbrt(share) };
        *place += direction(&mut generator, dimension) * size;
    }
}

/// Randomly placed grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedGrain {
    /// Centre (m).
    pub position: Vector3<f64>,
    /// Radius (m).
    pub radius: f64,
    /// Velocity (m/s), of the given speed in a random direction.
    pub velocity: Vector3<f64>,
}

/// Number of visits of spheres and cells after which the search for room ends. These visits take about a minute.
const VISITS: u64 = 20_000_000_000;

/// Reason why grains could not be placed at random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoRoom {
    /// Fraction of the domain that all grains would fill.
    pub share: f64,
    /// True if the search needs too much work; false if 10,000 tries found no room for a grain.
    pub is_costly: bool,
}

/// Places `count` grains without overlap in `domain`, large grains first. Grains do not cross the faces of axes that
/// are not periodic. The same seed gives the same grains on every machine.
///
/// # Errors
/// When 10,000 tries find no room for a grain, or the search needs too much work.
pub fn random(
    count: u32,
    seed: u64,
    radii: &Radii,
    speed: f64,
    domain: &Domain,
    dimension: Dimension,
) -> Result<Vec<PlacedGrain>, NoRoom> {
    random_within(VISITS, (count, seed), radii, speed, domain, dimension)
}

fn random_within(
    most: u64,
    (count, seed): (u32, u64),
    radii: &Radii,
    speed: f64,
    domain: &Domain,
    dimension: Dimension,
) -> Result<Vec<PlacedGrain>, NoRoom> {
    const TRIES: u32 = 10_000;
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut sizes: Vec<f64> = (0..count).map(|_| radii.draw(&mut generator)).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    let cell = 2.0 * radii.largest();
    let mut taken = PlacedSpheres::new(cell, sizes.len(), dimension);
    let mut placed = Vec::with_capacity(sizes.len());
    for &radius in &sizes {
        let position = (0..TRIES).take_while(|_| taken.visits.get() < most).find_map(|_| {
            let centre = somewhere(&mut generator, radius, domain, dimension);
            // Most positions are not free, so periodic images are tested only if the position itself is free. An image at
            // least one cell width outside the domain overlaps nothing.
            let is_free = taken.is_free(centre, radius)
                && images(centre, Some(domain), cell)[1..].iter().all(|&image| taken.is_free(image, radius));
            is_free.then_some(centre)
        });
        let position = position.ok_or_else(|| NoRoom {
            share: filled(sizes.iter().copied(), domain, dimension),
            is_costly: taken.visits.get() >= most,
        })?;
        taken.add(position, radius);
        let velocity = direction(&mut generator, dimension) * speed;
        placed.push(PlacedGrain { position, radius, velocity });
    }
    Ok(placed)
}

fn somewhere(generator: &mut impl Rng, radius: f64, domain: &Domain, dimension: Dimension) -> Vector3<f64> {
    let margin = Vector3::from(domain.periodic.map(|is_periodic| if is_periodic { 0.0 } else { radius }));
    random_position(generator, domain.low + margin, domain.high - margin, dimension.count())
}

fn direction(generator: &mut impl Rng, dimension: Dimension) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * generator.random::<f64>());
    match dimension {
        Dimension::Two => Vector3::new(cosine, sine, 0.0),
        Dimension::Three => {
            let height = 2.0 * generator.random::<f64>() - 1.0;
            let across = (1.0 - height * height).sqrt();
            Vector3::new(across * cosine, across * sine, height)
        }
    }
}

/// Spheres placed so far, in a hash table of cells. A cell is as wide as the largest diameter. Distant cells may share
/// a bucket. This costs additional distance tests, but no overlap is missed.
struct PlacedSpheres {
    /// Edge of a cell (m).
    cell: f64,
    /// Number of layers of cells along z that are searched: 1 in the plane, 3 in space.
    layers: usize,
    /// Centre (m) and radius (m) of the spheres in each bucket.
    buckets: Vec<Vec<(Vector3<f64>, f64)>>,
    /// Number of cells and spheres visited so far.
    visits: Cell<u64>,
}

impl PlacedSpheres {
    fn new(cell: f64, most: usize, dimension: Dimension) -> Self {
        let layers = if dimension == Dimension::Two { 1 } else { 3 };
        Self { cell, layers, buckets: vec![Vec::new(); most.next_power_of_two()], visits: Cell::new(0) }
    }

    /// Returns the cell of a position along each axis.
    fn cell_of(&self, place: Vector3<f64>) -> [i64; 3] {
        [0, 1, 2].map(|axis| (place[axis] / self.cell).floor() as i64)
    }

    /// Returns the bucket of a cell. Products with large primes spread adjacent cells over the buckets.
    fn bucket(&self, cell: [i64; 3]) -> usize {
        const PRIMES: [i64; 3] = [0x9e37_79b1, 0x85eb_ca77, 0xc2b2_ae3d];
        let mixed = (0..3).fold(0, |mixed: i64, axis| mixed ^ cell[axis].wrapping_mul(PRIMES[axis]));
        (mixed ^ (mixed >> 15)) as usize & (self.buckets.len() - 1)
    }

    fn add(&mut self, centre: Vector3<f64>, radius: f64) {
        let bucket = self.bucket(self.cell_of(centre));
        self.buckets[bucket].push((centre, radius));
    }

    fn is_free(&self, centre: Vector3<f64>, radius: f64) -> bool {
        let cell = self.cell_of(centre);
        // Cells along each axis: the cell itself and the nearer of its neighbours come first, because most overlaps
        // occur there. For very large coordinates, the limits keep the indices in range.
        let [i, j, k] = [0, 1, 2].map(|axis| {
            let at = cell[axis].clamp(i64::MIN + 1, i64::MAX - 1);
            let nearer = if centre[axis] / self.cell - (at as f64) < 0.5 { -1 } else { 1 };
            [at, at + nearer, at - nearer]
        });
        k[..self.layers]
            .iter()
            .all(|&k| j.iter().all(|&j| i.iter().all(|&i| !self.overlaps_in([i, j, k], centre, radius))))
    }

    /// Returns true if a sphere overlaps one of the spheres in the bucket of a cell.
    fn overlaps_in(&self, cell: [i64; 3], centre: Vector3<f64>, radius: f64) -> bool {
        // The first comparison excludes most spheres without a square root.
        const ROUNDING: f64 = 1.0 + 1e-12;
        let spheres = &self.buckets[self.bucket(cell)];
        self.visits.update(|visits| visits + 1 + spheres.len() as u64);
        spheres.iter().any(|(other, size)| {
            let (between, reach) = (centre - other, radius + size);
            between.norm_squared() <= reach * reach * ROUNDING && between.norm() < reach
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The work of a search is bounded. The error distinguishes too much work from a lack of room.
    #[test]
    fn a_costly_search_ends() {
        let high = Vector3::new(1.0, 1.0, 0.5);
        let domain = Domain { low: Vector3::new(0.0, 0.0, -0.5), high, periodic: [false; 3] };
        let placed =
            |most, radius| random_within(most, (200, 1), &Radii::Uniform([radius; 2]), 0.0, &domain, Dimension::Two);
        assert!(placed(1_000_000, 0.01).is_ok());
        assert!(placed(1000, 0.01).is_err_and(|error| error.is_costly && (error.share - 0.0628).abs() < 1e-4));
        assert!(placed(VISITS, 0.1).is_err_and(|error| !error.is_costly));
    }

    /// Each grain has six nearest neighbours in the plane and twelve in space, one spacing away.
    #[test]
    fn close_packed_grains_touch_their_neighbours() {
        for (count, neighbours) in [([7, 7, 1], 6), ([7, 7, 7], 12)] {
            let centres = close_packed(Vector3::new(1.0, 2.0, 3.0), 2.0, count);
            let middle = centres[(count[0] * count[1] * (count[2] / 2) + 3 * count[0] + 3) as usize];
            let mut distances: Vec<f64> = centres.iter().map(|centre| (centre - middle).norm()).collect();
            distances.sort_by(f64::total_cmp);
            assert!(distances[0] == 0.0 && (distances[1] - 2.0).abs() < 1e-12, "{:?}", &distances[..3]);
            assert_eq!(distances.iter().filter(|distance| (*distance - 2.0).abs() < 1e-12).count(), neighbours);
        }
    }

    #[test]
    fn perturbed_centres_stay_near() {
        let whole = lattice(Vector3::zeros(), Vector3::repeat(1.0), [10, 10, 1]);
        let mut moved = whole.clone();
        perturb(&mut moved, 0.1, 3, Dimension::Two);
        let distances: Vec<f64> = whole.iter().zip(&moved).map(|(a, b)| (a - b).norm()).collect();
        assert!(distances.iter().all(|distance| (0.0..=0.1).contains(distance)));
        // For a uniform distribution over a disc, the mean distance is two thirds of the radius.
        let mean = distances.iter().sum::<f64>() / 100.0;
        assert!((mean - 0.0667).abs() < 0.006, "{mean}");
        assert!(moved.iter().all(|centre| centre.z == 0.0));
    }
}
