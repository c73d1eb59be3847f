//! Executor of a list of tasks. It distributes the tasks over threads and hands over each result as soon as it is known.

use crate::shard::is_one_group;
use crate::task::Task;
use grainbench_store::WriteError;
use grainbench_store::log::State;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::any::Any;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// List of tasks, which are named by their indices.
pub trait TaskList: Sync {
    /// Result of a task.
    type Output: Serialize + DeserializeOwned + Send;

    /// Performs a task and returns its state and its result.
    fn perform(&self, place: usize, sink: &ResultSink<'_, Self::Output>) -> (State, Self::Output);

    /// Performs the tasks of a group.
    fn perform_group(&self, places: &[usize], sink: &ResultSink<'_, Self::Output>) {
        self.perform_each(places, sink);
    }

    /// Performs tasks one after the other.
    fn perform_each(&self, places: &[usize], sink: &ResultSink<'_, Self::Output>) {
        for &place in places {
            if !sink.goes_on() {
                return;
            }
            let start = Instant::now();
            match catch_unwind(AssertUnwindSafe(|| self.perform(place, sink))) {
                Ok((state, output)) => sink.leave(place, state, start.elapsed().as_secs_f64(), Ok(output)),
                Err(reason) => sink.crashed(place, start, &*reason),
            }
        }
    }
}

/// Observer of progress, which can also stop the execution.
pub trait Watch: Sync {
    /// Returns true if further tasks may be started.
    fn goes_on(&self) -> bool {
        true
    }
    /// Returns false if an interrupt may have spoilt results. They are then not stored.
    fn are_results_valid(&self) -> bool {
        true
    }
    /// Called when `tasks` tasks are started.
    fn begins(&self, _tasks: usize) {}
    /// Called with the name of the current task.
    fn now(&self, _name: &str) {}
    /// Called when a task is finished.
    fn finished(&self) {}
    /// Called when the remaining tasks are leased to these other workers.
    fn waits(&self, _others: &[String]) {}
}

impl Watch for () {}

/// Function that stores the result of a task. Its arguments are the index of the task, its state, its duration (s), and
/// its result or the message of its panic.
pub type Store<'a, T> = dyn Fn(usize, State, f64, Result<T, String>) -> Result<(), WriteError> + Sync + 'a;

/// Receiver of results.
pub struct ResultSink<'a, T> {
    watch: &'a dyn Watch,
    store: &'a Store<'a, T>,
    finished: Mutex<BTreeSet<usize>>,
    fault: Mutex<Option<WriteError>>,
    failed: AtomicUsize,
}

impl<'a, T> ResultSink<'a, T> {
    /// Returns a sink that stores results with a function.
    pub fn new(watch: &'a dyn Watch, store: &'a Store<'a, T>) -> Self {
        Self { watch, store, finished: Mutex::default(), fault: Mutex::default(), failed: AtomicUsize::new(0) }
    }

    /// Returns true if another task may be started.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        locked(&self.fault).is_none() && self.watch.goes_on()
    }

    /// Reports the name of the current task.
    pub fn now(&self, name: &str) {
        self.watch.now(name);
    }

    /// Stores the result of a task that took `seconds`. After an error of the disk, no further task is started.
    pub fn leave(&self, place: usize, state: State, seconds: f64, result: Result<T, String>) {
        if !self.watch.are_results_valid() {
            return;
        }
        if let Err(error) = (self.store)(place, state, seconds, result) {
            locked(&self.fault).get_or_insert(error);
            return;
        }
        locked(&self.finished).insert(place);
        self.failed.fetch_add(usize::from(state != State::Done), Ordering::Relaxed);
        self.watch.finished();
    }

    fn crashed(&self, place: usize, start: Instant, reason: &(dyn Any + Send)) {
        let words = reason.downcast_ref::<String>().map(String::as_str).or_else(|| reason.downcast_ref().copied());
        let words = words.unwrap_or("our program failed").to_owned();
        self.leave(place, State::Crashed, start.elapsed().as_secs_f64(), Err(words));
    }

    /// Returns the number of stored results.
    #[must_use]
    pub fn done(&self) -> usize {
        locked(&self.finished).len()
    }

    /// Returns the number of results of tasks that failed or crashed.
    #[must_use]
    pub fn failed(&self) -> usize {
        self.failed.load(Ordering::Relaxed)
    }

    /// Returns the first error of the disk, and forgets it.
    pub fn fault(&self) -> Option<WriteError> {
        locked(&self.fault).take()
    }
}

pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Performs groups of tasks on up to `at_once` threads. If a task panics, it is recorded as crashed, and the others
/// continue.
///
/// The threads are not from a pool, because a task may wait for a run that another task has started. A waiting thread of
/// a pool could start another task, and a run could then wait for itself.
pub fn execute<L: TaskList>(list: &L, groups: &[Vec<usize>], at_once: usize, sink: &ResultSink<'_, L::Output>) {
    let perform = |group: &[usize]| {
        let start = Instant::now();
        if let Err(reason) = catch_unwind(AssertUnwindSafe(|| list.perform_group(group, sink))) {
            for &place in group {
                let is_stored = locked(&sink.finished).contains(&place);
                if !is_stored {
                    sink.crashed(place, start, &*reason);
                }
            }
        }
    };
    let next = AtomicUsize::new(0);
    let take = || if sink.goes_on() { groups.get(next.fetch_add(1, Ordering::Relaxed)) } else { None };
    std::thread::scope(|scope| {
        for _ in 0..at_once.clamp(1, groups.len().max(1)) {
            scope.spawn(|| {
                while let Some(group) = take() {
                    perform(group);
                }
            });
        }
    });
}

/// Performs all tasks in memory on up to `at_once` threads, in the order `order` of their indices. Calls `observe` with each
/// result. Returns the results in the order of the list; `None` for a task that was not started, and the message of a panic
/// as an error.
pub fn in_memory<L: TaskList>(
    list: &L,
    order: &[usize],
    at_once: usize,
    watch: &dyn Watch,
    observe: &(dyn Fn(&L::Output) + Sync),
) -> Vec<Option<Result<L::Output, String>>> {
    let results: Vec<_> = order.iter().map(|_| Mutex::new(None)).collect();
    let store = |place: usize, _: State, _: f64, result: Result<L::Output, String>| {
        result.iter().for_each(observe);
        *locked(&results[place]) = Some(result);
        Ok(())
    };
    watch.begins(order.len());
    let groups: Vec<Vec<usize>> = order.iter().map(|place| vec![*place]).collect();
    execute(list, &groups, at_once, &ResultSink::new(watch, &store));
    results.into_iter().map(|result| result.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

/// Divides tasks into groups: consecutive tasks with the same group number, and single tasks without one.
#[must_use]
pub fn groups(tasks: &[Task], places: &[usize]) -> Vec<Vec<usize>> {
    places.chunk_by(|a, b| is_one_group(&tasks[*a], &tasks[*b])).map(<[usize]>::to_vec).collect()
}
