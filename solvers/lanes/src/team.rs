//! The threads of one run.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use std::sync::{Arc, Mutex};

/// Threads that share the work of a run.
#[derive(Clone, Debug, Default)]
pub struct Team {
    /// None where one thread does it all.
    pool: Option<Arc<rayon::ThreadPool>>,
}

impl Team {
    /// A team of so many threads; of one where the system does not give them.
    #[must_use]
    pub fn new(threads: usize) -> Self {
        let pool = (threads > 1).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
        Self { pool: pool.and_then(Result::ok).map(Arc::new) }
    }

    /// How many threads.
    #[must_use]
    pub fn members(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Does some work on one of the threads, from which [`Team::fold`] reaches the others at once.
    pub fn lead<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Works on every part, all at once as far as there are threads, and joins what comes of it in the order of the parts. The
    /// work is told the number of its part.
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

    /// Works on every part, of which nothing comes but what it leaves in the part.
    pub fn each<T: Send>(&self, parts: impl Iterator<Item = T>, work: impl Fn(usize, T) + Sync) {
        self.fold(parts, work, (), |(), ()| ());
    }
}

/// Does every job of so many, all at once as far as there are threads. It knows nothing of the jobs: compiled with each kind
/// of work, what shares them out was a fifth of the code of a solver.
fn at_once(pool: &rayon::ThreadPool, jobs: usize, job: &(dyn Fn(usize) + Sync)) {
    pool.install(|| (0..jobs).into_par_iter().with_max_len(1).for_each(job));
}

/// Takes the first of a slice off, so many or as many as there are.
pub fn take_off<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let count = count.min(slice.len());
    slice.split_off_mut(..count).unwrap_or_default()
}
