//! From velocity gradients to deformation and stress, material by material.

use crate::basis::with_basis;
use crate::bodies::{Body, Material};
use crate::failure::Failure;
use crate::gradients::Gradients;
use crate::grid::Node;
use crate::ledger::Flow;
use crate::material::{Law, PlasticStrain};
use crate::nodes::{Grid, Velocities};
use crate::options::Transfer;
use crate::points::Points;
use crate::runs::{self, Ground};
use crate::scheme::Scheme;
use crate::state::State;
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

/// Velocity gradients, then deformation and stress of the points of a body; what they tell the budget is added to
/// `flow` if it `counts`.
///
/// # Errors
/// With the first point that broke.
pub(crate) fn follow<S: Space>(
    scheme: &Scheme,
    state: &mut State<S>,
    place: usize,
    (grid, velocities): (&Grid<S>, Velocities),
    flow: &mut Flow,
    counts: bool,
) -> Result<(), Failure> {
    let Grid { lattice, nodes, projected, .. } = grid;
    let Scheme { setting, time_step, processor } = *scheme;
    let State { bodies, points, runs, gradients, .. } = state;
    let spins = setting.transfer == Transfer::Spin;
    let Body { part, law, .. } = &bodies[place];
    let mut failure = None;
    for runs in runs::in_groups(&runs[part.runs.clone()]) {
        let range = runs[0].start..runs[runs.len() - 1].end;
        let ground = Ground::new(lattice, part, runs, points);
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
        macro_rules! update {
            ($law:ident, $count:literal) => {{
                let (law, failure) = ($law, &mut failure);
                let update: Update<'_, S, _, $count> =
                    Update { law, range, gradients, time_step, spins, points, flow, failure };
                processor.run_by_four(update);
            }};
            ($law:ident) => {
                if counts { update!($law, true) } else { update!($law, false) }
            };
        }
        match *law {
            Material::NeoHookean(law) => update!(law),
            Material::Hypoelastic(law) => update!(law),
            Material::VonMises(law) => update!(law),
        }
    }
    match failure {
        None => Ok(()),
        Some(BrokenPoint { point, cause }) => Err(state.failure(place, point, cause)),
    }
}

/// F ← (1 + Δt ∇v) F, volume and stress of every point of a range, of which `gradients` are the velocity gradients
/// (1/s). With `COUNT` adds to `flow` what the stresses after the step take on the strain of it, and the work of
/// plastic flow: the flow stress after the step times the plastic strain of it, on the mean volume.
///
/// Where points carry `spins` of their own, one that flows takes on that of the velocities around it: what it shared
/// its spin with has moved on, and spins that nothing answers to grow until a grain of a few cells flies apart.
struct Update<'a, S: Space, L, const COUNT: bool> {
    law: L,
    range: Range<usize>,
    gradients: &'a [S::Matrix],
    time_step: f64,
    spins: bool,
    points: &'a mut Points<S>,
    flow: &'a mut Flow,
    /// The first point that broke, if any did.
    failure: &'a mut Option<BrokenPoint>,
}

impl<S: Space, L: Law, const COUNT: bool> FourKernel for Update<'_, S, L, COUNT> {
    #[inline(always)]
    fn run<R: FourLanes>(self, _: R) {
        let Self { law, range, gradients, time_step, spins, points, flow, failure } = self;
        let affines = &mut points.affine;
        let deformations = &mut points.deformation[range.clone()];
        let stresses = &mut points.stress[range.clone()];
        let plastic_strains = L::PlasticStrain::those_of(&mut points.plastic_strain, range.clone());
        let volumes = points.volume[range.clone()].iter_mut().zip(&points.reference_volume[range.clone()]);
        let states = deformations.iter_mut().zip(stresses).zip(volumes);
        for (place, ((at, gradient), ((deformation, stress), (volume, reference)))) in
            range.zip(gradients).zip(states).enumerate()
        {
            let increment = *gradient * time_step;
            *deformation = *deformation + increment * *deformation;
            let volume_ratio = S::determinant(*deformation);
            if (volume_ratio <= 0.0 || volume_ratio.is_nan()) && failure.is_none() {
                *failure = Some(BrokenPoint { point: at, cause: cause::<S>(increment, volume_ratio) });
            }
            let mut plastic_strain = L::PlasticStrain::read(plastic_strains, place);
            let before = (*volume, plastic_strain.value());
            *volume = reference * volume_ratio;
            *stress = law.follow::<S>(increment, volume_ratio, *deformation, *stress, &mut plastic_strain);
            let flown = plastic_strain.value() - before.1;
            plastic_strain.write(plastic_strains, place);
            if spins && flown > 0.0 {
                let strain_rate = S::embed_symmetric(S::symmetric_part(*gradient));
                affines[at] = S::restrict_gradient(S::embed_gradient(*gradient) - strain_rate);
            }
            if COUNT {
                flow.taken += *volume * S::double_dot(*stress, S::symmetric_part(increment));
                if flown > 0.0 {
                    flow.plastic += 0.5 * (before.0 + *volume) * law.flow_stress(plastic_strain) * flown;
                }
            }
        }
    }
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
