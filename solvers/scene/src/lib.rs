//! Scenes of grains: what exists, which physics acts, and what a solver leaves behind.
//!
//! A scene names no solver. It is read from a file ([`source::SceneSource`]), made definite ([`scene::Scene`]), and
//! given to a [`solver::Solver`], which leaves a [`record::Record`].

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

/// The vectors of scenes and records, for who writes a solver.
pub use nalgebra;

/// The JSON schema of scene files.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(file::SceneFile)
}
