//! From velocity gradients to deformation and stress, material by material.

use crate::basis::with_basis;
use crate::bodies::Body;
use crate::failure::Failure;
use crate::gradients::Gradients;
use crate::grid::Node;
use crate::ledger::Flow;
use crate::material::{Law, PlasticStrain, VolumeRatio, with_law};
use crate::nodes::{Grid, Velocities};
use crate::options::Transfer;
use crate::points::Lent;
use crate::runs::{self, Ground, LONGEST};
use crate::scheme::Scheme;
use crate::share::{Share, Way};
use crate::state::State;
use grainbench_lanes::logarithm::ln;
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_scene::solver::Cause;
use grainbench_scene::space::Space;
use nalgebra::Matrix3;
use std::ops::Range;

/// A point whose state broke.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BrokenPoint {
    point: usize,
    cause: Cause,
}

/// The deformation gradient in three dimensions: in the plane nothing is stretched out of it.
#[inline(always)]
pub(crate) fn embed_deformation<S: Space>(deformation: S::Matrix) -> Matrix3<f64> {
    let mut full = S::embed_gradient(deformation);
    if S::DIMENSION == 2 {
        full.m33 = 1.0;
    }
    full
}

/// Velocity gradients, then deformation and stress of the points, with `then` what comes next for those of a share. What they
/// tell the budget, if it `counts`, and the farthest of what `then` gives.
///
/// # Errors
/// With the first point that broke.
pub(crate) fn follow<S: Space>(
    scheme: &Scheme,
    state: &mut State<S>,
    grid: (&Grid<S>, Velocities),
    counts: bool,
    then: impl Fn(&mut Share<S>, &mut Lent<'_, S>) -> Way + Sync,
) -> Result<(Flow, Way), Failure> {
    let State { bodies, points, shares, team, .. } = state;
    let mut left = points.lent();
    let parts = shares.iter_mut().map(|share| (left.take_off(share.points.len()), share));
    let follow = |_, (mut points, share): (Lent<'_, S>, &mut Share<S>)| {
        share.failure = None;
        share.flows.clear();
        for number in 0..share.pieces.len() {
            follow_piece(scheme, share, number, bodies, &mut points, grid, counts);
        }
        then(share, &mut points)
    };
    let way = team.fold(parts, follow, Way::default(), Way::farther);
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

/// The same of a piece of a share.
fn follow_piece<S: Space>(
    scheme: &Scheme,
    share: &mut Share<S>,
    number: usize,
    bodies: &[Body],
    points: &mut Lent<'_, S>,
    (grid, velocities): (&Grid<S>, Velocities),
    counts: bool,
) {
    let Grid { lattice, nodes, projected, .. } = grid;
    let Scheme { setting, time_step, processor } = *scheme;
    let Share { runs, pieces, gradients, flows, failure, .. } = share;
    let (spins, piece) = (setting.transfer == Transfer::Spin, &pieces[number]);
    let Body { part, law, owner, .. } = &bodies[piece.body];
    let mut broken = None;
    for runs in runs::in_groups(&runs[piece.runs.clone()]) {
        let ground = Ground::lent(lattice, part, runs, points);
        with_basis!(setting.basis, B => match velocities {
            Velocities::Stepped => {
                let velocity = |node: &Node<S>| node.velocity;
                processor.run_by_four(Gradients::<S, B, _, _>::new(ground, nodes, velocity, gradients));
            }
            Velocities::Projected => {
                let velocity = |velocity: &S::Vector| *velocity;
                processor.run_by_four(Gradients::<S, B, _, _>::new(ground, projected, velocity, gradients));
            }
        });
        let first = runs[0].start;
        let whole = first..runs[runs.len() - 1].end;
        macro_rules! update {
            ($law:ident, $count:literal, $range:expr, $flow:expr) => {{
                let (law, range, flow, failure): (_, Range<usize>, _, _) = ($law, $range, $flow, &mut broken);
                let gradients = &gradients[range.start - first..range.end - first];
                let update: Update<'_, '_, S, _, $count> =
                    Update { law, range, gradients, time_step, spins, points, flow, failure };
                processor.run_by_four(update);
            }};
            ($law:ident) => {
                if counts {
                    // Run by run, for these do not depend on the shares.
                    for run in runs {
                        let mut flow = Flow::default();
                        update!($law, true, run.start..run.end, &mut flow);
                        flows.push(flow);
                    }
                } else {
                    update!($law, false, whole, &mut Flow::default())
                }
            };
        }
        with_law!(*law, law => update!(law));
    }
    if let Some(BrokenPoint { point, cause }) = broken
        && failure.is_none()
    {
        let position = S::embed(points.position[point - points.first]);
        *failure = Some(Failure { owner: *owner, position, cause });
    }
}

/// F ← (1 + Δt ∇v) F, volume and stress of every point of a range, of which `gradients` are the velocity gradients
/// (1/s). With `COUNT` adds to `flow` what the stresses after the step take on the strain of it, the work of
/// plastic flow: the flow stress after the step times the plastic strain of it, on the mean volume; and that against
/// viscosity: half of what the viscous stresses before and after the step do on the strain of it.
///
/// Where points carry `spins` of their own, one that flows takes on that of the velocities around it: what it shared
/// its spin with has moved on, and spins that nothing answers to grow until a grain of a few cells flies apart.
struct Update<'a, 'b, S: Space, L, const COUNT: bool> {
    law: L,
    range: Range<usize>,
    gradients: &'a [S::Matrix],
    time_step: f64,
    spins: bool,
    points: &'a mut Lent<'b, S>,
    flow: &'a mut Flow,
    /// The first point that broke, if any did.
    failure: &'a mut Option<BrokenPoint>,
}

impl<S: Space, L: Law, const COUNT: bool> FourKernel for Update<'_, '_, S, L, COUNT> {
    #[inline(always)]
    fn run<R: FourLanes>(self, _: R) {
        let Self { law, range, gradients, time_step, spins, points, flow, failure } = self;
        let first = points.first;
        let affines = &mut points.affine;
        let range = range.start - first..range.end - first;
        let deformations = &mut points.deformation[range.clone()];
        let stresses = &mut points.stress[range.clone()];
        let plastic_strains = L::PlasticStrain::those_of(points.plastic_strain, range.clone());
        let (volumes, references) = (&mut points.volume[range.clone()], &points.reference_volume[range.clone()]);
        let (mut ratios, mut logarithms) = ([0.0; LONGEST], [0.0; LONGEST]);
        // Work against viscosity is added up point by point, before the step and after it.
        let at_once = if COUNT && L::VISCOUS { 1 } else { LONGEST };
        for from in (0..gradients.len()).step_by(at_once) {
            let some = from..gradients.len().min(from + at_once);
            if L::LOGARITHM {
                let states = deformations[some.clone()].iter_mut().zip(&stresses[some.clone()]);
                let sizes = volumes[some.clone()].iter().zip(&references[some.clone()]);
                for (((deformation, stress), gradient), ((volume, reference), ratio)) in
                    states.zip(&gradients[some.clone()]).zip(sizes.zip(&mut ratios))
                {
                    let increment = *gradient * time_step;
                    if COUNT && L::VISCOUS {
                        let strain = S::symmetric_part(increment);
                        flow.viscous +=
                            0.5 * volume * law.viscous_work::<S>(strain, volume / reference, *deformation, *stress);
                    }
                    *ratio = deformed::<S>(deformation, increment);
                }
                for (logarithm, &ratio) in logarithms.iter_mut().zip(&ratios).take(some.len()) {
                    *logarithm = ln(ratio);
                }
            }
            let found = ratios.iter().zip(&logarithms);
            let states = deformations[some.clone()].iter_mut().zip(&mut stresses[some.clone()]);
            let sizes = volumes[some.clone()].iter_mut().zip(&references[some.clone()]);
            for ((place, gradient), ((deformation, stress), ((volume, reference), (&ratio, &logarithm)))) in
                some.clone().zip(&gradients[some.clone()]).zip(states.zip(sizes.zip(found)))
            {
                let (at, increment) = (range.start + place, *gradient * time_step);
                let volume_ratio = if L::LOGARITHM { ratio } else { deformed::<S>(deformation, increment) };
                if (volume_ratio <= 0.0 || volume_ratio.is_nan()) && failure.is_none() {
                    *failure = Some(BrokenPoint { point: first + at, cause: cause::<S>(increment, volume_ratio) });
                }
                let mut plastic_strain = L::PlasticStrain::read(plastic_strains, place);
                let before = (*volume, plastic_strain.value());
                *volume = reference * volume_ratio;
                let ratio = VolumeRatio { ratio: volume_ratio, logarithm };
                *stress = law.follow::<S>(increment, ratio, *deformation, *stress, &mut plastic_strain);
                let flown = plastic_strain.value() - before.1;
                plastic_strain.write(plastic_strains, place);
                if spins && flown > 0.0 {
                    let strain_rate = S::embed_symmetric(S::symmetric_part(*gradient));
                    affines[at] = S::restrict_gradient(S::embed_gradient(*gradient) - strain_rate);
                }
                if COUNT {
                    let strain = S::symmetric_part(increment);
                    flow.taken += *volume * S::double_dot(*stress, strain);
                    if L::VISCOUS {
                        flow.viscous +=
                            0.5 * *volume * law.viscous_work::<S>(strain, volume_ratio, *deformation, *stress);
                    }
                    if flown > 0.0 {
                        flow.plastic += 0.5 * (before.0 + *volume) * law.flow_stress(plastic_strain) * flown;
                    }
                }
            }
        }
    }
}

/// Deforms what a point is by F ← (1 + Δt ∇v) F. Gives its volume over that at the start.
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
