//! The cores of this machine, and work that shares them.

pub(crate) use grainbench::campaign::share::share;
use std::num::NonZeroUsize;

/// Most threads that can be asked for.
pub(crate) const MOST_THREADS: u16 = 1024;

/// How many threads this machine runs at once.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// How many runs of so many threads each this machine has cores for.
pub(crate) fn at_once(threads: usize) -> usize {
    (cores() / threads).max(1)
}
