//! Three studies: cost against accuracy ([`cost`]), stability ([`stability`]) and the influence of each effect
//! ([`effects`]).
//!
//! Each study stores finished items in a [`result_cache`], so that an interrupted study can be continued. The
//! throughput benchmark ([`race`]) compares solvers. It does not use the cache, because its timings are comparable only
//! within one run.

pub mod clock;
pub mod cost;
pub mod effects;
pub mod identity;
pub mod kept;
pub mod race;
pub mod result_cache;
pub mod run_cache;
pub mod stability;

/// Observer of a study's progress.
pub trait ProgressObserver {
    /// Called when an item is started.
    fn now(&mut self, _piece: &str) {}
    /// Called when an item is finished. `reused` is true for items from the result cache.
    fn done(&mut self, _reused: bool) {}
}

/// Observer that ignores all progress.
impl ProgressObserver for () {}
