//! Finding the material points around a place of the plane.

use crate::grid::inside;
use grainbench_scene::record::{Owner, PointState, Snapshot};
use nalgebra::Vector3;

/// A place belongs to the material of a point that is nearer than this, in widths √V of the point's square: half a
/// diagonal, and a little for squares that have sheared.
const REACH: f64 = 0.85;
/// Points within this many of their widths share in the value at a place.
const BLUR: f64 = 1.3;

/// Bins along an axis, however far a stray point has flown.
const MOST_BINS: f64 = 1024.0;

/// The material points of a plane snapshot, sorted into square bins.
pub struct PointCloud<'a> {
    snapshot: &'a Snapshot,
    /// Places within the domain (m).
    places: Vec<[f64; 2]>,
    /// Widths √V of their squares (m).
    widths: Vec<f64>,
    low: [f64; 2],
    bin: [f64; 2],
    count: [usize; 2],
    /// Points of every bin.
    bins: Vec<Vec<u32>>,
}

impl<'a> PointCloud<'a> {
    /// Of all points of a snapshot.
    #[must_use]
    pub fn new(snapshot: &'a Snapshot) -> Self {
        let place = |point: &PointState| {
            let place = inside(snapshot, point.position);
            [place.x, place.y]
        };
        let places: Vec<[f64; 2]> = snapshot.points.iter().map(place).collect();
        let widths: Vec<f64> = snapshot.points.iter().map(|point| point.volume.sqrt()).collect();
        let widest = widths.iter().copied().filter(|width| width.is_finite()).fold(f64::MIN_POSITIVE.sqrt(), f64::max);
        let width = BLUR * widest;
        let (mut low, mut count, mut bin) = ([0.0; 2], [1; 2], [1.0; 2]);
        for axis in 0..2 {
            let (mut from, mut to) = (snapshot.bounds.0[axis], snapshot.bounds.1[axis]);
            if !snapshot.periodic[axis] {
                from = places.iter().map(|place| place[axis]).fold(f64::INFINITY, f64::min) - width;
                to = places.iter().map(|place| place[axis]).fold(f64::NEG_INFINITY, f64::max) + width;
            }
            count[axis] = ((to - from) / width).floor().clamp(1.0, MOST_BINS) as usize;
            (low[axis], bin[axis]) = (from, (to - from) / count[axis] as f64);
        }
        let mut cloud = Self { snapshot, places, widths, low, bin, count, bins: vec![Vec::new(); count[0] * count[1]] };
        for at in 0..cloud.places.len() {
            if let [Some(i), Some(j)] = [0, 1].map(|axis| cloud.bin_of(axis, cloud.places[at][axis], 0)) {
                cloud.bins[i + count[0] * j].push(at as u32);
            }
        }
        cloud
    }

    /// The bin of a place along an axis, or the one `beside` it.
    fn bin_of(&self, axis: usize, place: f64, beside: isize) -> Option<usize> {
        let count = self.count[axis] as isize;
        let bin = ((place - self.low[axis]) / self.bin[axis]).floor();
        if !(-1.0..=count as f64).contains(&bin) {
            return None;
        }
        let bin = bin as isize + beside;
        if self.snapshot.periodic[axis] {
            return Some(bin.rem_euclid(count) as usize);
        }
        (0..count).contains(&bin).then_some(bin as usize)
    }

    /// Distance along an axis, around a periodic domain the shorter way (m).
    fn apart(&self, axis: usize, from: f64, to: f64) -> f64 {
        let away = to - from;
        if self.snapshot.periodic[axis] {
            let length = self.snapshot.bounds.1[axis] - self.snapshot.bounds.0[axis];
            away - (away / length).round() * length
        } else {
            away
        }
    }

    /// The body at a place, and its material there: the mean of its points around, the nearest counting most.
    #[must_use]
    pub fn at(&self, place: [f64; 2]) -> Option<(Owner, PointState)> {
        let mut near: Vec<(f64, u32)> = Vec::with_capacity(32);
        let along = |axis: usize| [-1, 0, 1].map(|beside| self.bin_of(axis, place[axis], beside));
        let (columns, rows) = (distinct(along(0)), distinct(along(1)));
        for &j in rows.iter().flatten() {
            for &i in columns.iter().flatten() {
                for &at in &self.bins[i + self.count[0] * j] {
                    let there = self.places[at as usize];
                    let [across, up] = [0, 1].map(|axis| self.apart(axis, place[axis], there[axis]));
                    let distance = (across * across + up * up).sqrt() / self.widths[at as usize];
                    if distance < BLUR {
                        near.push((distance, at));
                    }
                }
            }
        }
        let &(distance, nearest) = near.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let owner = self.snapshot.points[nearest as usize].owner;
        if distance >= REACH {
            return None;
        }
        let mut sum = PointState {
            position: Vector3::new(place[0], place[1], 0.0),
            displacement: Vector3::zeros(),
            velocity: Vector3::zeros(),
            stress: [0.0; 6],
            plastic_strain: 0.0,
            rotation: 0.0,
            ..self.snapshot.points[nearest as usize]
        };
        let mut total = 0.0;
        for (distance, at) in near {
            let point = &self.snapshot.points[at as usize];
            if point.owner != owner {
                continue;
            }
            let weight = (1.0 - distance / BLUR).powi(2);
            total += weight;
            sum.displacement += point.displacement * weight;
            sum.velocity += point.velocity * weight;
            sum.stress.iter_mut().zip(point.stress).for_each(|(sum, stress)| *sum += stress * weight);
            sum.plastic_strain += point.plastic_strain * weight;
            sum.rotation += point.rotation * weight;
        }
        sum.displacement /= total;
        sum.velocity /= total;
        sum.stress.iter_mut().for_each(|stress| *stress /= total);
        sum.plastic_strain /= total;
        sum.rotation /= total;
        Some((owner, sum))
    }
}

/// In a domain of one or two bins a neighbour may be met twice.
fn distinct(mut bins: [Option<usize>; 3]) -> [Option<usize>; 3] {
    if bins[0] == bins[1] || bins[0] == bins[2] {
        bins[0] = None;
    }
    if bins[2] == bins[1] {
        bins[2] = None;
    }
    bins
}
