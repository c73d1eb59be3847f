//! Worker. It runs the tasks of a shard that are neither finished nor leased to another worker, until the whole shard
//! is finished.

use crate::fault::Fault;
use crate::finished::FinishedTasks;
use crate::lease::{Lease, LeaseContents};
use crate::log::{Line, Log, State, Worker};
use crate::plan::{Plan, RESULTS};
use crate::shard::{self, Shard};
use crate::task::{Id, Task};
use grainbench_store::WriteError;
use grainbench_store::machine;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fs;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Number of renewals of a lease within the time in which it expires.
const BEATS: f64 = 12.0;
/// Shortest pause between two checks of the plan while other workers hold the remaining tasks.
const LOOK: Duration = Duration::from_millis(500);
/// Ratio of the pause between two checks of the plan to the duration of a check. Checks take at most 1/20 of the time.
const SHARE: u32 = 20;

/// Shard that a worker runs, and treatment of failed tasks.
#[derive(Clone, Debug)]
pub struct WorkRequest {
    /// Shard to run.
    pub shard: Shard,
    /// True to repeat failed and crashed tasks.
    pub again: bool,
}

/// Observer of progress, which can also stop the worker.
pub trait Watch: Send + Sync {
    /// Returns true if the worker may start further tasks.
    fn goes_on(&self) -> bool {
        true
    }
    /// Returns false if an interrupt may have spoilt results. They are then not written.
    fn are_results_valid(&self) -> bool {
        true
    }
    /// Called when `tasks` tasks are started.
    fn begins(&self, _tasks: usize) {}
    /// Called when a task is finished.
    fn finished(&self) {}
    /// Called when this worker waits because the remaining tasks are leased to other workers.
    fn waits(&self, _others: &[LeaseContents]) {}
}

impl Watch for () {}

/// Outcome of a shard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Number of tasks in the shard.
    pub tasks: usize,
    /// Number of tasks that needed no run when this worker started.
    pub before: usize,
    /// Number of tasks that this worker ran.
    pub done: usize,
    /// Number of the tasks in `done` that failed or crashed.
    pub failed: usize,
    /// Number of tasks that still need a run.
    pub left: usize,
}

/// Result sink, which receives the results of tasks and writes them to the log.
pub struct ResultSink {
    log: Mutex<Log>,
    watch: Arc<dyn Watch>,
    fault: Mutex<Option<WriteError>>,
    stops: AtomicBool,
    done: AtomicUsize,
    failed: AtomicUsize,
    timed: bool,
}

impl ResultSink {
    /// Returns true if another task may be started.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        !self.stops.load(Ordering::Relaxed) && self.watch.goes_on()
    }

    /// Writes the result of a task that took `seconds`.
    pub fn leave(&self, id: Id, state: State, seconds: f64, result: &impl Serialize) {
        match serde_json::to_string(result) {
            Ok(json) => self.leave_text(id, state, seconds, &json),
            Err(error) => self.leave_text(id, State::Crashed, seconds, &quoted(&error.to_string())),
        }
    }

    /// Writes the result of a task that took `seconds`. The result is JSON on one line.
    pub fn leave_text(&self, id: Id, state: State, seconds: f64, json: &str) {
        if !self.watch.are_results_valid() {
            return;
        }
        let load = if self.timed { machine::load() } else { None };
        let added =
            self.log.lock().unwrap_or_else(PoisonError::into_inner).add(&Line { id, state, seconds, load, json });
        if let Err(error) = added {
            self.stops.store(true, Ordering::Relaxed);
            self.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            return;
        }
        self.done.fetch_add(1, Ordering::Relaxed);
        self.failed.fetch_add(usize::from(state != State::Done), Ordering::Relaxed);
        self.watch.finished();
    }

    /// Runs one task and writes its state and result. If `work` panics, the task is recorded as crashed, and the worker
    /// continues.
    pub fn attempt<T: Serialize>(&self, id: Id, work: impl FnOnce() -> (State, T)) {
        let start = Instant::now();
        match std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)) {
            Ok((state, result)) => self.leave(id, state, start.elapsed().as_secs_f64(), &result),
            Err(reason) => self.crashed(id, start.elapsed().as_secs_f64(), &*reason),
        }
    }

    /// Records a task in which our program panicked. `seconds` is its duration (s), and `reason` the value of the
    /// panic.
    pub fn crashed(&self, id: Id, seconds: f64, reason: &(dyn std::any::Any + Send)) {
        self.leave_text(id, State::Crashed, seconds, &quoted(panic_words(reason)));
    }

    fn sync(&self) -> Result<(), WriteError> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner).sync()
    }
}

/// Returns the message of a panic.
#[must_use]
pub fn panic_words(reason: &(dyn std::any::Any + Send)) -> &str {
    let words = reason.downcast_ref::<String>().map(String::as_str).or_else(|| reason.downcast_ref::<&str>().copied());
    words.unwrap_or("our program failed")
}

fn quoted(words: &str) -> String {
    serde_json::to_string(words).unwrap_or_else(|_| "\"\"".to_owned())
}

/// Function that runs tasks and writes their results to the sink.
pub type TaskFunction<'a> = &'a dyn Fn(&[&Task], &Arc<ResultSink>) -> Result<(), Fault>;

/// Runs a shard of a plan; `does` runs the tasks.
///
/// # Errors
/// When reading, writing or `does` fails. Results written before are kept.
pub fn work(
    plan: &Plan,
    asked: &WorkRequest,
    worker: &Worker,
    watch: Arc<dyn Watch>,
    does: TaskFunction<'_>,
) -> Result<Summary, Fault> {
    let range = shard::task_range(&plan.tasks, asked.shard);
    let seconds = plan.head.lease_seconds;
    let contents = LeaseContents {
        worker: worker.name.clone(),
        host: worker.host.clone(),
        process: worker.process,
        job: worker.job.clone(),
        tasks: Vec::new(),
        done: 0,
    };
    let mut summary = Summary { tasks: range.len(), ..Summary::default() };
    let mut desk: Option<Arc<ResultSink>> = None;
    // Each task is tried at most once by this worker, even if it fails again.
    let mut tried: BTreeSet<usize> = BTreeSet::new();
    let mut is_first = true;
    loop {
        let (lease, others) = Lease::take(&plan.path, range.clone(), &contents, seconds)?;
        // Results are read after the lease is taken. Otherwise another worker could finish a task after the reading and
        // before the lease.
        let look = Instant::now();
        let finished = FinishedTasks::read(&plan.path, false)?;
        let look = look.elapsed();
        let is_open = |place: usize| match finished.entries.get(&plan.tasks[place].id) {
            None => true,
            Some(entry) => asked.again && entry.state != State::Done && !tried.contains(&place),
        };
        let open: Vec<usize> = range.clone().filter(|place| is_open(*place)).collect();
        if is_first {
            summary.before = range.len() - open.len();
        }
        is_first = false;
        summary.left = open.len();
        let is_mine = |place: &usize| lease.as_ref().is_some_and(|lease| lease.has(*place));
        let mine: Vec<usize> = open.iter().copied().filter(is_mine).collect();
        let others: Vec<LeaseContents> =
            others.into_iter().filter(|other| open.iter().any(|place| other.has(*place))).collect();
        if mine.is_empty() {
            drop(lease);
            if others.is_empty() || !watch.goes_on() {
                break;
            }
            watch.waits(&others);
            std::thread::sleep(LOOK.max(look * SHARE));
            continue;
        }
        let at = match desk.take() {
            Some(desk) => desk,
            None => Arc::new(begin(plan, worker, Arc::clone(&watch))?),
        };
        watch.begins(mine.len());
        let tasks: Vec<&Task> = mine.iter().map(|place| &plan.tasks[*place]).collect();
        with_a_heart(lease.as_ref(), &at, seconds / BEATS, || does(&tasks, &at))?;
        at.sync()?;
        drop(lease);
        tried.extend(mine);
        (summary.done, summary.failed) = (at.done.load(Ordering::Relaxed), at.failed.load(Ordering::Relaxed));
        if let Some(error) = at.fault.lock().unwrap_or_else(PoisonError::into_inner).take() {
            return Err(error.into());
        }
        summary.left = summary.left.saturating_sub(tasks.len());
        if !at.goes_on() {
            summary.left = summary.tasks.saturating_sub(summary.before + summary.done);
            break;
        }
        desk = Some(at);
    }
    Ok(summary)
}

fn begin(plan: &Plan, worker: &Worker, watch: Arc<dyn Watch>) -> Result<ResultSink, Fault> {
    let folder = plan.path.join(RESULTS);
    fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
    Ok(ResultSink {
        log: Mutex::new(Log::new(&folder, worker)?),
        watch,
        fault: Mutex::new(None),
        stops: AtomicBool::new(false),
        done: AtomicUsize::new(0),
        failed: AtomicUsize::new(0),
        timed: plan.head.timed,
    })
}

/// Runs `work` while a second thread renews the lease and syncs the results to the disk every `every` seconds.
fn with_a_heart<T>(lease: Option<&Lease>, desk: &ResultSink, every: f64, work: impl FnOnce() -> T) -> T {
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let beats = scope.spawn(|| {
            let mut last = Instant::now();
            while !is_over.load(Ordering::Relaxed) {
                std::thread::park_timeout(Duration::from_secs_f64(every));
                if last.elapsed().as_secs_f64() >= every {
                    last = Instant::now();
                    // An error of the disk is reported when results are written.
                    let _ = lease.map(|lease| lease.renew(desk.done.load(Ordering::Relaxed)));
                    let _ = desk.sync();
                }
            }
        });
        let over = HeartbeatGuard(&is_over, beats.thread().clone());
        let done = work();
        drop(over);
        done
    })
}

/// Guard that stops the heartbeat thread, even if the work panics.
struct HeartbeatGuard<'a>(&'a AtomicBool, std::thread::Thread);

impl Drop for HeartbeatGuard<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
        self.1.unpark();
    }
}
