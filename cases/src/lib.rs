//! Benchmark cases: scenes, ladders of resolution, gates and their negative controls.
//!
//! A case is a folder beside `src`: `scene.toml`, `case.rs` with gates and figures, and `derivation.md`. A folder that
//! has a `scene.toml` is in the registry.

pub mod bench;
pub mod case;
pub mod chaos;
pub mod coarse_picture;
pub mod conformance;
pub mod effect;
pub mod elastic;
pub mod field_picture;
pub mod figure;
pub mod force_plot;
pub mod gate;
pub mod incline;
pub mod manufactured;
pub mod measure;
pub mod one_grain;
pub mod one_grain_cost;
pub mod program_forces;
pub mod program_rows;
pub mod registry;
pub mod rigid_rows;
mod ringing;
pub mod scope;
pub mod solvers;
pub mod stage;
pub mod stored;
pub mod study;
pub mod subject;
mod varied;
pub mod verdict;
