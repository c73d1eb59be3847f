//! Which tracers have gone through the surface of another body.

use super::pairs::Pair;
use crate::bodies::Body;
use crate::surface::{Near, Tracers};
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_scene::space::Space;

/// How far a surface can bulge beyond the box around its tracers (cells).
const BULGE: f64 = 0.25;

/// Depth at which surfaces are taken to have passed through each other, and are let go (cells).
const DEEPEST: f64 = 0.8;

/// A tracer of the first body of a pair that has gone through the surface of the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gone<S: Space> {
    /// The bodies, that of the tracer first.
    pub(crate) pair: Pair<S>,
    pub(crate) tracer: usize,
    /// The surface of the second body there.
    pub(crate) near: Near<S>,
}

/// What a share of the pairs has found, and what it works with.
#[derive(Clone, Debug)]
pub(crate) struct Found<S: Space> {
    /// In the order of the pairs.
    pub(crate) gone: Vec<Gone<S>>,
    /// Runs of the other surface that are near the tracers at hand.
    near: Vec<usize>,
}

impl<S: Space> Found<S> {
    /// Nothing yet.
    pub(crate) const fn new() -> Self {
        Self { gone: Vec::new(), near: Vec::new() }
    }
}

/// Holds the tracers of both bodies of some pairs against the surface of the other.
pub(crate) struct Search<'a, S: Space> {
    /// Length of a cell (m).
    pub(crate) cell: f64,
    pub(crate) bodies: &'a [Body],
    pub(crate) pairs: &'a [Pair<S>],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) found: &'a mut Found<S>,
}

impl<S: Space> FourKernel for Search<'_, S> {
    #[inline(always)]
    fn run<L: FourLanes>(self, _: L) {
        let Self { cell, bodies, pairs, tracers, found: Found { gone, near } } = self;
        gone.clear();
        let reach = DEEPEST * cell;
        for pair in pairs.iter().flat_map(|pair| [*pair, pair.exchanged()]) {
            let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
            let [low, high] = second.bounds.map(|corner| S::restrict(corner) + pair.shift);
            for chunk in &tracers.chunks[first.chunks.clone()] {
                if !chunk.meets(low, high) {
                    continue;
                }
                tracers.find_near(chunk, -pair.shift, &second.chunks, reach, near);
                if near.is_empty() {
                    continue;
                }
                for tracer in chunk.tracers.clone() {
                    if beyond::<S>(tracers.position[tracer], low, high) > BULGE * cell {
                        continue;
                    }
                    let position = tracers.position[tracer] - pair.shift;
                    let there = tracers.gone_through(near.iter().copied(), position, tracers.area[tracer], reach);
                    gone.extend(there.filter(|near| near.gap < 0.0).map(|near| Gone { pair, tracer, near }));
                }
            }
        }
    }
}

/// How far beyond a box a position is, along the axis along which it is farthest (m); negative inside.
#[inline(always)]
fn beyond<S: Space>(position: S::Vector, low: S::Vector, high: S::Vector) -> f64 {
    let beyond = |axis: usize| {
        let at = |vector: S::Vector| S::component(vector, axis);
        (at(low) - at(position)).max(at(position) - at(high))
    };
    (0..S::DIMENSION).map(beyond).fold(f64::NEG_INFINITY, f64::max)
}
