//! grainbench: how far to trust a solver of granular simulations, and what that trust costs.
//!
//! This façade is what a solver author uses; the crates behind it are for reading. [`judge`] gives a solver of one's
//! own the gates of the cases, [`conform`] the properties that any solver owes; `examples/own_solver.rs` shows a whole
//! solver.

pub mod check;
pub mod kept;
pub mod own;
pub mod peers;
pub mod resume;
pub mod verify;

pub use own::{Judgement, conform, judge};

pub use grainbench_campaign as campaign;
pub use grainbench_cases as cases;
pub use grainbench_dem as dem;
pub use grainbench_fields as fields;
pub use grainbench_harness as harness;
pub use grainbench_lanes as lanes;
pub use grainbench_mpm as mpm;
pub use grainbench_reference as reference;
pub use grainbench_reports as reports;
pub use grainbench_scene as scene;
pub use grainbench_studies as studies;
