//! From velocity gradients to deformation and stress, material by material.

use crate::accounts::Flow;
use crate::lanes::{Kernel, Lanes};
use crate::material::{Law, PlasticStrain};
use crate::points::Points;
use grainbench_scene::solver::Cause;
use grainbench_scene::space::Space;
use nalgebra::Matrix3;
use std::ops::Range;

/// A point whose state broke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Failure {
    pub(crate) point: usize,
    pub(crate) cause: Cause,
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

/// F ← (1 + Δt ∇v) F, volume and stress of every point of a range, of which `gradients` are the velocity gradients (1/s).
/// With `COUNT` adds to `flow` what the stresses after the step take on the strain of it,
/// and the work of plastic flow: the flow stress after the step times the plastic strain of it, on the mean volume.
///
/// Where points carry `spins` of their own, one that flows takes on that of the velocities around it: what it shared its spin with has
/// moved on, and spins that nothing answers to grow until a grain of a few cells flies apart.
pub(crate) struct Update<'a, S: Space, L, const COUNT: bool> {
    pub(crate) law: L,
    pub(crate) range: Range<usize>,
    pub(crate) gradients: &'a [S::Matrix],
    pub(crate) time_step: f64,
    pub(crate) spins: bool,
    pub(crate) points: &'a mut Points<S>,
    pub(crate) flow: &'a mut Flow,
    /// The first point that broke, if any did.
    pub(crate) failure: &'a mut Option<Failure>,
}

impl<S: Space, L: Law, const COUNT: bool> Kernel for Update<'_, S, L, COUNT> {
    #[inline(always)]
    fn run<R: Lanes>(self, _: R) {
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
                *failure = Some(Failure { point: at, cause: cause::<S>(increment, volume_ratio) });
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
