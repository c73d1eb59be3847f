//! What stays stable: the largest stable step, found by bisection on a typed failure, and hard cases.

pub mod assembly;
pub mod bisection;
pub mod failure;
pub mod hard;
pub mod limit;

use std::time::Duration;

/// How long another program may take: one whose grains have flown off may go on for hours.
const PATIENCE: Duration = Duration::from_secs(20);
