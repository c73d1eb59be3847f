//! Transfer from points to nodes (P2G): mass, momentum and internal force.
//!
//! The sums are over the points p of a body, at each node i of the body with basis function N_i:
//!
//! - m_i = Σ N_i(x_p) m_p, mass (kg);
//! - p_i = Σ N_i(x_p) m_p (v_p + A_p (x_i − x_p)), momentum (kg m/s), with positions x (m) and velocities v (m/s). A is
//!   the affine part of the velocity (1/s), if the transfer uses one (Jiang et al. 2015);
//! - f_i = −Σ V_p σ_p ∇N_i(x_p), internal force (N), with volumes V (m³; m² in two dimensions) and Cauchy stresses σ
//!   (Pa) (Sulsky, Chen & Schreyer 1994).

use crate::grid::basis::{Basis, with_basis};
use crate::grid::lattice::{Node, Stencil};
use crate::grid::nodes::{Grid, NodePartition};
use crate::grid::patch::{Copies, NodeRows, StencilBlock};
use crate::points::arrays::Points;
use crate::points::runs::Ground;
use crate::points::state::State;
use crate::scheme::Scheme;
use crate::surface::shape_function;
use crate::transfer::schemes::{Apic, Flip, Transfer};
use grainbench_lanes::{FourKernel, FourLanes, LANES, Number, SimdPack};
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// Clears the nodes and scatters mass, momentum and internal force of points to them. With `grips`, it also computes
/// the weight limits of nodes at surfaces.
pub(crate) fn scatter<S: Space>(scheme: &Scheme, state: &State<S>, grid: &mut Grid<S>, grips: bool) {
    let Scheme { setting, processor, .. } = scheme;
    let State { bodies, points, shares, team, .. } = state;
    let lattice = grid.lattice;
    team.each(grid.parts(shares), |number, NodePartition { nodes: own, projected, most }| {
        own.fill(Node::EMPTY);
        projected.fill(S::ORIGIN);
        let start = shares[number].nodes.start;
        for (_, body, runs) in state.reaching(&shares[number].nodes) {
            let ground = Ground::new(&lattice, body, runs, points);
            let nodes = NodeRows::new(start, &mut *own);
            // Points with a spin scatter it as an affine part, so one kernel serves both transfers.
            with_basis!(setting.basis, B => if points.affine.is_empty() {
                processor.run_by_four(Scatter::<S, B, Flip> { ground, points, nodes, how: PhantomData });
            } else {
                processor.run_by_four(Scatter::<S, B, Apic> { ground, points, nodes, how: PhantomData });
            });
        }
        if grips {
            for body in bodies {
                let window = body.window.slots();
                let here = window.start.max(start) - start..window.end.clamp(start, start + own.len()) - start;
                if !here.is_empty() {
                    shape_function::bear(&own[here.clone()], body.cell_mass, &mut most[here]);
                }
            }
        }
    });
}

/// Returns the weighted sum over the nodes of a row.
#[inline(always)]
pub(crate) fn weighted<B: Basis, N: Number>(values: [N; 3], weights: [N; 3]) -> N {
    let sum = values[0] * weights[0] + values[1] * weights[1];
    if B::WIDTH == 3 { sum + values[2] * weights[2] } else { sum }
}

/// Velocity of points extrapolated to the nodes of a stencil, v + A r with the vector r from the point to the node. It
/// is stored as the value at the first node and the increment to the next node along each axis.
pub(crate) struct ExtrapolatedVelocity<N> {
    first: [N; 3],
    next: [[N; 3]; 3],
}

impl<N: Number> ExtrapolatedVelocity<N> {
    #[inline(always)]
    pub(crate) fn new<S: Space, T: Transfer>(
        cell: &[f64; 3],
        stencil: &Stencil<N>,
        velocity: [N; 3],
        affine: [[N; 3]; 3],
    ) -> Self {
        let zero = velocity[0].like(0.0);
        let mut shown = Self { first: velocity, next: [[zero; 3]; 3] };
        if T::AFFINE {
            for (component, affine) in affine.iter().enumerate().take(S::DIMENSION) {
                for (axis, &along) in affine.iter().enumerate().take(S::DIMENSION) {
                    shown.first[component] = shown.first[component] + along * stencil.arm_of_first(axis);
                    shown.next[axis][component] = along * cell[axis];
                }
            }
        }
        shown
    }

    /// Returns a component at the nodes of a row along x.
    #[inline(always)]
    pub(crate) fn row<S: Space, B: Basis, T: Transfer>(&self, row: usize, component: usize) -> [N; 3] {
        let first = self.first[component];
        if !T::AFFINE {
            return [first; 3];
        }
        let [x, y, z] = &self.next;
        let mut start = first + y[component] * (row % B::WIDTH) as f64;
        if S::DIMENSION == 3 {
            start = start + z[component] * (row / B::WIDTH) as f64;
        }
        [start, start + x[component], start + x[component] * 2.0]
    }
}

/// Kernel that scatters mass, momentum and internal force, −Vσ∇N, of a body's points to its nodes.
struct Scatter<'a, S: Space, B, T> {
    ground: Ground<'a, S>,
    points: &'a Points<S>,
    nodes: NodeRows<'a, Node<S>>,
    how: PhantomData<(B, T)>,
}

impl<S: Space, B: Basis, T: Transfer> FourKernel for Scatter<'_, S, B, T> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { ground, points, mut nodes, .. } = self;
        let zero = SimdPack::splat(lanes, 0.0);
        let mut copies: Copies<Node<S>> = [Node::EMPTY; _];
        for run in ground.runs {
            let window = &ground.body.window;
            let Some((mut reached, patch)) = nodes.reached::<S, B>(window, run.base, &mut copies) else { continue };
            for batch in run.batches() {
                let stencil = ground.stencil::<B, L>(lanes, run, batch);
                let velocity = batch.vectors::<S, L>(lanes, &points.velocity);
                let affine = if T::AFFINE { batch.matrices::<S, L>(lanes, &points.affine) } else { [[zero; 3]; 3] };
                let shown = ExtrapolatedVelocity::new::<S, T>(&ground.lattice.cell, &stencil, velocity, affine);
                let [values, slopes] = stencil.along_x();
                let mass = batch.amounts(lanes, &points.mass);
                let masses = SimdPack::scaled(values, mass);
                let volume = -batch.amounts(lanes, &points.volume);
                let mut pull = batch.tensors::<S, L>(lanes, &points.stress);
                for row in &mut pull {
                    *row = SimdPack::scaled(*row, volume);
                }
                for row in 0..StencilBlock::rows::<S, B>() {
                    let Some(reached) = reached.row(patch.row::<S, B>(row)) else { continue };
                    let across = stencil.across::<S, B>(row);
                    let masses = SimdPack::scaled(masses, across.value);
                    let mut brought = [[zero; 2 * LANES]; 3];
                    for (brought, &mass) in brought.iter_mut().zip(&masses) {
                        brought[0] = mass;
                    }
                    for component in 0..S::DIMENSION {
                        let velocities = shown.row::<S, B, T>(row, component);
                        let along = pull[component][0] * across.value;
                        let mut rest = pull[component][1] * across.slope[0];
                        if S::DIMENSION == 3 {
                            rest = rest + pull[component][2] * across.slope[1];
                        }
                        for node in 0..B::WIDTH {
                            brought[node][1 + component] = masses[node] * velocities[node];
                            brought[node][1 + S::DIMENSION + component] = slopes[node] * along + values[node] * rest;
                        }
                    }
                    give::<S, B, L>(brought, reached);
                }
            }
            nodes.put_back::<S, B>(window, run.base, &copies);
        }
    }
}

/// Adds mass, momentum and force from four points to the nodes of a row.
#[inline(always)]
fn give<S: Space, B: Basis, L: FourLanes>(brought: [[SimdPack<L>; 2 * LANES]; 3], nodes: &mut [Node<S>]) {
    let zero = brought[0][7];
    let [x, y, z] = brought;
    let last = if S::DIMENSION == 2 {
        // In two dimensions one value of each node remains.
        let [x, y, z, _] = SimdPack::sums([x[4], y[4], z[4], zero]);
        [[x, 0.0, 0.0, 0.0], [y, 0.0, 0.0, 0.0], [z, 0.0, 0.0, 0.0]]
    } else {
        [
            SimdPack::sums([x[4], x[5], x[6], zero]),
            SimdPack::sums([y[4], y[5], y[6], zero]),
            SimdPack::sums([z[4], z[5], z[6], zero]),
        ]
    };
    for (node, to) in nodes.iter_mut().enumerate().take(B::WIDTH) {
        let brought = &brought[node];
        let [mass, a, b, c] = SimdPack::sums([brought[0], brought[1], brought[2], brought[3]]);
        let [d, e, f, _] = last[node];
        let sums = [a, b, c, d, e, f];
        to.mass += mass;
        to.velocity += S::restrict(Vector3::new(a, b, c));
        to.change +=
            S::restrict(Vector3::from_fn(|axis, _| if axis < S::DIMENSION { sums[S::DIMENSION + axis] } else { 0.0 }));
    }
}
