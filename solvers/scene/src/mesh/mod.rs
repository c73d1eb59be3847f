//! Walls of triangles: read from STL, checked, and asked what a sphere touches.
//!
//! A mesh is taken for the surface that it is, whatever its triangles are: triangles in one plane that hang together are one
//! *patch*, edges in one line between the same patches one *ridge*, and what is left are *corners*. A sphere touches each of
//! these once at most (`touch`).

mod build;
mod flaw;
mod geometry;
mod groups;
pub mod stl;
mod touch;
mod tree;

pub use build::{Reading, Surface};
pub use flaw::Flaw;
pub use touch::Touched;

use crate::motion::{Displacement, Motion};
use nalgebra::{Rotation3, Vector3};
use std::sync::Arc;

/// A mesh where it is now: it is turned about where its file has its origin, and that origin moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The surface in the coordinates of its file (m).
    pub surface: Arc<Surface>,
    /// How it is turned.
    pub turn: Rotation3<f64>,
    /// Where the origin is (m).
    pub origin: Vector3<f64>,
}

impl Mesh {
    /// A surface where its file has it.
    #[must_use]
    pub fn at_rest(surface: Surface) -> Self {
        Self { surface: Arc::new(surface), turn: Rotation3::identity(), origin: Vector3::zeros() }
    }

    /// After its wall has moved.
    #[must_use]
    pub fn moved(&self, motion: &Motion, displacement: &Displacement) -> Self {
        Self {
            surface: Arc::clone(&self.surface),
            turn: motion.turning(displacement) * self.turn,
            origin: motion.moved(self.origin, displacement),
        }
    }

    /// A place in the coordinates of the file (m).
    #[must_use]
    pub fn within(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.turn.inverse_transform_vector(&(place - self.origin))
    }

    /// Where a point of the surface is (m).
    #[must_use]
    pub fn place(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.origin + self.turn * point
    }

    /// The point of the surface that is nearest to a place (m).
    #[must_use]
    pub fn nearest(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.place(self.surface.nearest(self.within(place)))
    }

    /// The corners of all triangles where they are now (m).
    pub fn triangles(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        self.surface.triangles().iter().map(|triangle| triangle.map(|corner| self.place(corner)))
    }
}
