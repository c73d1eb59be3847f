//! Time limit of a run of a program. Reading of its output counts too.

use std::time::{Duration, Instant};

use grainbench_solver::failure::Failure;

/// Start and duration of a time limit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    start: Instant,
    limit: Duration,
}

impl Deadline {
    /// Returns a limit that starts now.
    pub(crate) fn after(limit: Duration) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// Returns an error if the limit has expired.
    pub(crate) fn check(self) -> Result<(), Failure> {
        if self.start.elapsed() >= self.limit { Err(Failure::TimeOut(self.limit.as_secs())) } else { Ok(()) }
    }
}
