//! From nodes to points (G2P): velocities and the way that they go.
//!
//! Over the nodes i that reach a point p, with N_i their basis functions, v_i and Δv_i their velocities after the step
//! and the change of these in it (m/s):
//!
//! - v_p ← keep v_p + Σ N_i(x_p) Δv_i, where points keep their velocity (Brackbill & Ruppel 1986), or Σ N_i(x_p) v_i;
//!   keep is what damping leaves ([`Damping`]);
//! - x_p ← x_p + Δt Σ N_i(x_p) v_i, positions (m);
//! - A_p ← Σ v_i ⊗ N_i (x_i − x_p) D⁻¹, D = Σ N_i (x_i − x_p) ⊗ (x_i − x_p), where points carry an affine part (1/s)
//!   (Jiang et al. 2015);
//! - and once more to the nodes, for MUSL, p_i = Σ N_i(x_p) m_p (v_p + A_p (x_i − x_p)) with these (Sulsky, Zhou &
//!   Schreyer 1995).

use crate::basis::{Basis, with_basis};
use crate::damping::Damping;
use crate::grid::{Lattice, Node};
use crate::nodes::Grid;
use crate::options;
use crate::patch::{Copies, Patch};
use crate::points::Points;
use crate::runs::{Ground, Run};
use crate::scatter::{Shown, weighted};
use crate::scheme::Scheme;
use crate::state::State;
use crate::transfer::{Apic, Flip, Part, Spin, Transfer};
use grainbench_lanes::{FourKernel, FourLanes, Number, Wide};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::marker::PhantomData;

/// Points take velocities and the way that they go from the nodes, body by body.
pub(crate) fn gather<S: Space>(
    scheme: &Scheme,
    Damping { keep, .. }: Damping,
    state: &mut State<S>,
    grid: &mut Grid<S>,
) {
    let Grid { lattice, nodes, projected, .. } = grid;
    let State { bodies, points, runs, .. } = state;
    let Scheme { setting, time_step, processor } = *scheme;
    macro_rules! gather {
        ($B:ty, $T:ty, $transfer:expr, $part:expr, $project:literal) => {{
            let (transfer, part, basis) = ($transfer, $part, PhantomData::<$B>);
            let runs = &runs[part.runs.clone()];
            let gather: Gather<'_, S, $B, $T, $project> =
                Gather { lattice, part, runs, transfer, time_step, keep, points, nodes, projected, basis };
            processor.run_by_four(gather);
        }};
        ($B:ty, $T:ty, $transfer:expr, $part:expr) => {
            if scheme.is_projected() {
                gather!($B, $T, $transfer, $part, true)
            } else {
                gather!($B, $T, $transfer, $part, false)
            }
        };
    }
    for body in bodies.iter() {
        with_basis!(setting.basis, B => match setting.transfer {
            options::Transfer::Flip { pic } => gather!(B, Flip, Flip { pic }, &body.part),
            options::Transfer::Apic => gather!(B, Apic, Apic, &body.part),
            options::Transfer::Spin => gather!(B, Spin, Spin, &body.part),
        });
    }
}

/// Velocity and next position of a body's points from its nodes; and, with `PROJECT`, the momentum of the points with
/// their new velocity back to the nodes (MUSL).
struct Gather<'a, S: Space, B, T, const PROJECT: bool> {
    lattice: &'a Lattice,
    part: &'a Part,
    runs: &'a [Run],
    transfer: T,
    time_step: f64,
    /// What damping leaves of a velocity in a step.
    keep: f64,
    points: &'a mut Points<S>,
    nodes: &'a [Node<S>],
    projected: &'a mut [S::Vector],
    basis: PhantomData<B>,
}

impl<S: Space, B: Basis, T: Transfer, const PROJECT: bool> FourKernel for Gather<'_, S, B, T, PROJECT> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { lattice, part, runs, transfer, time_step, keep, points, nodes, projected, .. } = self;
        let zero = Wide::splat(lanes, 0.0);
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
                    let nodes = [&nodes[0], &nodes[1], &nodes[B::WIDTH - 1]];
                    for component in 0..S::DIMENSION {
                        let (mut velocity, mut changed) = ([zero; 3], [zero; 3]);
                        for (node, at) in nodes.into_iter().enumerate() {
                            velocity[node] = Wide::splat(lanes, S::component(at.velocity, component));
                            changed[node] = Wide::splat(lanes, S::component(at.change, component));
                        }
                        let velocities = weighted::<B, _>(velocity, values);
                        let changes = weighted::<B, _>(changed, values);
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
                let position = batch.vectors::<S, L>(lanes, &points.position);
                let (mut velocity, mut next) = (before, position);
                for axis in 0..S::DIMENSION {
                    velocity[axis] = transfer.taken(before[axis] * keep, around[axis], change[axis]);
                    next[axis] = position[axis] + around[axis] * time_step;
                }
                batch.write_vectors::<S, L>(velocity, &mut points.velocity);
                batch.write_vectors::<S, L>(next, &mut points.next);
                let mut affine = [[zero; 3]; 3];
                if T::AFFINE {
                    let mut before = batch.matrices::<S, L>(lanes, &points.affine);
                    for row in before.iter_mut().take(S::DIMENSION) {
                        for part in row.iter_mut().take(S::DIMENSION) {
                            *part = *part * keep;
                        }
                    }
                    affine = T::carried::<S, _>(before, made, &stencil);
                    batch.write_matrices::<S, L>(affine, &mut points.affine);
                }
                if PROJECT {
                    let shown = Shown::new::<S, T>(&lattice.cell, &stencil, velocity, affine);
                    let mass = batch.amounts(lanes, &points.mass);
                    let masses = Wide::scaled(values, mass);
                    for row in 0..Patch::rows::<S, B>() {
                        let across = stencil.across::<S, B>(row);
                        let masses = Wide::scaled(masses, across.value);
                        let mut momenta = [[zero; 3]; 3];
                        for (component, momenta) in momenta.iter_mut().enumerate().take(S::DIMENSION) {
                            let velocities = shown.row::<S, B, T>(row, component);
                            for (node, momentum) in momenta.iter_mut().enumerate().take(B::WIDTH) {
                                *momentum = masses[node] * velocities[node];
                            }
                        }
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

/// Adds momentum from four points, component by component, to the nodes of a row.
#[inline(always)]
fn give<S: Space, B: Basis, L: FourLanes>([x, y, z]: [[Wide<L>; 3]; 3], projected: &mut [S::Vector]) {
    let sums = if S::DIMENSION == 2 {
        let [a, b, c, d] = Wide::sums([x[0], y[0], x[1], y[1]]);
        let [e, f, ..] = Wide::sums([x[2], y[2], z[0], z[0]]);
        [[a, b, 0.0, 0.0], [c, d, 0.0, 0.0], [e, f, 0.0, 0.0]]
    } else {
        let zero = x[0].like(0.0);
        [
            Wide::sums([x[0], y[0], z[0], zero]),
            Wide::sums([x[1], y[1], z[1], zero]),
            Wide::sums([x[2], y[2], z[2], zero]),
        ]
    };
    for (projected, [x, y, z, _]) in projected.iter_mut().zip(sums).take(B::WIDTH) {
        *projected += S::restrict(Vector3::new(x, y, z));
    }
}
