//! The time that a run of a program and the reading of what it left may take together.

use std::time::{Duration, Instant};

use grainbench_scene::solver::Failure;

/// When a limit of time is over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    start: Instant,
    limit: Duration,
}

impl Deadline {
    /// A limit that counts from now on.
    pub(crate) fn after(limit: Duration) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// A failure where the time is over.
    pub(crate) fn check(self) -> Result<(), Failure> {
        if self.start.elapsed() >= self.limit { Err(Failure::TimeOut(self.limit.as_secs())) } else { Ok(()) }
    }
}
