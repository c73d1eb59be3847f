//! Tracers: massless points on the surface of bodies. They move with the velocity of the grid.

use crate::points::body::Body;
use crate::points::share::{NO_BOX, enclose};
use crate::surface::elements;
use grainbench_lanes::take_off;
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// Tracers of all bodies, as a structure of arrays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tracers<S: Space> {
    /// Position (m).
    pub(crate) position: Vec<S::Vector>,
    /// Area times outward unit normal (m²; m in two dimensions).
    pub(crate) area: Vec<S::Vector>,
    /// In two dimensions, the previous and the next tracer along the surface.
    pub(crate) neighbours: Vec<[u32; 2]>,
    /// Chunks of tracers with their bounding boxes.
    pub(crate) chunks: Vec<Chunk<S>>,
}

/// Chunk of consecutive tracers, with its bounding box.
#[derive(Clone, Debug)]
pub(crate) struct Chunk<S: Space> {
    pub(crate) tracers: Range<usize>,
    low: S::Vector,
    high: S::Vector,
}

impl<S: Space> Chunk<S> {
    /// Computes the bounding box of the chunk from the positions of its tracers.
    #[inline(always)]
    pub(super) fn enclose(&mut self, positions: &[S::Vector]) {
        [self.low, self.high] = enclose::<S>(NO_BOX, positions).map(|[x, y, z]| S::restrict(Vector3::new(x, y, z)));
    }

    /// Returns true if the box of the chunk intersects another box.
    #[inline(always)]
    pub(crate) fn meets(&self, low: S::Vector, high: S::Vector) -> bool {
        (0..S::DIMENSION).all(|axis| {
            let at = |vector: S::Vector| S::component(vector, axis);
            at(self.low) <= at(high) && at(low) <= at(self.high)
        })
    }

    /// Returns the squared distance between the box of the chunk and another box (m²).
    #[inline(always)]
    fn away(&self, [low, high]: [S::Vector; 2]) -> f64 {
        let mut squared = 0.0;
        for axis in 0..S::DIMENSION {
            let at = |vector: S::Vector| S::component(vector, axis);
            let beyond = (at(self.low) - at(high)).max(at(low) - at(self.high)).max(0.0);
            squared += beyond * beyond;
        }
        squared
    }
}

/// Surface of a body near a position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearSurface<S: Space> {
    /// Distance above the surface (m), negative inside.
    pub(crate) gap: f64,
    /// Outward unit normal of the body.
    pub(crate) normal: S::Vector,
}

/// Number of tracers in a chunk.
const RUN: usize = 16;

/// Radius of the mean over tracers in three dimensions, in units of the tracer spacing. About twelve tracers
/// contribute.
const SPREAD: f64 = 2.0;

/// Cosine between the normals of two surfaces above which they do not face each other.
const FACING: f64 = -0.2;

impl<S: Space> Tracers<S> {
    /// Memory of a tracer with its share of a chunk (bytes).
    pub(crate) const BYTES: usize =
        2 * size_of::<S::Vector>() + size_of::<[u32; 2]>() + size_of::<Chunk<S>>().div_ceil(RUN);

    pub(crate) fn len(&self) -> usize {
        self.position.len()
    }

    /// Returns a mutable view of all tracers.
    pub(crate) fn lent(&mut self) -> TracersMut<'_, S> {
        let Self { position, area, neighbours, chunks } = self;
        TracersMut { first: 0, position, area, neighbours, chunks }
    }

    /// Adds a closed surface. In two dimensions the elements are ordered with the body on their left.
    pub(crate) fn add(&mut self, patches: &[elements::Patch]) {
        let (start, count) = (self.len() as u32, patches.len() as u32);
        for (number, patch) in (0..count).zip(patches) {
            self.position.push(S::restrict(patch.position));
            self.area.push(S::restrict(patch.area));
            self.neighbours.push([start + (number + count - 1) % count, start + (number + 1) % count]);
        }
    }

    /// Splits the tracers of the body that was added last into chunks, and returns the indices of the chunks.
    pub(crate) fn cut(&mut self, tracers: Range<usize>) -> Range<usize> {
        let first = self.chunks.len();
        let ranges = tracers.clone().step_by(RUN).map(|start| start..(start + RUN).min(tracers.end));
        self.chunks.extend(ranges.map(|tracers| Chunk { tracers, low: S::ORIGIN, high: S::ORIGIN }));
        first..self.chunks.len()
    }

    /// Computes the boxes of all chunks from the positions of tracers.
    pub(crate) fn find_boxes(&mut self) {
        self.chunks.iter_mut().for_each(|chunk| chunk.enclose(&self.position[chunk.tracers.clone()]));
    }

    /// Returns the bounding box of a box and of some chunks (m).
    pub(crate) fn enclose_runs(&self, runs: Range<usize>, around: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
        self.chunks[runs].iter().fold(around, |around, chunk| enclose::<S>(around, &[chunk.low, chunk.high]))
    }

    /// Returns the outward unit normal at a tracer.
    #[inline(always)]
    pub(crate) fn normal(&self, at: usize) -> S::Vector {
        unit::<S>(self.area[at])
    }

    /// Finds the chunks that can contain the tracer nearest to any tracer of the chunk `searched`. The box of `searched`
    /// is first moved by `shift` (m).
    #[inline(always)]
    pub(crate) fn find_near(
        &self,
        searched: &Chunk<S>,
        shift: S::Vector,
        chunks: &Range<usize>,
        reach: f64,
        near: &mut Vec<usize>,
    ) {
        let moved = [searched.low + shift, searched.high + shift];
        let is_near = |chunk: &usize| S::DIMENSION == 3 || self.chunks[*chunk].away(moved) < 2.0 * reach * reach;
        near.clear();
        // In three dimensions the mean over tracers extends farther than the nearest tracer.
        near.extend(chunks.clone().filter(is_near));
    }

    /// Returns the surface near a position that has penetrated it. The surface consists of the tracers of some chunks.
    ///
    /// `facing` is an outward vector of any length at the position. Returns `None` if the position is outside, does not
    /// face the surface, or is farther than `reach` (m) from it.
    ///
    /// On entry, `closest` is the tracer of these chunks nearest to the previous position. On return, it is the tracer
    /// nearest to this position. Neighbouring positions have neighbouring nearest tracers, so `closest` limits the
    /// search radius. The result does not depend on `closest`.
    #[inline(always)]
    pub(crate) fn gone_through(
        &self,
        chunks: impl Iterator<Item = usize> + Clone,
        position: S::Vector,
        facing: S::Vector,
        reach: f64,
        closest: &mut Option<usize>,
    ) -> Option<NearSurface<S>> {
        let distance_to = |at: usize| {
            let between = position - self.position[at];
            S::dot(between, between)
        };
        let faces = |at: usize| S::dot(self.area[at], facing) < 0.0;
        let mut squared = 2.0 * reach * reach;
        if let Some(before) = closest.take().filter(|&before| faces(before)) {
            squared = squared.min(distance_to(before).next_up());
        }
        for chunk in chunks.clone().map(|chunk| &self.chunks[chunk]) {
            if chunk.away([position; 2]) >= squared {
                continue;
            }
            for at in chunk.tracers.clone() {
                let distance = distance_to(at);
                if distance < squared && faces(at) {
                    (*closest, squared) = (Some(at), distance);
                }
            }
        }
        let closest = (*closest)?;
        if self.is_above(closest, position) {
            return None;
        }
        let near = if S::DIMENSION == 2 {
            let [before, after] = self.neighbours[closest].map(|neighbour| neighbour as usize);
            let [one, two] = [self.chord(before, closest, position), self.chord(closest, after, position)];
            if S::dot(one.off, one.off) <= S::dot(two.off, two.off) { self.on(&one) } else { self.on(&two) }
        } else {
            self.around(chunks, closest, position, facing)?
        };
        let faces = S::dot(near.normal, unit::<S>(facing)) < FACING;
        (faces && near.gap <= 0.0 && -near.gap < reach).then_some(near)
    }

    /// Returns true if a position is certainly outside, because its height over the nearest tracer exceeds the tracer
    /// spacing.
    #[inline(always)]
    fn is_above(&self, closest: usize, position: S::Vector) -> bool {
        let area = self.area[closest];
        let squared = S::dot(area, area);
        let spacing = if S::DIMENSION == 2 { 1.0 } else { 1.0 / squared.sqrt().sqrt() };
        S::dot(position - self.position[closest], area) > squared * spacing
    }

    /// Returns the surface near a position x in three dimensions, where tracers have no neighbours.
    ///
    /// The sums are over tracers at positions y with normals n that face the given normal, with weights w = a (1 −
    /// r²/H²)². Here a is the area of a tracer, and r its distance from the foot of x on the tangent plane of the
    /// nearest tracer. H is [`SPREAD`] times the spacing of tracers. The normal is n̄ = Σ w n/|Σ w n|, and the gap is Σ
    /// w (x − y)·(n̄ + n)/2 / Σ w. This is exact on planes, and on spheres at zero gap, where x − y is perpendicular to
    /// the sum of the normals. Returns `None` if the foot is beside the surface.
    #[inline(always)]
    fn around(
        &self,
        chunks: impl Iterator<Item = usize>,
        nearest: usize,
        position: S::Vector,
        facing: S::Vector,
    ) -> Option<NearSurface<S>> {
        let (middle, normal) = (self.position[nearest], self.normal(nearest));
        let foot = position - normal * S::dot(position - middle, normal);
        let area = S::dot(self.area[nearest], self.area[nearest]).sqrt();
        let squared = SPREAD * SPREAD * area;
        let beside = foot - middle;
        if S::dot(beside, beside) > area {
            return None;
        }
        let (mut total, mut mean, mut way, mut along) = (0.0, S::ORIGIN, S::ORIGIN, 0.0);
        for chunk in chunks.map(|chunk| &self.chunks[chunk]) {
            if chunk.away([foot; 2]) >= squared {
                continue;
            }
            for at in chunk.tracers.clone() {
                let beside = foot - self.position[at];
                let distance = S::dot(beside, beside);
                if distance < squared && S::dot(self.area[at], facing) < 0.0 {
                    let fall = 1.0 - distance / squared;
                    let share = fall * fall;
                    let between = position - self.position[at];
                    mean += self.area[at] * share;
                    let weight = share * S::dot(self.area[at], self.area[at]).sqrt();
                    total += weight;
                    way += between * weight;
                    along += S::dot(between, self.area[at]) * share;
                }
            }
        }
        let normal = mean * (1.0 / S::dot(mean, mean).sqrt());
        Some(NearSurface { gap: 0.5 * (S::dot(way, normal) + along) / total, normal })
    }

    /// Returns the chord between two tracers, with the point of the chord nearest to a position.
    #[inline(always)]
    fn chord(&self, from: usize, to: usize, position: S::Vector) -> Chord<S> {
        let chord = self.position[to] - self.position[from];
        let way = position - self.position[from];
        let part = (S::dot(way, chord) / S::dot(chord, chord)).clamp(0.0, 1.0);
        Chord { ends: [from, to], chord, part, off: way - chord * part }
    }

    /// Returns the surface over a chord. It is the cubic curve with the normals of the two tracers at its ends.
    #[inline(always)]
    fn on(&self, &Chord { ends: [from, to], chord, part, off }: &Chord<S>) -> NearSurface<S> {
        let [first, last] = [self.normal(from), self.normal(to)];
        let mean = first * (1.0 - part) + last * part;
        let normal = mean * (1.0 / S::dot(mean, mean).sqrt());
        // Slopes of the surface relative to the chord at both ends, times the length of the chord (m).
        let slope = |end: S::Vector| -S::dot(end, chord) / S::dot(end, normal);
        let bump = slope(first) * part * (1.0 - part) * (1.0 - part) - slope(last) * part * part * (1.0 - part);
        NearSurface { gap: S::dot(off, normal) - bump, normal }
    }
}

/// Returns the unit vector along a vector, which must not be zero.
#[inline(always)]
fn unit<S: Space>(vector: S::Vector) -> S::Vector {
    vector * (1.0 / S::dot(vector, vector).sqrt())
}

/// Chord between two tracers, with the point of the chord nearest to a position.
struct Chord<S: Space> {
    ends: [usize; 2],
    /// Vector from the first to the second tracer (m).
    chord: S::Vector,
    /// Position of the nearest point on the chord, as a fraction of the chord's length.
    part: f64,
    /// Vector from the nearest point to the position (m).
    off: S::Vector,
}

/// Mutable view of consecutive tracers of whole bodies, for one thread.
pub(crate) struct TracersMut<'a, S: Space> {
    /// Index of the first tracer.
    pub(super) first: usize,
    pub(super) position: &'a mut [S::Vector],
    pub(super) area: &'a mut [S::Vector],
    pub(super) neighbours: &'a [[u32; 2]],
    pub(super) chunks: &'a mut [Chunk<S>],
}

impl<S: Space> TracersMut<'_, S> {
    /// Splits off the tracers of these bodies, which must be the first ones.
    pub(crate) fn take_off(&mut self, bodies: &[Body]) -> Self {
        let count = bodies.iter().map(|body| body.tracers.len()).sum();
        let first = self.first;
        self.first += count;
        let (neighbours, others) = self.neighbours.split_at(count);
        self.neighbours = others;
        let [position, area] = [&mut self.position, &mut self.area].map(|list| take_off(list, count));
        let chunks = take_off(&mut self.chunks, bodies.iter().map(|body| body.chunks.len()).sum());
        Self { first, position, area, neighbours, chunks }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::space::Plane;
    use nalgebra::Vector2;
    use std::f64::consts::TAU;

    /// The test checks the gap of a position inside a circle of radius R that is sampled by chords of length L.
    ///
    /// The error of the cubic over a chord is at most L⁴/(128 R³), at its middle. Let a = L/2R be half the angle of the
    /// chord, and q L the position along the chord, −½ < q < ½. Then the gap on the circle is R a⁴ (−⅛ + q² − 2q⁴). At
    /// a depth d the normal is not taken at the foot on the circle, at the angle φ ≤ a R/(R − d), but at φ (R − d)/R.
    /// The resulting error is φ² d² (R − d)/2R² ≤ L² d²/(8R² (R − d)). Further terms are smaller by (L/R)².
    #[test]
    fn the_gap_in_a_circle_is_of_fourth_order() {
        let (centre, radius) = (Vector3::new(0.3, -0.2, 0.0), 1.5);
        let mut worst = Vec::new();
        for count in [24_u32, 48, 96] {
            let chord = TAU * radius / f64::from(count);
            let mut tracers = Tracers::<Plane>::default();
            tracers.add(&elements::circle(centre, radius, 1.000_001 * chord, 1.0));
            assert_eq!(tracers.len(), count as usize);
            let chunks = tracers.cut(0..tracers.len());
            tracers.find_boxes();
            let mut most = 0.0_f64;
            for depth in [0.05 * chord, 0.1 * chord, 0.3 * chord] {
                let on_surface = chord.powi(4) / (128.0 * radius.powi(3));
                let below = (chord * depth / radius).powi(2) / (8.0 * (radius - depth));
                let allowed = (on_surface + below) * (1.0 + (chord / radius).powi(2));
                let mut closest = None;
                for at in 0..500 {
                    let (sine, cosine) = (TAU * (f64::from(at) + 0.37) / 500.0).sin_cos();
                    let outward = Vector2::new(cosine, sine);
                    let position = centre.xy() + outward * (radius - depth);
                    let near = tracers.gone_through(chunks.clone(), position, -outward, 2.0 * chord, &mut closest);
                    let off = near.map_or(f64::NAN, |near| near.gap + depth);
                    assert!(off.abs() < allowed, "{off:e} at a depth of {depth} in {count}, allowed {allowed:e}");
                    most = most.max(off.abs());
                }
            }
            worst.push(most);
        }
        assert!(worst.windows(2).all(|pair| (15.0..17.0).contains(&(pair[0] / pair[1]))), "{worst:?}");
    }
}
