//! Transfer from nodes to points (G2P): velocities and displacements.
//!
//! The sums are over the nodes i that influence a point p. N_i are the basis functions of the nodes, v_i the node
//! velocities after the step and Δv_i the changes of velocity in the step (m/s):
//!
//! - v_p ← keep v_p + Σ N_i(x_p) Δv_i if points keep their velocity (Brackbill & Ruppel 1986), otherwise Σ N_i(x_p)
//!   v_i; keep is the damping factor ([`Surroundings`](crate::scheme::Surroundings));
//! - x_p ← x_p + Δt Σ N_i(x_p) v_i, positions (m). If points move with the velocities of the stress update, this is
//!   done later with those velocities ([`crate::transfer::gradients`]);
//! - A_p ← Σ v_i ⊗ N_i (x_i − x_p) D⁻¹, D = Σ N_i (x_i − x_p) ⊗ (x_i − x_p), if points have an affine part of the
//!   velocity (1/s) (Jiang et al. 2015);
//! - for MUSL, momenta from the points back to the nodes: p_i = Σ N_i(x_p) m_p (v_p + A_p (x_i − x_p)) with the new
//!   values (Sulsky, Zhou & Schreyer 1995).

use crate::grid::basis::{Basis, with_basis};
use crate::grid::lattice::{Lattice, Node, Stencil};
use crate::grid::nodes::{Grid, NodePartition};
use crate::grid::patch::{Copies, NodeRows, StencilBlock};
use crate::options;
use crate::points::arrays::{Points, PointsMut};
use crate::points::body::Body;
use crate::points::runs::{Ground, ParticleBatch};
use crate::points::share::ThreadPartition;
use crate::points::state::State;
use crate::scheme::Scheme;
use crate::transfer::scatter::{ExtrapolatedVelocity, weighted};
use crate::transfer::schemes::{Apic, Flip, Spin, Transfer};
use grainbench_lanes::{FourKernel, FourLanes, Number, SimdPack, take_off};
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// Gathers velocities and displacements of points from the nodes.
///
/// For MUSL it also scatters the momentum of the new velocities to the nodes. The same loop does this for nodes that no
/// earlier thread partition influences. A second loop does it for the remaining nodes.
pub(crate) fn gather<S: Space>(scheme: &Scheme, keep: f64, state: &mut State<S>, grid: &mut Grid<S>) {
    let Grid { lattice, nodes, projected, .. } = grid;
    let State { bodies, points, shares, team, .. } = state;
    let Scheme { setting, processor, .. } = *scheme;
    let (mut left, mut left_projected) = (points.lent(), &mut projected[..]);
    let parts = shares.iter().map(|share| {
        let projected = take_off(&mut left_projected, share.nodes.len());
        (left.take_off(share.points.len()), &mut projected[share.alone_from - share.nodes.start..])
    });
    team.each(parts, |number, (mut points, projected)| {
        macro_rules! gather {
            ($B:ty, $transfer:expr, $body:expr, $runs:expr) => {{
                let (transfer, body, runs, basis) = ($transfer, $body, $runs, PhantomData::<$B>);
                let (points, projected) = (&mut points, NodeRows::new(shares[number].alone_from, projected));
                let gather = Gather { lattice, body, runs, transfer, scheme, keep, points, nodes, projected, basis };
                processor.run_by_four(gather);
            }};
        }
        for (body, runs) in shares[number].parts(bodies) {
            with_basis!(setting.basis, B => match setting.transfer {
                options::Transfer::Flip { pic } => gather!(B, Flip { pic }, body, runs),
                options::Transfer::Apic => gather!(B, Apic, body, runs),
                options::Transfer::Spin => gather!(B, Spin, body, runs),
            });
        }
    });
    if scheme.is_projected() && state.shares.len() > 1 {
        project_others(scheme, state, grid);
    }
}

/// Scatters momentum to the remaining nodes. A partition's own points scatter to nodes that earlier partitions also
/// influence. Points of earlier and later partitions scatter to all nodes of the partition that they influence.
fn project_others<S: Space>(scheme: &Scheme, state: &State<S>, grid: &mut Grid<S>) {
    let Scheme { setting, processor, .. } = *scheme;
    let State { points, shares, team, .. } = state;
    let lattice = grid.lattice;
    team.each(grid.parts(shares), |number, NodePartition { projected, .. }| {
        let ThreadPartition { nodes, alone_from, .. } = &shares[number];
        for (other, body, runs) in state.reaching(nodes) {
            let ground = Ground::new(&lattice, body, runs, points);
            let end = if other > number { projected.len() } else { alone_from - nodes.start };
            let projected = NodeRows::new(nodes.start, &mut projected[..end]);
            with_basis!(setting.basis, B => if points.affine.is_empty() {
                processor.run_by_four(Project::<S, B, Flip> { ground, points, projected, how: PhantomData });
            } else {
                processor.run_by_four(Project::<S, B, Apic> { ground, points, projected, how: PhantomData });
            });
        }
    });
}

/// Kernel that gathers the velocities of a body's points from its nodes.
///
/// It also computes the next positions of the points, unless the stress update does. For MUSL it scatters momentum with
/// the new velocities.
struct Gather<'a, 'b, S: Space, B, T> {
    lattice: &'a Lattice,
    body: &'a Body,
    runs: &'a [ParticleBatch],
    transfer: T,
    scheme: &'a Scheme,
    /// Damping factor of velocities in a step.
    keep: f64,
    points: &'a mut PointsMut<'b, S>,
    nodes: &'a [Node<S>],
    projected: NodeRows<'a, S::Vector>,
    basis: PhantomData<B>,
}

impl<S: Space, B: Basis, T: Transfer> FourKernel for Gather<'_, '_, S, B, T> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { lattice, body, runs, transfer, scheme, keep, points, nodes, mut projected, .. } = self;
        let (moves, projects, time_step) = (!scheme.moves_with_stress(), scheme.is_projected(), scheme.time_step);
        let zero = SimdPack::splat(lanes, 0.0);
        let mut copies: Copies<Node<S>> = [Node::EMPTY; _];
        let mut projected_copies: Copies<S::Vector> = [S::ORIGIN; _];
        for run in runs {
            let (seen, patch) = body.window.seen::<S, B, _>(run.base, nodes, &mut copies);
            let mut reached = None;
            if projects {
                reached = projected.reached::<S, B>(&body.window, run.base, &mut projected_copies);
            }
            for batch in run.batches() {
                let (ground, _) = Ground::lent(lattice, body, runs, points);
                let stencil = ground.stencil::<B, L>(lanes, run, batch);
                let batch = batch.counted_from(points.first);
                let [values, _] = stencil.along_x();
                let affine = stencil.affine_along_x();
                let (mut around, mut change, mut made) = ([zero; 3], [zero; 3], [[zero; 3]; 3]);
                for row in 0..StencilBlock::rows::<S, B>() {
                    let across = stencil.across::<S, B>(row);
                    let nodes = &seen[patch.row::<S, B>(row)];
                    let nodes = [&nodes[0], &nodes[1], &nodes[B::WIDTH - 1]];
                    for component in 0..S::DIMENSION {
                        let (mut velocity, mut changed) = ([zero; 3], [zero; 3]);
                        for (node, at) in nodes.into_iter().enumerate() {
                            velocity[node] = SimdPack::splat(lanes, S::component(at.velocity, component));
                            changed[node] = SimdPack::splat(lanes, S::component(at.change, component));
                        }
                        let velocities = weighted::<B, _>(velocity, values);
                        let changes = weighted::<B, _>(changed, values);
                        if moves || T::AROUND {
                            around[component] = around[component] + velocities * across.value;
                        }
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
                let before = batch.vectors::<S, L>(lanes, points.velocity);
                let mut velocity = before;
                for axis in 0..S::DIMENSION {
                    velocity[axis] = transfer.taken(before[axis] * keep, around[axis], change[axis]);
                }
                batch.write_vectors::<S, L>(velocity, points.velocity);
                if moves {
                    let mut next = batch.vectors::<S, L>(lanes, points.position);
                    for (next, around) in next.iter_mut().zip(around).take(S::DIMENSION) {
                        *next = *next + around * time_step;
                    }
                    batch.write_vectors::<S, L>(next, points.next);
                }
                let mut affine = [[zero; 3]; 3];
                if T::AFFINE {
                    let mut before = batch.matrices::<S, L>(lanes, points.affine);
                    for row in before.iter_mut().take(S::DIMENSION) {
                        for part in row.iter_mut().take(S::DIMENSION) {
                            *part = *part * keep;
                        }
                    }
                    affine = T::carried::<S, _>(before, made, &stencil);
                    batch.write_matrices::<S, L>(affine, points.affine);
                }
                if let Some((reached, patch)) = &mut reached {
                    let shown = ExtrapolatedVelocity::new::<S, T>(&lattice.cell, &stencil, velocity, affine);
                    let mass = batch.amounts(lanes, points.mass);
                    bring::<S, B, T, L>(&shown, &stencil, mass, reached, *patch);
                }
            }
            if projects {
                projected.put_back::<S, B>(&body.window, run.base, &projected_copies);
            }
        }
    }
}

/// Kernel that scatters the momentum of a body's points to its nodes.
struct Project<'a, S: Space, B, T> {
    ground: Ground<'a, S>,
    points: &'a Points<S>,
    projected: NodeRows<'a, S::Vector>,
    how: PhantomData<(B, T)>,
}

impl<S: Space, B: Basis, T: Transfer> FourKernel for Project<'_, S, B, T> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { ground, points, mut projected, .. } = self;
        let zero = SimdPack::splat(lanes, 0.0);
        let mut copies: Copies<S::Vector> = [S::ORIGIN; _];
        for run in ground.runs {
            let window = &ground.body.window;
            let Some((mut reached, patch)) = projected.reached::<S, B>(window, run.base, &mut copies) else { continue };
            for batch in run.batches() {
                let stencil = ground.stencil::<B, L>(lanes, run, batch);
                let velocity = batch.vectors::<S, L>(lanes, &points.velocity);
                let affine = if T::AFFINE { batch.matrices::<S, L>(lanes, &points.affine) } else { [[zero; 3]; 3] };
                let shown = ExtrapolatedVelocity::new::<S, T>(&ground.lattice.cell, &stencil, velocity, affine);
                bring::<S, B, T, L>(&shown, &stencil, batch.amounts(lanes, &points.mass), &mut reached, patch);
            }
            projected.put_back::<S, B>(window, run.base, &copies);
        }
    }
}

/// Adds the momenta of four points to the nodes. `shown` contains their velocities, extrapolated to the nodes.
#[inline(always)]
fn bring<S: Space, B: Basis, T: Transfer, L: FourLanes>(
    shown: &ExtrapolatedVelocity<SimdPack<L>>,
    stencil: &Stencil<SimdPack<L>>,
    mass: SimdPack<L>,
    reached: &mut NodeRows<'_, S::Vector>,
    patch: StencilBlock,
) {
    let zero = mass.like(0.0);
    let masses = SimdPack::scaled(stencil.along_x()[0], mass);
    for row in 0..StencilBlock::rows::<S, B>() {
        let Some(reached) = reached.row(patch.row::<S, B>(row)) else { continue };
        let masses = SimdPack::scaled(masses, stencil.across::<S, B>(row).value);
        let mut momenta = [[zero; 3]; 3];
        for (component, momenta) in momenta.iter_mut().enumerate().take(S::DIMENSION) {
            let velocities = shown.row::<S, B, T>(row, component);
            for (node, momentum) in momenta.iter_mut().enumerate().take(B::WIDTH) {
                *momentum = masses[node] * velocities[node];
            }
        }
        give::<S, B, L>(momenta, reached);
    }
}

/// Adds the momenta of four points, given by component, to the nodes of a row along x.
#[inline(always)]
fn give<S: Space, B: Basis, L: FourLanes>([x, y, z]: [[SimdPack<L>; 3]; 3], projected: &mut [S::Vector]) {
    let sums = if S::DIMENSION == 2 {
        let [a, b, c, d] = SimdPack::sums([x[0], y[0], x[1], y[1]]);
        let [e, f, ..] = SimdPack::sums([x[2], y[2], z[0], z[0]]);
        [[a, b, 0.0, 0.0], [c, d, 0.0, 0.0], [e, f, 0.0, 0.0]]
    } else {
        let zero = x[0].like(0.0);
        [
            SimdPack::sums([x[0], y[0], z[0], zero]),
            SimdPack::sums([x[1], y[1], z[1], zero]),
            SimdPack::sums([x[2], y[2], z[2], zero]),
        ]
    };
    for (projected, [x, y, z, _]) in projected.iter_mut().zip(sums).take(B::WIDTH) {
        *projected += S::restrict(Vector3::new(x, y, z));
    }
}
