//! Motion of tracers with the velocity of the grid.

use crate::grid::basis::Basis;
use crate::grid::lattice::{Lattice, Stencil};
use crate::grid::patch::{Copies, StencilBlock};
use crate::points::body::Body;
use crate::points::runs;
use crate::surface::tracers::TracersMut;
use grainbench_lanes::{FourKernel, FourLanes, LANES, Number, SimdPack};
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;
use std::ops::Range;

/// Kernel that moves the tracers of a body for `elapsed` (s) and updates the boxes of their chunks.
///
/// The velocity is interpolated over nodes with mass.
pub(crate) struct TracerMotion<'a, S: Space, B> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) body: &'a Body,
    /// Tracers to move.
    pub(crate) of: TracersMut<'a, S>,
    /// Velocities of the nodes (m/s).
    pub(crate) velocities: &'a [S::Vector],
    /// Weight limit of each node.
    pub(crate) most: &'a [f64],
    pub(crate) elapsed: f64,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis> FourKernel for TracerMotion<'_, S, B> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { lattice, body, of: tracers, velocities, most, elapsed, .. } = self;
        let TracersMut { first, position, area, neighbours, chunks } = tracers;
        let zero = SimdPack::splat(lanes, 0.0);
        let (mut copies, mut most_copies): (Copies<S::Vector>, Copies<f64>) = ([S::ORIGIN; _], [0.0; _]);
        let mut range = 0..position.len();
        while !range.is_empty() {
            let (batch, base) = runs::first_batch::<S, B>(lattice, range.clone(), position);
            range.start += batch.count;
            if !body.window.holds(S::DIMENSION, base, B::WIDTH as i32) {
                continue;
            }
            let (seen, patch) = body.window.seen::<S, B, _>(base, velocities, &mut copies);
            let (bounds, _) = body.window.seen::<S, B, _>(base, most, &mut most_copies);
            let at = batch.spread_vectors::<S, L>(lanes, position);
            let stencil = Stencil::around::<S, B>(lattice, base, at, [SimdPack::splat(lanes, body.half); 3]);
            let [values, slopes] = stencil.along_x();
            let (mut total, mut way) = (zero, [zero; 3]);
            let (mut gradient, mut slope) = ([[zero; 3]; 3], [zero; 3]);
            for row in 0..StencilBlock::rows::<S, B>() {
                let across = stencil.across::<S, B>(row);
                let places = patch.row::<S, B>(row);
                for (node, place) in places.enumerate() {
                    let bound = SimdPack::splat(lanes, bounds[place]);
                    let value = across.value * values[node];
                    let weight = value.pick_below(bound, value, bound);
                    total = total + weight;
                    let velocity = seen[place];
                    for (component, way) in way.iter_mut().enumerate().take(S::DIMENSION) {
                        *way = *way + weight * S::component(velocity, component);
                    }
                    // If the weight of a node is limited, the gradient of its function does not count.
                    if S::DIMENSION == 3 && bounds[place] > 0.0 {
                        let whole = bound.pick_below(value, zero, zero.like(1.0));
                        let [y, z] = across.slope;
                        let along =
                            [across.value * slopes[node] * whole, y * values[node] * whole, z * values[node] * whole];
                        for (axis, &along) in along.iter().enumerate() {
                            slope[axis] = slope[axis] + along;
                            for (component, row) in gradient.iter_mut().enumerate() {
                                row[axis] = row[axis] + along * S::component(velocity, component);
                            }
                        }
                    }
                }
            }
            // Tracers with hardly any mass around them are not moved.
            let (least, inverse) = (zero.like(1e-6), zero.like(1.0) / total);
            let mut next = at;
            for axis in 0..S::DIMENSION {
                way[axis] = way[axis] * inverse;
                next[axis] = least.pick_below(total, at[axis] + way[axis] * elapsed, at[axis]);
            }
            batch.write_vectors::<S, L>(next, position);
            if S::DIMENSION == 3 {
                // Gradient of the interpolation over the nodes with mass: (Σ v ∇N − v̄ Σ ∇N)/Σ N.
                for (row, way) in gradient.iter_mut().zip(way) {
                    for (gradient, slope) in row.iter_mut().zip(slope) {
                        *gradient = least.pick_below(total, (*gradient - way * slope) * inverse, zero);
                    }
                }
                let mut gradients = [S::NO_GRADIENT; LANES];
                batch.counted_from(batch.start).write_matrices::<S, L>(gradient, &mut gradients);
                for (area, gradient) in area[batch.start..].iter_mut().zip(gradients).take(batch.count) {
                    *area = transported::<S>(*area, gradient, elapsed);
                }
            }
        }
        for chunk in chunks {
            let Range { start, end } = chunk.tracers;
            chunk.enclose(&position[start - first..end - first]);
        }
        if S::DIMENSION == 2 {
            for (area, neighbours) in area.iter_mut().zip(neighbours) {
                let [before, after] = neighbours.map(|neighbour| position[neighbour as usize - first]);
                let half = S::embed(after - before) * 0.5;
                *area = S::restrict(Vector3::new(half.y, -half.x, 0.0));
            }
        }
    }
}

/// Returns an area vector a after motion with the material: ȧ = (tr L) a − Lᵀa with the velocity gradient L (Nanson).
#[inline(always)]
fn transported<S: Space>(area: S::Vector, gradient: S::Matrix, elapsed: f64) -> S::Vector {
    let (gradient, area) = (S::embed_gradient(gradient), S::embed(area));
    S::restrict(area + (area * gradient.trace() - gradient.transpose() * area) * elapsed)
}
