//! The cores of this machine, and work that shares them.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// Does pieces of work by number, so many at once, until all are done or no more are to be begun. Gives how many were left out.
///
/// Plain threads: gates wait for runs that they share, and a pool that lends a waiting thread to another gate could let a run
/// wait for itself.
pub(crate) fn share(
    pieces: usize,
    at_once: usize,
    goes_on: impl Fn() -> bool + Sync,
    work: impl Fn(usize) + Sync,
) -> usize {
    let next = AtomicUsize::new(0);
    let take =
        || if goes_on() { Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&piece| piece < pieces) } else { None };
    std::thread::scope(|scope| {
        for _ in 0..at_once.clamp(1, pieces.max(1)) {
            scope.spawn(|| {
                while let Some(piece) = take() {
                    work(piece);
                }
            });
        }
    });
    pieces - next.into_inner().min(pieces)
}
