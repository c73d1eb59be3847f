//! From nodes to points: velocities and the way that they go.

use crate::basis::Basis;
use crate::grid::{Lattice, Node};
use crate::lanes::{Four, Kernel, Lanes, Number};
use crate::patch::{Copies, Patch};
use crate::points::Points;
use crate::runs::{Ground, Run};
use crate::scatter::{Shown, weighted};
use crate::transfer::{Part, Transfer};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::array::from_fn;
use std::marker::PhantomData;

/// Velocity and next position of a body's points from its nodes; and, with `PROJECT`, the momentum of the points with
/// their new velocity back to the nodes (MUSL).
pub(crate) struct Gather<'a, S: Space, B, T, const PROJECT: bool> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) part: &'a Part,
    pub(crate) runs: &'a [Run],
    pub(crate) transfer: T,
    pub(crate) time_step: f64,
    pub(crate) points: &'a mut Points<S>,
    pub(crate) nodes: &'a [Node<S>],
    pub(crate) projected: &'a mut [S::Vector],
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis, T: Transfer, const PROJECT: bool> Kernel for Gather<'_, S, B, T, PROJECT> {
    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { lattice, part, runs, transfer, time_step, points, nodes, projected, .. } = self;
        let zero = Four::splat(lanes, 0.0);
        let mut copies: Copies<Node<S>> = [Node::EMPTY; _];
        let mut projected_copies: Copies<S::Vector> = [S::ORIGIN; _];
        for run in runs {
            let (seen, patch) = part.window.seen::<S, B, _>(run.base, nodes, &mut copies);
            let (reached, _) = part.window.reached::<S, B, _>(run.base, projected, &mut projected_copies);
            for batch in run.batches() {
                let Points { position, deformation, .. } = points;
                let ground = Ground::<S> { lattice, part, runs, deformation, position };
                let stencil = ground.stencil::<B, L>(lanes, run, batch);
                let [values, _] = stencil.along_x();
                let affine = stencil.affine_along_x();
                let (mut around, mut change, mut made) = ([zero; 3], [zero; 3], [[zero; 3]; 3]);
                for row in 0..Patch::rows::<S, B>() {
                    let across = stencil.across::<S, B>(row);
                    let nodes = &seen[patch.row::<S, B>(row)];
                    let nodes: [&Node<S>; 3] = from_fn(|node| &nodes[node.min(B::WIDTH - 1)]);
                    for component in 0..S::DIMENSION {
                        let of = |vector| Four::splat(lanes, S::component(vector, component));
                        let velocity = nodes.map(|node| of(node.velocity));
                        let changed = nodes.map(|node| of(node.change));
                        let [velocities, changes] = [velocity, changed].map(|of| weighted::<B, _>(of, values));
                        around[component] = around[component] + velocities * across.value;
                        change[component] = change[component] + changes * across.value;
                        if T::AFFINE {
                            let along = weighted::<B, _>(T::source(velocity, changed), affine);
                            let source = T::source(velocities, changes);
                            let made = &mut made[component];
                            made[0] = made[0] + along * across.value;
                            made[1] = made[1] + source * across.affine[0];
                            if S::DIMENSION == 3 {
                                made[2] = made[2] + source * across.affine[1];
                            }
                        }
                    }
                }
                let before = batch.vectors::<S, L>(lanes, &points.velocity);
                let velocity = from_fn(|axis| transfer.taken(before[axis], around[axis], change[axis]));
                batch.write_vectors::<S, L>(velocity, &mut points.velocity);
                let position = batch.vectors::<S, L>(lanes, &points.position);
                let next = from_fn(|axis| position[axis] + around[axis] * time_step);
                batch.write_vectors::<S, L>(next, &mut points.next);
                let mut affine = [[zero; 3]; 3];
                if T::AFFINE {
                    affine = T::carried::<S, _>(batch.matrices::<S, L>(lanes, &points.affine), made, &stencil);
                    batch.write_matrices::<S, L>(affine, &mut points.affine);
                }
                if PROJECT {
                    let shown = Shown::new::<S, T>(&lattice.cell, &stencil, velocity, affine);
                    let mass = batch.amounts(lanes, &points.mass);
                    let masses = values.map(|value| value * mass);
                    for row in 0..Patch::rows::<S, B>() {
                        let across = stencil.across::<S, B>(row);
                        let masses = masses.map(|mass| mass * across.value);
                        let velocities: [[_; 3]; 3] = from_fn(|axis| shown.row::<S, B, T>(row, axis));
                        let momenta = from_fn(|node| velocities.map(|velocities| masses[node] * velocities[node]));
                        give::<S, B, L>(momenta, &mut reached[patch.row::<S, B>(row)]);
                    }
                }
            }
            if PROJECT {
                part.window.put_back::<S, B, _>(run.base, projected, &projected_copies);
            }
        }
    }
}

/// Adds momentum from four points to the nodes of a row.
#[inline(always)]
fn give<S: Space, B: Basis, L: Lanes>(momenta: [[Four<L>; 3]; 3], projected: &mut [S::Vector]) {
    let zero = momenta[0][2].like(0.0);
    let sums = if S::DIMENSION == 2 {
        let [[a, b, _], [c, d, _], [e, f, _]] = momenta;
        let [a, b, c, d] = Four::sums([a, b, c, d]);
        let [e, f, ..] = Four::sums([e, f, zero, zero]);
        [[a, b, 0.0], [c, d, 0.0], [e, f, 0.0]]
    } else {
        momenta.map(|[x, y, z]| {
            let [x, y, z, _] = Four::sums([x, y, z, zero]);
            [x, y, z]
        })
    };
    for (projected, sum) in projected.iter_mut().zip(sums).take(B::WIDTH) {
        *projected += S::restrict(Vector3::from(sum));
    }
}
