//! Benchmark cases: scenes, levels of resolution, claims and their negative controls.
//!
//! A case is a folder beside `src`: `scene.toml`, `case.rs` with claims and figures, and `derivation.md`. A folder that
//! has a `scene.toml` is in the registry.

pub mod exact;
pub mod folder;
pub mod kept;
pub mod registry;
pub mod rows;
mod silo;
pub mod solvers;
pub mod sources;
pub mod stage;
pub mod stored;
pub mod uncertainty;
mod varied;

pub use grainbench_harness::case::Case;
pub use registry::runner;
