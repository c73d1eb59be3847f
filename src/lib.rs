//! Benchmarks for the accuracy and the computing cost of solvers for granular mechanics.
//!
//! This crate is the public interface for authors of solvers. [`judge`] tests a solver with the claims of cases, and
//! [`conform`] tests it with the conformance properties. `examples/own_solver.rs` shows a complete solver.

pub mod adapt;
pub mod check;
pub mod kept;
pub mod own;
pub mod peers;
pub mod publication;
pub mod resume;
pub mod verify;

pub use own::{Judgement, conform, judge};

pub use grainbench_cases as cases;
pub use grainbench_dem as dem;
pub use grainbench_fields as fields;
pub use grainbench_harness as harness;
pub use grainbench_jobs as jobs;
pub use grainbench_lanes as lanes;
pub use grainbench_mpm as mpm;
pub use grainbench_reference as reference;
pub use grainbench_reports as reports;
pub use grainbench_scene as scene;
pub use grainbench_solver as solver;
pub use grainbench_store as store;
pub use grainbench_studies as studies;
