//! Which tracers have gone through the surface of another body, and how both bodies are held there.

use super::friction::Overlap;
use super::grip::Grip;
use super::pairs::Pair;
use super::penalty::Rules;
use crate::basis::Basis;
use crate::bodies::Body;
use crate::grid::Node;
use crate::surface::{Near, Tracers};
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_scene::space::Space;
use std::marker::PhantomData;

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
    /// The spring between them, with half of the stiffness, since the tracers of the second do the same.
    pub(crate) overlap: Overlap<S>,
    /// Where the surfaces meet, by the first body (m).
    pub(crate) there: S::Vector,
    /// Both bodies there.
    pub(crate) grips: [Grip<S>; 2],
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

/// What is around tracers.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a, S: Space, B> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) nodes: &'a [Node<S>],
    /// What each node counts for at most at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) basis: PhantomData<B>,
}

/// Holds the tracers of both bodies of some pairs against the surface of the other.
pub(crate) struct Search<'a, S: Space, B> {
    pub(crate) around: Around<'a, S, B>,
    pub(crate) pairs: &'a [Pair<S>],
    pub(crate) found: &'a mut Found<S>,
}

impl<S: Space, B: Basis> FourKernel for Search<'_, S, B> {
    #[inline(always)]
    fn run<L: FourLanes>(self, _: L) {
        let Self { around, pairs, found: Found { gone, near } } = self;
        let Around { rules, bodies, tracers, .. } = around;
        let cell = rules.lattice.shortest(S::DIMENSION);
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
                let mut closest = None;
                for tracer in chunk.tracers.clone() {
                    if beyond::<S>(tracers.position[tracer], low, high) > BULGE * cell {
                        continue;
                    }
                    let position = tracers.position[tracer] - pair.shift;
                    let (facing, runs) = (tracers.area[tracer], near.iter().copied());
                    let there = tracers.gone_through(runs, position, facing, reach, &mut closest);
                    let there = there.filter(|near| near.gap < 0.0);
                    gone.extend(there.and_then(|near| around.gone(pair, tracer, near)));
                }
            }
        }
    }
}

impl<S: Space, B: Basis> Around<'_, S, B> {
    /// What holds a tracer of the first body of a pair that has gone through the surface of the second, `near`; none where
    /// nothing does.
    #[inline(always)]
    fn gone(&self, pair: Pair<S>, tracer: usize, near: Near<S>) -> Option<Gone<S>> {
        let Self { rules, bodies, tracers, nodes, most, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let friction = rules.friction.between(first.material, second.material)?;
        let moduli = [first, second].map(|body| body.deformable.plane_modulus());
        let harmonic = 2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]);
        let per_area = 0.5 * rules.penalty * harmonic / rules.lattice.shortest(S::DIMENSION);
        let area = tracers.area[tracer];
        let depth = -near.gap;
        // Out of the second body, as the mean of both surfaces has it, so that no surface is preferred.
        let out = near.normal - tracers.normal(tracer);
        let normal = out * (1.0 / S::dot(out, out).sqrt());
        let middle = tracers.position[tracer] - pair.shift + near.normal * (0.5 * depth);
        let there = middle + pair.shift;
        let one = Grip::<S>::new::<B>(rules.lattice, &first.part, there, nodes, most)?;
        let two = Grip::<S>::new::<B>(rules.lattice, &second.part, middle, nodes, most)?;
        let stiffness = per_area * S::dot(area, area).sqrt();
        let slip = (one.velocity - two.velocity) * rules.time_step;
        let overlap = Overlap { depth, normal, stiffness, slip, friction };
        Some(Gone { pair, tracer, overlap, there, grips: [one, two] })
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
