//! Benchmark cases: scenes, levels of resolution, claims and their negative controls.
//!
//! A case is a folder beside `src` with `scene.toml`, its claims (`claims.toml`, or `case.rs` with `case.toml`) and
//! `derivation.md`. The registry contains every folder that has a `scene.toml`.

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
pub(crate) use registry::heads;
pub use solvers::runner;
