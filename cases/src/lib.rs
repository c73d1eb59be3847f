//! Benchmark cases: scenes, levels of resolution, claims and their negative controls.
//!
//! A case is a folder beside `src` with `scene.toml`, its claims (`claims.toml`, or `case.rs` with `case.toml`) and
//! `derivation.md`. The registry contains every folder that has a `scene.toml`.

mod exact;
pub mod folder;
pub mod kept;
pub mod registry;
mod rows;
mod silo;
pub mod solvers;
pub mod sources;
pub mod stage;
pub mod stored;
pub mod uncertainty;
mod varied;

pub use exact::one_grain::static_overlap;
pub use grainbench_harness::case::Case;
pub(crate) use registry::heads;
pub use solvers::runner;
