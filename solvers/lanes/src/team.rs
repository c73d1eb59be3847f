//! Threads of a run.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use std::sync::{Arc, Mutex};

/// Threads that share the work of a run.
#[derive(Clone, Debug, Default)]
pub struct Team {
    /// Thread pool; `None` for a single thread.
    pool: Option<Arc<rayon::ThreadPool>>,
}

impl Team {
    /// Creates a team of `threads` threads. If the system cannot provide them, the team has one thread.
    #[must_use]
    pub fn new(threads: usize) -> Self {
        let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
        Self { pool: pool.and_then(Result::ok).map(Arc::new) }
    }

    /// Returns the number of threads.
    #[must_use]
    pub fn members(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Runs `work` on one of the threads. Calls of [`Team::fold`] in `work` then start the other threads without delay.
    pub fn lead<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Processes all parts in parallel, and joins the results in the order of the parts. `work` receives the index of
    /// its part.
    pub fn fold<T: Send, R: Send>(
        &self,
        parts: impl Iterator<Item = T>,
        work: impl Fn(usize, T) -> R + Sync,
        start: R,
        join: impl Fn(R, R) -> R,
    ) -> R {
        let Some(pool) = &self.pool else {
            return parts.enumerate().fold(start, |joined, (number, part)| join(joined, work(number, part)));
        };
        let slots: Vec<_> = parts.map(|part| Mutex::new((Some(part), None))).collect();
        at_once(pool, slots.len(), &|number| {
            if let Ok(mut slot) = slots[number].lock()
                && let Some(part) = slot.0.take()
            {
                slot.1 = Some(work(number, part));
            }
        });
        slots.into_iter().filter_map(|slot| slot.into_inner().ok()?.1).fold(start, join)
    }

    /// Processes all parts in parallel, without a result.
    pub fn each<T: Send>(&self, parts: impl Iterator<Item = T>, work: impl Fn(usize, T) + Sync) {
        self.fold(parts, work, (), |(), ()| ());
    }
}

/// Runs `jobs` jobs in parallel. It is not generic over the jobs: a generic version, compiled for each kind of work,
/// made up a fifth of the code of a solver.
fn at_once(pool: &rayon::ThreadPool, jobs: usize, job: &(dyn Fn(usize) + Sync)) {
    pool.install(|| (0..jobs).into_par_iter().with_max_len(1).for_each(job));
}

/// Splits off the first `count` items of a slice, or all of them if there are fewer.
pub fn take_off<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let count = count.min(slice.len());
    slice.split_off_mut(..count).unwrap_or_default()
}
