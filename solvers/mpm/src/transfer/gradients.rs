//! Velocity gradients at points, and the next positions of the points.

use crate::grid::basis::Basis;
use crate::grid::patch::{Copies, StencilBlock};
use crate::points::runs::Ground;
use crate::transfer::scatter::weighted;
use grainbench_lanes::{FourKernel, FourLanes, SimdPack};
use grainbench_solver::space::Space;
use std::marker::PhantomData;

/// Kernel that computes velocity gradients (1/s) at the points of some batches of a body.
pub(crate) struct Gradients<'a, S: Space, B> {
    pub(crate) ground: Ground<'a, S>,
    /// Velocities of the nodes (m/s).
    pub(crate) velocities: &'a [S::Vector],
    pub(crate) gradients: &'a mut [S::Matrix],
    /// Next positions x_p + Δt Σ N_i(x_p) v_i (m), with the same index offset as the positions of `ground`. If `None`,
    /// they are not computed.
    pub(crate) next: Option<&'a mut [S::Vector]>,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis> FourKernel for Gradients<'_, S, B> {
    #[inline(always)]
    fn run<L: FourLanes>(self, lanes: L) {
        let Self { ground, velocities, gradients, mut next, time_step, .. } = self;
        let zero = SimdPack::splat(lanes, 0.0);
        let first = ground.runs.first().map_or(0, |run| run.start);
        let mut copies: Copies<S::Vector> = [S::ORIGIN; _];
        for run in ground.runs {
            let (seen, patch) = ground.body.window.seen::<S, B, _>(run.base, velocities, &mut copies);
            for batch in run.batches() {
                let stencil = ground.stencil::<B, L>(lanes, run, batch);
                let [values, slopes] = stencil.along_x();
                let (mut gradient, mut around) = ([[zero; 3]; 3], [zero; 3]);
                for row in 0..StencilBlock::rows::<S, B>() {
                    let across = stencil.across::<S, B>(row);
                    let nodes = &seen[patch.row::<S, B>(row)];
                    let nodes = [nodes[0], nodes[1], nodes[B::WIDTH - 1]];
                    let sums = gradient.iter_mut().zip(&mut around).enumerate().take(S::DIMENSION);
                    for (component, (gradient, around)) in sums {
                        let mut velocity = [zero; 3];
                        for (velocity, node) in velocity.iter_mut().zip(nodes) {
                            *velocity = SimdPack::splat(lanes, S::component(node, component));
                        }
                        let along = weighted::<B, _>(velocity, slopes);
                        let velocities = weighted::<B, _>(velocity, values);
                        gradient[0] = gradient[0] + along * across.value;
                        gradient[1] = gradient[1] + velocities * across.slope[0];
                        if next.is_some() {
                            *around = *around + velocities * across.value;
                        }
                        if S::DIMENSION == 3 {
                            gradient[2] = gradient[2] + velocities * across.slope[1];
                        }
                    }
                }
                batch.counted_from(first).write_matrices::<S, L>(gradient, gradients);
                if let Some(next) = &mut next {
                    let batch = batch.counted_from(ground.first);
                    let mut position = batch.vectors::<S, L>(lanes, ground.position);
                    for (position, around) in position.iter_mut().zip(around).take(S::DIMENSION) {
                        *position = *position + around * time_step;
                    }
                    batch.write_vectors::<S, L>(position, next);
                }
            }
        }
    }
}
