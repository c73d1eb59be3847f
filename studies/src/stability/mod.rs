//! Stability study. It finds the largest stable time steps by bisection, and runs hard cases.

pub mod assembly;
pub mod failure;
pub mod hard;
pub mod limit;

use std::time::Duration;

/// Time limit for a run of another program. Grains that have escaped could make the program run for hours.
const PATIENCE: Duration = Duration::from_secs(20);
