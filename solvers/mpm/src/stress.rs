//! From velocity gradients to deformation and stress, material by material.

use crate::material::{Law, State};
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

/// Determinant of a matrix that has nothing to do with z in the plane.
#[inline(always)]
fn determinant<S: Space>(m: &Matrix3<f64>) -> f64 {
    if S::DIMENSION == 2 { m.m11 * m.m22 - m.m12 * m.m21 } else { m.determinant() }
}

/// F ← (1 + Δt ∇v) F, volume and stress of every point; the first point that broke, if any did.
pub(crate) fn update<S: Space, L: Law>(
    law: L,
    range: Range<usize>,
    time_step: f64,
    points: &mut Points<S>,
) -> Option<Failure> {
    let mut failure = None;
    for at in range {
        let increment = points.gradient[at] * time_step;
        let deformation = points.deformation[at] + increment * points.deformation[at];
        points.deformation[at] = deformation;
        let mut state = State {
            deformation: embed_deformation::<S>(deformation),
            stress: S::embed_symmetric(points.stress[at]),
            plastic_strain: points.plastic_strain[at],
        };
        let volume_ratio = determinant::<S>(&state.deformation);
        let increment = S::embed_gradient(increment);
        if (volume_ratio <= 0.0 || volume_ratio.is_nan()) && failure.is_none() {
            failure = Some(Failure { point: at, cause: cause::<S>(&increment, volume_ratio) });
        }
        law.update(&increment, volume_ratio, &mut state);
        points.volume[at] = points.reference_volume[at] * volume_ratio;
        points.stress[at] = S::restrict_symmetric(state.stress);
        points.plastic_strain[at] = state.plastic_strain;
    }
    failure
}

fn cause<S: Space>(increment: &Matrix3<f64>, volume_ratio: f64) -> Cause {
    let step_ratio = determinant::<S>(&embed_deformation::<S>(S::restrict_gradient(increment + Matrix3::identity())));
    if !(volume_ratio.is_finite() && step_ratio.is_finite()) {
        Cause::NotFinite
    } else if step_ratio <= 0.0 {
        Cause::CollapsedCell { volume_ratio: step_ratio }
    } else {
        Cause::Inverted { volume_ratio }
    }
}
