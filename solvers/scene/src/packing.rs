//! Dense packings without overlap, from a seed. Grains of given sizes grow in a box, and overlapping grains are moved
//! apart.
//!
//! Grains start at random positions with half their size and grow in small stages. After each stage, overlapping pairs
//! are moved apart along their line of centres, one pair after the other. The displacements are inversely proportional
//! to the squared radii. The algorithm has no friction, so packings can be denser than packings of grains that come to
//! rest with friction.

use crate::dimension::Dimension;
use crate::near::near_pairs;
use crate::scene::Domain;
use nalgebra::Vector3;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::{BTreeSet, VecDeque};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Largest number of grains.
pub const MOST: u32 = 20_000;
/// Initial size, as a fraction of the full size.
const SMALL: f64 = 0.5;
const STAGES: u32 = 60;
const SWEEPS_PER_STAGE: u32 = 20;
/// Number of sweeps at full size after which a packing counts as impossible.
const SWEEPS: u32 = 40_000;
/// Number of visits of pairs and cells after which a packing counts as impossible. They take about a minute.
const VISITS: u64 = 10_000_000_000;
/// Number of visits counted per grain and class of radii when pairs are listed. It accounts for the visits of the cells
/// around the grain.
const VISITS_OF_A_GRAIN: u64 = 100;
/// Relative increase of the radii while the last overlaps are removed, so that the result has gaps.
const MARGIN: f64 = 1e-4;

/// Inputs of a packing as bits: radii, seed, domain, periodic axes, number of dimensions and `cut`.
type Recipe = (Vec<u64>, u64, [u64; 6], [bool; 3], usize, bool);
/// Packing in the cache. The first thread that needs it computes it.
type Place = Arc<OnceLock<Option<Vec<Vector3<f64>>>>>;
/// Largest number of packings in the cache. A packing takes at most half a megabyte.
const REMEMBERED: usize = 32;

/// Returns the centres (m) of grains of the given radii (m), in the same order, in `domain`. Grains do not overlap
/// images across periodic faces. Other faces are smooth walls; with `cut`, only the centres must lie within them, so that
/// grains may cross these faces. The result is `None` if overlaps remain, because the grains do not fit or need too much
/// work. The same seed gives the same packing on every machine.
///
/// Packings are cached, because variants and controls of a scene start from the same packing.
#[must_use]
pub fn pack(radii: &[f64], seed: u64, domain: &Domain, dimension: Dimension, cut: bool) -> Option<Vec<Vector3<f64>>> {
    static MADE: Mutex<VecDeque<(Recipe, Place)>> = Mutex::new(VecDeque::new());
    let bits = |at: usize| if at < 3 { domain.low[at] } else { domain.high[at - 3] }.to_bits();
    let recipe: Recipe = (
        radii.iter().map(|radius| radius.to_bits()).collect(),
        seed,
        std::array::from_fn(bits),
        domain.periodic,
        dimension.count(),
        cut,
    );
    let place = {
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let known = made.iter().find(|(known_recipe, _)| *known_recipe == recipe).map(|(_, place)| Arc::clone(place));
        known.unwrap_or_else(|| {
            let place = Place::default();
            made.push_back((recipe, Arc::clone(&place)));
            if made.len() > REMEMBERED {
                made.pop_front();
            }
            place
        })
    };
    place.get_or_init(|| made(radii, seed, domain, dimension, cut, SWEEPS, VISITS)).clone()
}

/// Returns the fraction of the domain that grains of these radii (m) would fill.
#[must_use]
pub fn filled(radii: impl Iterator<Item = f64>, domain: &Domain, dimension: Dimension) -> f64 {
    let axes = dimension.count();
    // Products of extreme lengths would overflow, but products of ratios do not.
    let part = |radius: f64| (0..axes).map(|axis| radius / (domain.high[axis] - domain.low[axis])).product::<f64>();
    let ball = if axes == 2 { PI } else { 4.0 / 3.0 * PI };
    ball * radii.map(part).sum::<f64>()
}

/// Returns a fraction of the domain that these grains can fill without overlap if all radii are reduced by the same
/// factor. A bisection in steps of a hundredth searches for a large fraction. The result is `None` if it would be below
/// one half. Each trial packing of the search may use a twentieth of the work of [`pack`].
#[must_use]
pub fn reachable(radii: &[f64], seed: u64, domain: &Domain, dimension: Dimension, cut: bool) -> Option<f64> {
    let asked = filled(radii.iter().copied(), domain, dimension);
    // Upper limit in percent. No packing of equal discs or spheres is denser (Thue, Hales). Packings of several sizes
    // may be slightly denser.
    let most: u32 = if dimension == Dimension::Two { 90 } else { 74 };
    if !asked.is_finite() {
        return None;
    }
    let can_be_packed = |percent: u32| {
        let part = f64::from(percent) / 100.0 / asked;
        let scale = if dimension == Dimension::Two { part.sqrt() } else { libm::cbrt(part) };
        let shrunk: Vec<f64> = radii.iter().map(|radius| radius * scale).collect();
        made(&shrunk, seed, domain, dimension, cut, SWEEPS / 20, VISITS / 20).is_some()
    };
    // Grains can be packed at `low` percent, or `low` is the initial value 49. The packing at `high` percent is too
    // dense.
    let (mut low, mut high) =
        (49, (50..=most).find(|percent| f64::from(*percent) / 100.0 >= asked).unwrap_or(most + 1));
    while high - low > 1 {
        let middle = u32::midpoint(low, high);
        if can_be_packed(middle) { low = middle } else { high = middle }
    }
    (low >= 50).then(|| f64::from(low) / 100.0)
}

/// Returns a random position in the box between two corners (m), with uniform probability.
pub(crate) fn random_position(
    generator: &mut impl Rng,
    low: Vector3<f64>,
    high: Vector3<f64>,
    axes: usize,
) -> Vector3<f64> {
    let mut position = Vector3::zeros();
    for axis in 0..axes {
        position[axis] = low[axis] + (high[axis] - low[axis]) * generator.random::<f64>();
    }
    position
}

fn made(
    radii: &[f64],
    seed: u64,
    domain: &Domain,
    dimension: Dimension,
    cut: bool,
    sweeps: u32,
    visits: u64,
) -> Option<Vec<Vector3<f64>>> {
    let axes = dimension.count();
    // No packing is tried if the filled fraction exceeds 1 or is not a number, because nearly all pairs would be
    // listed.
    if !(0.0..=1.0).contains(&filled(radii.iter().copied(), domain, dimension)) {
        return None;
    }
    let mut generator = Pcg64::seed_from_u64(seed);
    let centres = radii.iter().map(|_| random_position(&mut generator, domain.low, domain.high, axes)).collect();
    let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let mut packing = Packing {
        radii,
        scale: SMALL,
        centres,
        domain,
        axes,
        cut,
        pairs: Vec::new(),
        listed: Vec::new(),
        skin: smallest,
        classes: classes(radii),
        visits,
    };
    for stage in 1..=STAGES {
        packing.scale = SMALL + (1.0 - SMALL) * f64::from(stage) / f64::from(STAGES);
        packing.list();
        for _ in 0..SWEEPS_PER_STAGE {
            if packing.visits == 0 {
                return None;
            }
            if packing.sweep() == 0.0 {
                break;
            }
        }
    }
    packing.scale = 1.0 + MARGIN;
    packing.list();
    let is_done = (0..sweeps).any(|_| packing.visits == 0 || packing.sweep() < MARGIN * smallest && packing.is_free());
    (is_done && packing.visits > 0).then_some(packing.centres)
}

/// Returns the number of classes of radii. The radii of a class lie within a factor of two.
fn classes(radii: &[f64]) -> u64 {
    radii.iter().map(|radius| libm::ilogb(*radius)).collect::<BTreeSet<_>>().len() as u64
}

struct Packing<'a> {
    radii: &'a [f64],
    /// Present size over full size.
    scale: f64,
    centres: Vec<Vector3<f64>>,
    domain: &'a Domain,
    axes: usize,
    /// True if only the centres must lie within the non-periodic faces.
    cut: bool,
    /// Pairs whose gap was below `skin` when they were listed.
    pairs: Vec<(u32, u32)>,
    /// Centres (m) at the time when the pairs were listed.
    listed: Vec<Vector3<f64>>,
    /// Largest gap of listed pairs (m).
    skin: f64,
    /// Number of classes of radii.
    classes: u64,
    /// Remaining number of visits of pairs and cells.
    visits: u64,
}

impl Packing<'_> {
    /// Returns the vector (m) from the centre of b, or its nearest periodic image, to the centre of a.
    fn between(&self, a: usize, b: usize) -> Vector3<f64> {
        self.nearest_image(self.centres[a] - self.centres[b])
    }

    fn nearest_image(&self, mut apart: Vector3<f64>) -> Vector3<f64> {
        for axis in (0..self.axes).filter(|&axis| self.domain.periodic[axis]) {
            let length = self.domain.high[axis] - self.domain.low[axis];
            apart[axis] -= length * (apart[axis] / length).round();
        }
        apart
    }

    /// Lists the pairs whose gap is below `skin`.
    fn list(&mut self) {
        let radii: Vec<f64> = self.radii.iter().map(|radius| radius * self.scale).collect();
        let (mut pairs, mut seen) = (Vec::new(), 0);
        let _ = near_pairs(&self.centres, &radii, self.skin, Some(self.domain), |a, b| {
            seen += 1;
            let touch = (self.radii[a] + self.radii[b]) * self.scale + self.skin;
            if self.between(a, b).norm_squared() < touch * touch {
                pairs.push((a.min(b) as u32, a.max(b) as u32));
            }
            ControlFlow::Continue(())
        });
        self.visits = self.visits.saturating_sub(seen + VISITS_OF_A_GRAIN * self.classes * radii.len() as u64);
        // The order of the pairs affects the result.
        pairs.sort_unstable();
        pairs.dedup();
        self.pairs = pairs;
        self.listed.clone_from(&self.centres);
    }

    /// Returns true if no pair overlaps at full size.
    fn is_free(&self) -> bool {
        self.pairs.iter().all(|&(a, b)| {
            let (a, b) = (a as usize, b as usize);
            self.between(a, b).norm() >= self.radii[a] + self.radii[b]
        })
    }

    /// Moves overlapping grains apart, and moves grains into the domain. Returns the largest overlap found (m).
    fn sweep(&mut self) -> f64 {
        let mut worst: f64 = 0.0;
        self.visits = self.visits.saturating_sub((self.pairs.len() + self.radii.len()) as u64);
        for at in 0..self.pairs.len() {
            let (a, b) = (self.pairs[at].0 as usize, self.pairs[at].1 as usize);
            let apart = self.between(a, b);
            let (distance, touch) = (apart.norm(), (self.radii[a] + self.radii[b]) * self.scale);
            let overlap = touch - distance;
            if overlap <= 0.0 {
                continue;
            }
            worst = worst.max(overlap);
            let along = if distance > 0.0 { apart / distance } else { Vector3::x() };
            let (small, large) = (self.radii[b] * self.radii[b], self.radii[a] * self.radii[a]);
            let share = small / (small + large);
            self.centres[a] += along * (overlap * share);
            self.centres[b] -= along * (overlap * (1.0 - share));
        }
        for axis in 0..self.axes {
            let (low, high) = (self.domain.low[axis], self.domain.high[axis]);
            for (centre, radius) in self.centres.iter_mut().zip(self.radii) {
                let place = &mut centre[axis];
                if self.domain.periodic[axis] {
                    *place = low + (*place - low).rem_euclid(high - low);
                } else {
                    let margin = if self.cut { 0.0 } else { radius * self.scale };
                    worst = worst.max(low + margin - *place).max(*place + margin - high);
                    *place = place.min(high - margin).max(low + margin);
                }
            }
        }
        let limit = 0.25 * self.skin * self.skin;
        let moved = |(now, then): (&Vector3<f64>, &Vector3<f64>)| self.nearest_image(now - then).norm_squared() > limit;
        if self.centres.iter().zip(&self.listed).any(moved) {
            self.list();
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain(length: f64, periodic: bool) -> Domain {
        let high = Vector3::new(length, length, 0.5);
        Domain { low: Vector3::new(0.0, 0.0, -0.5), high, periodic: [periodic, periodic, false] }
    }

    fn radii(count: u32) -> Vec<f64> {
        (0..count).map(|number| 1.0 + f64::from(number % 7) / 3.0).collect()
    }

    /// Returns the edge (m) of a square in which discs of the given radii (m) fill the given fraction.
    fn edge(radii: &[f64], fraction: f64) -> f64 {
        (PI * radii.iter().map(|radius| radius * radius).sum::<f64>() / fraction).sqrt()
    }

    #[test]
    fn packs_densely_without_overlap() {
        let radii = radii(150);
        for (fraction, periodic) in [(0.82, true), (0.78, false)] {
            let length = edge(&radii, fraction);
            let domain = domain(length, periodic);
            let centres = pack(&radii, 3, &domain, Dimension::Two, false).unwrap_or_default();
            assert_eq!(centres.len(), radii.len());
            for a in 0..radii.len() {
                for b in 0..a {
                    let mut apart = centres[a] - centres[b];
                    if periodic {
                        apart.iter_mut().for_each(|part| *part -= length * (*part / length).round());
                    }
                    assert!(apart.norm() > (radii[a] + radii[b]) * (1.0 - 1e-12));
                }
                if !periodic {
                    let inside = |place: f64| place > radii[a] - 1e-6 && place < length - radii[a] + 1e-6;
                    assert!(inside(centres[a].x) && inside(centres[a].y));
                }
            }
            assert_eq!(Some(centres), pack(&radii, 3, &domain, Dimension::Two, false));
        }
    }

    #[test]
    fn more_than_fits_is_not_packed() {
        for fraction in [0.9, 1.1, 100.0] {
            let edge = edge(&radii(60), fraction);
            assert_eq!(pack(&radii(60), 1, &domain(edge, false), Dimension::Two, false), None, "{fraction}");
        }
    }

    /// Extreme radii and boxes are rejected. The search for a packing of grains of many sizes ends after its number of
    /// visits.
    #[test]
    fn absurd_grains_end_the_search() {
        let far = domain(1e200, false);
        assert_eq!(pack(&vec![1e200; 3000], 1, &far, Dimension::Two, false), None);
        assert_eq!(pack(&vec![f64::MAX; 3000], 1, &domain(1e-200, true), Dimension::Two, false), None);
        let many: Vec<f64> = (0..5000).map(|number| libm::pow(2.0, -f64::from(number % 900))).collect();
        let edge = edge(&many, 0.9);
        assert_eq!(made(&many, 1, &domain(edge, false), Dimension::Two, false, SWEEPS, 20_000_000), None);
    }

    /// Grains can be packed at the fraction that `reachable` returns, and this packing is dense.
    #[test]
    fn what_is_reachable_can_be_packed() {
        for asked in [0.9, 100.0] {
            let domain = domain(edge(&radii(60), asked), false);
            let share = reachable(&radii(60), 1, &domain, Dimension::Two, false).unwrap_or_default();
            assert!((0.7..0.9).contains(&share), "{share}");
            let shrunk: Vec<f64> = radii(60).iter().map(|radius| radius * (share / asked).sqrt()).collect();
            assert!(pack(&shrunk, 1, &domain, Dimension::Two, false).is_some());
        }
    }

    /// The cache key contains all inputs of a packing.
    #[test]
    fn another_recipe_is_another_packing() {
        let all = radii(60);
        let wide = domain(edge(&all, 0.6), true);
        let first = pack(&all, 1, &wide, Dimension::Two, false);
        assert!(first.is_some() && first == pack(&all, 1, &wide, Dimension::Two, false));
        let shorter = Domain { high: wide.high - Vector3::new(1e-9, 0.0, 0.0), ..wide };
        let walled = domain(edge(&all, 0.6), false);
        for other in [
            pack(&all, 2, &wide, Dimension::Two, false),
            pack(&all, 1, &shorter, Dimension::Two, false),
            pack(&all, 1, &walled, Dimension::Two, false),
            pack(&all, 1, &walled, Dimension::Two, true),
        ] {
            assert!(other.is_some() && other != first);
        }
        assert_ne!(pack(&all, 1, &walled, Dimension::Two, false), pack(&all, 1, &walled, Dimension::Two, true));
    }
}
