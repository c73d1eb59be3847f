//! Stability study. It finds the largest stable step by bisection, and runs hard cases.

pub mod assembly;
pub mod bisection;
pub mod failure;
pub mod hard;
pub mod limit;

use std::time::Duration;

/// Time limit of an external solver; grains that have escaped could keep it running for hours.
const PATIENCE: Duration = Duration::from_secs(20);
