//! Deformation and stress from velocity gradients, material by material.

use crate::energy::ledger::Flow;
use crate::failure::Failure;
use crate::grid::basis::with_basis;
use crate::grid::nodes::Grid;
use crate::material::{Law, PointStep, VolumeRatio, with_law};
use crate::options::Transfer;
use crate::points::arrays::PointsMut;
use crate::points::body::Body;
use crate::points::runs::{self, Ground, LONGEST, ParticleBatch};
use crate::points::share::{LargestDisplacement, ThreadPartition};
use crate::points::state::State;
use crate::scheme::Scheme;
use crate::transfer::gradients::Gradients;
use grainbench_lanes::logarithm::ln;
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_solver::failure::Cause;
use grainbench_solver::record::Owner;
use grainbench_solver::space::Space;
use nalgebra::Matrix3;
use std::marker::PhantomData;

/// Returns the deformation gradient in three dimensions; in plane strain the out-of-plane stretch is one.
#[inline(always)]
pub(crate) fn embed_deformation<S: Space>(deformation: S::Matrix) -> Matrix3<f64> {
    let mut full = S::embed_gradient(deformation);
    if S::DIMENSION == 2 {
        full.m33 = 1.0;
    }
    full
}

/// Computes velocity gradients, deformation and stress of the points from the projected velocities. With `start`, the
/// [`Basis::START`](crate::grid::basis::Basis::START) of the basis, it then moves the points.
///
/// Returns the energies for the budget (zero unless `counts`) and the largest displacement of a point.
///
/// # Errors
/// Returns the failure of the first point with an invalid state.
pub(crate) fn follow<S: Space>(
    scheme: &Scheme,
    state: &mut State<S>,
    grid: &Grid<S>,
    counts: bool,
    start: Option<f64>,
) -> Result<(Flow, LargestDisplacement), Failure> {
    let State { bodies, points, shares, team, .. } = state;
    let mut left = points.lent();
    let parts = shares.iter_mut().map(|share| (left.take_off(share.points.len()), share));
    let follow = |_, (mut points, share): (PointsMut<'_, S>, &mut ThreadPartition<S>)| {
        share.failure = None;
        share.flows.clear();
        for number in 0..share.pieces.len() {
            follow_piece(scheme, share, number, bodies, &mut points, grid, counts);
        }
        start.map_or_else(Default::default, |start| share.move_points(&mut points, &grid.lattice, start))
    };
    let way = team.fold(parts, follow, LargestDisplacement::default(), LargestDisplacement::farther);
    if let Some(failure) = shares.iter_mut().find_map(|share| share.failure.take()) {
        return Err(failure);
    }
    let mut flow = Flow::default();
    for part in shares.iter().flat_map(|share| &share.flows) {
        flow.taken += part.taken;
        flow.plastic += part.plastic;
        flow.viscous += part.viscous;
    }
    Ok((flow, way))
}

/// Computes gradients, deformation and stress for the points of one body in a partition.
fn follow_piece<S: Space>(
    scheme: &Scheme,
    share: &mut ThreadPartition<S>,
    number: usize,
    bodies: &[Body],
    points: &mut PointsMut<'_, S>,
    Grid { lattice, projected: velocities, .. }: &Grid<S>,
    counts: bool,
) {
    let Scheme { setting, time_step, processor } = *scheme;
    let ThreadPartition { runs, pieces, gradients, flows, failure, .. } = share;
    let (spins, piece) = (setting.transfer == Transfer::Spin, &pieces[number]);
    let body = &bodies[piece.body];
    for runs in runs::in_groups(&runs[piece.runs.clone()]) {
        let (ground, next) = Ground::lent(lattice, body, runs, points);
        let next = scheme.moves_with_stress().then_some(next);
        with_basis!(setting.basis, B => {
            let basis = PhantomData::<B>;
            processor.run_by_four(Gradients { ground, velocities, gradients, next, time_step, basis });
        });
        let (gradients, owner) = (&gradients[..], body.owner);
        with_law!(body.law, law => {
            let update = Update { law, owner, runs, gradients, time_step, spins, counts, points, flows, failure };
            processor.run_by_four(update);
        });
    }
}

/// Kernel of the update F ← (1 + Δt ∇v) F, of volume and of stress, for every point of some batches. `gradients`
/// contains the velocity gradients ∇v (1/s).
///
/// With `counts` it records three energies of each batch. The first is the work of the stresses after the step on the
/// strain of the step. The second is the plastic work: the flow stress after the step times the plastic strain
/// increment, on the mean volume. The third is the work against viscosity: half of the work of viscous stresses before
/// and after the step on the strain of the step.
///
/// With `spins`, points have a spin, and a yielding point takes the spin of the velocity field around it, because its
/// neighbours with the same spin have moved away. Without this rule, unbalanced spins would grow until a grain of a few
/// cells breaks apart.
struct Update<'a, 'b, S: Space, L> {
    law: L,
    owner: Owner,
    /// Consecutive batches with at most [`LONGEST`] points in all.
    runs: &'a [ParticleBatch],
    gradients: &'a [S::Matrix],
    time_step: f64,
    spins: bool,
    counts: bool,
    points: &'a mut PointsMut<'b, S>,
    /// Energies of each batch. Batches do not depend on the thread partitions.
    flows: &'a mut Vec<Flow>,
    /// Failure of the first point with an invalid state.
    failure: &'a mut Option<Failure>,
}

impl<S: Space, L: Law> FourKernel for Update<'_, '_, S, L> {
    #[inline(always)]
    fn run<R: FourLanes>(self, _: R) {
        let Self { law, owner, runs, gradients, time_step, spins, counts, points, flows, failure } = self;
        let (first, start, end) = (points.first, runs[0].start, runs[runs.len() - 1].end);
        let range = start - first..end - first;
        let affines = &mut points.affine;
        let gradients = &gradients[..range.len()];
        let deformations = &mut points.deformation[range.clone()];
        let stresses = &mut points.stress[range.clone()];
        let plastic_strains = if L::YIELDS { &mut points.plastic_strain[range.clone()] } else { &mut [] };
        let (volumes, references) = (&mut points.volume[range.clone()], &points.reference_volume[range.clone()]);
        // Values computed for many points at once: volume ratios, their logarithms, 3/2 s:s, and work against
        // viscosity.
        let (mut ratios, mut logarithms) = ([0.0; LONGEST], [0.0; LONGEST]);
        let (mut squares, mut works) = ([0.0; LONGEST], [0.0; LONGEST]);
        if counts && L::VISCOUS {
            for (at, work) in works.iter_mut().enumerate().take(range.len()) {
                let (increment, volume) = (gradients[at] * time_step, VolumeRatio::new(volumes[at] / references[at]));
                let step = PointStep { increment, deformation: deformations[at], volume, stress: stresses[at] };
                *work = 0.5 * volumes[at] * law.viscous_work::<S>(step);
            }
        }
        for ((deformation, gradient), ratio) in deformations.iter_mut().zip(gradients).zip(&mut ratios) {
            *ratio = deformed::<S>(deformation, *gradient * time_step);
        }
        if L::LOGARITHM {
            for (logarithm, &ratio) in logarithms.iter_mut().zip(&ratios).take(range.len()) {
                *logarithm = ln(ratio);
            }
        }
        if L::TRIES {
            for ((stress, gradient), square) in stresses.iter_mut().zip(gradients).zip(&mut squares) {
                (*stress, *square) = law.trial::<S>(*gradient * time_step, *stress);
            }
        }
        for run in runs {
            let mut flow = Flow::default();
            for place in run.start - start..run.end - start {
                let increment = gradients[place] * time_step;
                let (deformation, stress, volume) = (deformations[place], &mut stresses[place], &mut volumes[place]);
                let ratio = ratios[place];
                if (ratio <= 0.0 || ratio.is_nan()) && failure.is_none() {
                    let position = S::embed(points.position[range.start + place]);
                    *failure = Some(Failure { owner, position, cause: cause::<S>(increment, ratio) });
                }
                let mut plastic_strain = if L::YIELDS { plastic_strains[place] } else { 0.0 };
                let before = (*volume, plastic_strain);
                *volume = references[place] * ratio;
                let ratio = VolumeRatio { ratio, logarithm: logarithms[place] };
                let step = PointStep { increment, deformation, volume: ratio, stress: *stress };
                *stress = if L::TRIES {
                    law.flow::<S>((*stress, squares[place]), &mut plastic_strain)
                } else {
                    law.follow::<S>(step, &mut plastic_strain)
                };
                let flown = plastic_strain - before.1;
                if L::YIELDS {
                    plastic_strains[place] = plastic_strain;
                }
                if spins && flown > 0.0 {
                    let strain_rate = S::embed_symmetric(S::symmetric_part(gradients[place]));
                    affines[range.start + place] =
                        S::restrict_gradient(S::embed_gradient(gradients[place]) - strain_rate);
                }
                if counts {
                    flow.taken += *volume * S::double_dot(*stress, S::symmetric_part(increment));
                    if L::VISCOUS {
                        flow.viscous += works[place];
                        flow.viscous += 0.5 * *volume * law.viscous_work::<S>(PointStep { stress: *stress, ..step });
                    }
                    if flown > 0.0 {
                        flow.plastic += 0.5 * (before.0 + *volume) * law.flow_stress(plastic_strain) * flown;
                    }
                }
            }
            if counts {
                flows.push(flow);
            }
        }
    }
}

/// Updates the deformation F ← (1 + Δt ∇v) F and returns the ratio of volume to initial volume.
#[inline(always)]
fn deformed<S: Space>(deformation: &mut S::Matrix, increment: S::Matrix) -> f64 {
    *deformation = *deformation + increment * *deformation;
    S::determinant(*deformation)
}

fn cause<S: Space>(increment: S::Matrix, volume_ratio: f64) -> Cause {
    let step_ratio = S::determinant(increment + S::restrict_gradient(Matrix3::identity()));
    if !(volume_ratio.is_finite() && step_ratio.is_finite()) {
        Cause::NotFinite
    } else if step_ratio <= 0.0 {
        Cause::CollapsedCell { volume_ratio: step_ratio }
    } else {
        Cause::Inverted { volume_ratio }
    }
}
