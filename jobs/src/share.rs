//! Parallel processing of numbered items.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Calls `work` with each index below `pieces`, on up to `at_once` threads, until all are done or `goes_on` returns
/// false.
///
/// Returns the number of indices for which `work` was not called.
///
/// The threads are not from a pool, because `work` may wait for a run that another index has started. A waiting thread of
/// a pool could start another index, and a run could then wait for itself.
pub fn share(pieces: usize, at_once: usize, goes_on: impl Fn() -> bool + Sync, work: impl Fn(usize) + Sync) -> usize {
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
