//! Work that threads share.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Does pieces of work by number, so many at once, until all are done or no more are to be begun. Gives how many were left out.
///
/// Plain threads: gates wait for runs that they share, and a pool that lends a waiting thread to another gate could let a run
/// wait for itself.
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
