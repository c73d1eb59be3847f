//! Number of cores.

use std::num::NonZeroUsize;

/// Largest accepted number of threads of a run.
pub(crate) const MOST_THREADS: u16 = 1024;

/// Returns the number of available processor cores.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Returns the number of runs, with `threads` threads each, that the cores can run at the same time; at least 1.
pub(crate) fn at_once(threads: usize) -> usize {
    (cores() / threads).max(1)
}
