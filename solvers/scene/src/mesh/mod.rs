//! Walls of triangles: reading from STL files, checks, and contacts with spheres.
//!
//! Contacts do not depend on the triangulation. Connected triangles in one plane form a *patch*. Connected edges in one
//! line between the same patches form a *ridge*. The remaining points are *corners*. A sphere has at most one contact
//! with each patch, ridge and corner (`touch`).

mod build;
mod geometry;
mod groups;
pub mod stl;
mod touch;
mod tree;

pub use build::{Reading, Surface};
pub use touch::SphereContact;

use crate::motion::{Displacement, Motion};
use nalgebra::{Rotation3, Vector3};
use std::sync::Arc;

/// Mesh at its present position. The mesh rotates about the origin of its file coordinates, and this origin moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Surface in the file coordinates (m).
    pub surface: Arc<Surface>,
    /// Present rotation.
    pub turn: Rotation3<f64>,
    /// Present position of the origin (m).
    pub origin: Vector3<f64>,
}

impl Mesh {
    /// Returns a mesh at its initial position.
    #[must_use]
    pub fn at_rest(surface: Surface) -> Self {
        Self { surface: Arc::new(surface), turn: Rotation3::identity(), origin: Vector3::zeros() }
    }

    /// Returns the mesh after a displacement of its wall.
    #[must_use]
    pub fn moved(&self, motion: &Motion, displacement: &Displacement) -> Self {
        Self {
            surface: Arc::clone(&self.surface),
            turn: motion.turning(displacement) * self.turn,
            origin: motion.moved(self.origin, displacement),
        }
    }

    /// Converts a position (m) to the file coordinates (m).
    #[must_use]
    pub fn within(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.turn.inverse_transform_vector(&(place - self.origin))
    }

    /// Returns the present position (m) of a point given in the file coordinates (m).
    #[must_use]
    pub fn place(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.origin + self.turn * point
    }

    /// Returns the point of the surface nearest to a position (m).
    #[must_use]
    pub fn nearest(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.place(self.surface.nearest(self.within(place)))
    }

    /// Returns the present corners of all triangles (m).
    pub fn triangles(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        self.surface.triangles().iter().map(|triangle| triangle.map(|corner| self.place(corner)))
    }
}
