//! Scenes: grains, bodies, walls, contact laws and motions.
//!
//! A scene does not depend on a solver. [`source::SceneSource`] reads it from a file and resolves it to a
//! [`scene::Scene`].

pub mod body;
mod check;
pub mod columns;
pub mod contact_law;
pub mod dimension;
pub mod effect;
pub mod effects;
pub mod end_state;
pub mod error;
pub mod file;
pub mod function;
pub mod generate;
mod grain;
pub mod manufactured;
pub mod material;
pub mod memory;
pub mod mesh;
pub mod method;
pub mod motion;
mod near;
pub mod overlap;
pub mod packing;
pub mod pouring;
pub mod radii;
pub mod release;
pub mod resolve;
mod rounded_state;
pub mod scene;
mod scene_file;
pub mod sealed;
mod shape;
pub mod source;
mod state_file;
pub mod stays;
pub mod text;
pub mod toml_error;

/// Vector and matrix types of scenes and of records, re-exported for authors of solvers.
pub use nalgebra;

/// Returns the JSON schema of scene files.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(file::SceneFile)
}
