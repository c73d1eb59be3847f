//! Deformable body of a simulation.

use crate::material::Material;
use crate::transfer::Part;
use grainbench_scene::body::Sides;
use grainbench_scene::manufactured::Medium;
use grainbench_scene::material::Deformable;
use grainbench_solver::record::Owner;
use nalgebra::Vector3;
use std::ops::Range;

/// Deformable body with its points, surface and material.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) owner: Owner,
    /// Points of the body, and the window of nodes that they influence.
    pub(crate) part: Part,
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
}
