//! The three studies: cost against accuracy ([`cost`]), stability ([`stability`]) and the influence of each effect
//! ([`effects`]).
//!
//! Each study stores every finished item in a [`result_cache`] and reuses it, so that an interrupted study continues
//! where it stopped. The throughput benchmark ([`race`]) compares solvers; its timings are meaningful only in relation
//! to each other, so it does not use the cache.

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
    /// Called when an item is finished; `reused` items come from the result cache.
    fn done(&mut self, _reused: bool) {}
}

/// An observer that ignores all progress.
impl ProgressObserver for () {}
