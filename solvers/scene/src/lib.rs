//! Scenes (grains, bodies, walls, contact laws) and the records that solvers return.
//!
//! A scene does not depend on a solver. [`source::SceneSource`] reads it from a file and resolves it to a
//! [`scene::Scene`]. A [`solver::Solver`] runs the scene and returns a [`record::Record`].

pub mod body;
pub mod brief;
pub mod budget;
mod check;
pub mod checkpoint;
pub mod columns;
pub mod contact_law;
pub mod drive;
pub mod effect;
pub mod effects;
pub mod end_state;
pub mod error;
pub mod file;
pub mod finite;
pub mod function;
pub mod generate;
pub mod grains;
pub mod kept_record;
pub mod manufactured;
pub mod material;
pub mod memory;
pub mod mesh;
pub mod motion;
mod near;
pub mod overlap;
pub mod packing;
pub mod perturbed;
pub mod pouring;
mod probe;
pub mod radii;
pub mod record;
pub mod recorder;
pub mod refined;
pub mod release;
pub mod resolve;
mod rounded_state;
pub mod scene;
mod sealed;
mod shape;
pub mod solver;
pub mod source;
pub mod space;
pub mod stays;
pub mod terms;
pub mod text;
pub mod virial;

/// Vector and matrix types of scenes and records, re-exported for authors of solvers.
pub use nalgebra;

/// Returns the JSON schema of scene files.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(file::SceneFile)
}
