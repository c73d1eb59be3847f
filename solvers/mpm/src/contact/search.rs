//! Search for tracers that penetrate the surface of another body, with the surface shape functions of both bodies
//! there.

use super::Rules;
use super::friction::Overlap;
use super::pairs::Pair;
use crate::grid::basis::Basis;
use crate::grid::lattice::Node;
use crate::points::body::Body;
use crate::surface::shape_function::SurfaceShapeFunction;
use crate::surface::tracers::{NearSurface, Tracers};
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_solver::space::Space;
use std::marker::PhantomData;

/// Largest bulge of a surface beyond the bounding box of its tracers (cells).
const BULGE: f64 = 0.25;

/// Largest depth (cells). Beyond this depth, surfaces count as having passed through each other and have no contact.
const DEEPEST: f64 = 0.8;

/// A tracer of the first body of a pair that penetrates the surface of the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PenetratingPoint<S: Space> {
    /// Pair of bodies. The tracer belongs to the first body.
    pub(crate) pair: Pair<S>,
    pub(crate) tracer: usize,
    /// Overlap with half of the spring stiffness, because tracers of the second body add the other half.
    pub(crate) overlap: Overlap<S>,
    /// Contact point (m), at the position of the first body. Across a periodic boundary, the second body is in contact
    /// through its nearest periodic image.
    pub(crate) there: S::Vector,
    /// Surface shape functions of both bodies at the contact point.
    pub(crate) grips: [SurfaceShapeFunction<S>; 2],
}

/// Results and working memory of the search in a subrange of pairs.
#[derive(Clone, Debug, Default)]
pub(crate) struct SearchResults<S: Space> {
    /// Penetrating tracers in the order of the pairs.
    pub(crate) gone: Vec<PenetratingPoint<S>>,
    /// Tracer chunks of the second body near the current tracers.
    near: Vec<usize>,
}

/// Kernel of the search in some pairs of bodies. It tests the tracers of each body against the surface of its contact
/// partner.
pub(crate) struct Search<'a, S: Space, B> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) nodes: &'a [Node<S>],
    /// Weight limit of each node at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) pairs: &'a [Pair<S>],
    pub(crate) found: &'a mut SearchResults<S>,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis> FourKernel for Search<'_, S, B> {
    #[inline(always)]
    fn run<L: FourLanes>(self, _: L) {
        let Self { rules, bodies, tracers, pairs, .. } = self;
        let SearchResults { mut gone, mut near } = std::mem::take(&mut *self.found);
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
                tracers.find_near(chunk, -pair.shift, &second.chunks, reach, &mut near);
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
                    gone.extend(there.and_then(|near| self.gone(pair, tracer, near)));
                }
            }
        }
        *self.found = SearchResults { gone, near };
    }
}

impl<S: Space, B: Basis> Search<'_, S, B> {
    /// Returns the contact of a tracer of the first body that penetrates the surface `near` of the second, or `None` if
    /// no force acts there.
    #[inline(always)]
    fn gone(&self, pair: Pair<S>, tracer: usize, near: NearSurface<S>) -> Option<PenetratingPoint<S>> {
        let Self { rules, bodies, tracers, nodes, most, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let friction = rules.friction.between(first.material, second.material)?;
        let moduli = [first, second].map(|body| body.deformable.plane_modulus());
        let harmonic = 2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]);
        let per_area = 0.5 * rules.setting.penalty * harmonic / rules.lattice.shortest(S::DIMENSION);
        let area = tracers.area[tracer];
        let depth = -near.gap;
        // Outward normal of the second body. It is the mean of this body's normal and the reversed normal of the first
        // body, so that exchanging the bodies does not change the result.
        let out = near.normal - tracers.normal(tracer);
        let normal = out * (1.0 / S::dot(out, out).sqrt());
        let middle = tracers.position[tracer] - pair.shift + near.normal * (0.5 * depth);
        let there = middle + pair.shift;
        let one = SurfaceShapeFunction::<S>::new::<B>(rules.lattice, first, there, nodes, most)?;
        let two = SurfaceShapeFunction::<S>::new::<B>(rules.lattice, second, middle, nodes, most)?;
        let stiffness = per_area * S::dot(area, area).sqrt();
        let slip = (one.velocity - two.velocity) * rules.time_step;
        let overlap = Overlap { depth, normal, stiffness, slip, friction };
        Some(PenetratingPoint { pair, tracer, overlap, there, grips: [one, two] })
    }
}

/// Returns the largest distance of a position beyond a box along any axis (m); negative inside the box.
#[inline(always)]
fn beyond<S: Space>(position: S::Vector, low: S::Vector, high: S::Vector) -> f64 {
    let beyond = |axis: usize| {
        let at = |vector: S::Vector| S::component(vector, axis);
        (at(low) - at(position)).max(at(position) - at(high))
    };
    (0..S::DIMENSION).map(beyond).fold(f64::NEG_INFINITY, f64::max)
}
