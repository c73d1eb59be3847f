//! Deformable body of a simulation.

use crate::grid::basis::Basis;
use crate::grid::lattice::{Lattice, Stencil, Window};
use crate::material::Material;
use crate::points::arrays::Points;
use grainbench_scene::body::Sides;
use grainbench_scene::manufactured::Medium;
use grainbench_scene::material::Deformable;
use grainbench_solver::record::Owner;
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// Deformable body with its points, surface and material.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) owner: Owner,
    /// Range of the points in the point arrays.
    pub(crate) points: Range<usize>,
    /// Window of the nodes of the velocity field.
    pub(crate) window: Window,
    /// Number of batches when the points were last sorted.
    pub(crate) runs_in_order: usize,
    /// Half the extent of a point (cells), for GIMP.
    pub(crate) half: f64,
    /// Initial mass of a full cell (kg).
    pub(crate) cell_mass: f64,
    /// Range of the tracers on the surface.
    pub(crate) tracers: Range<usize>,
    /// Range of the chunks of these tracers.
    pub(crate) chunks: Range<usize>,
    /// Index of the material in the scene.
    pub(crate) material: u16,
    pub(crate) law: Material,
    pub(crate) density: f64,
    pub(crate) deformable: Deformable,
    /// Bounding box of points and tracers (m).
    pub(crate) bounds: [Vector3<f64>; 2],
    /// Rotation since the start at the last observation (rad).
    pub(crate) angle: f64,
    /// For a box with fixed or symmetry boundaries, its sides and corners (m).
    pub(crate) held: Option<(Sides, [Vector3<f64>; 2])>,
    /// Index of the group of driven grains that contains the body.
    pub(crate) driven: Option<u16>,
}

impl Body {
    /// Returns the properties that a manufactured solution needs.
    pub(crate) fn medium(&self) -> Medium {
        let Self { density, deformable, .. } = self;
        Medium { density: *density, lame: deformable.lame(), shear_modulus: deformable.shear_modulus }
    }

    /// Calls `visit` with the index and the stencil of each point.
    #[inline(always)]
    pub(crate) fn each_stencil<S: Space, B: Basis>(
        &self,
        lattice: &Lattice,
        points: &Points<S>,
        mut visit: impl FnMut(usize, &Stencil<f64>),
    ) {
        for at in self.points.clone() {
            let extent = extent::<S, B>(self.half, points.deformation[at]);
            visit(at, &Stencil::new::<S, B>(lattice, points.position[at], extent));
        }
    }
}

/// Returns the half extent of a point along each axis (cells), from the half extent of an undeformed point.
///
/// The extent grows with the stretch of material lines along the axis, √b_ii, between 1e-3 and 0.5 cells. Between these
/// limits, points remain contiguous if the stretch is along the axes, and the extent does not change under rotation.
#[inline(always)]
pub(crate) fn extent<S: Space, B: Basis>(half: f64, deformation: S::Matrix) -> [f64; 3] {
    if !B::EXTENDED {
        return [half; 3];
    }
    let f = S::embed_gradient(deformation);
    [0, 1, 2].map(|axis| {
        let stretch = (f[(axis, 0)].powi(2) + f[(axis, 1)].powi(2) + f[(axis, 2)].powi(2)).sqrt();
        (half * stretch).clamp(1e-3, 0.5)
    })
}
