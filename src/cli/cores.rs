//! Number of cores, and parallel work.

pub(crate) use grainbench::campaign::share::share;
use std::num::NonZeroUsize;

/// Largest accepted number of threads.
pub(crate) const MOST_THREADS: u16 = 1024;

/// Returns the number of threads that can run at the same time.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Returns the number of runs with `threads` threads each that can run at the same time; at least 1.
pub(crate) fn at_once(threads: usize) -> usize {
    (cores() / threads).max(1)
}
