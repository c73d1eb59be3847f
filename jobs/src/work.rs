//! Worker. It runs the tasks of a shard that are neither finished nor leased to another worker, until the whole shard
//! is finished.

use crate::execute::{ResultSink, TaskList, Watch, execute, groups, locked};
use crate::fault::Fault;
use crate::lease::{Lease, LeaseContents};
use crate::plan::Plan;
use crate::shard::{self, Shard};
use grainbench_store::log::{Entry, Log, State, Worker};
use grainbench_store::results::{FinishedTasks, RESULTS};
use grainbench_store::{WriteError, machine};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::sync::Mutex;
use std::sync::mpsc::{self, RecvTimeoutError};
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
    /// States of the finished tasks that are repeated.
    pub again: &'static [State],
    /// Number of simultaneous tasks.
    pub jobs: usize,
}

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

/// Result file of a worker. It is created with the first result.
struct ResultFile<'a> {
    plan: &'a Plan,
    worker: &'a Worker,
    log: Mutex<Option<Log>>,
}

impl ResultFile<'_> {
    fn add(&self, place: usize, state: State, seconds: f64, json: &str) -> Result<(), WriteError> {
        let load = if self.plan.head.timed { machine::load() } else { None };
        let (id, entry) = (self.plan.tasks[place].id, Entry::new(state, seconds, load, json));
        let mut log = locked(&self.log);
        if let Some(log) = &mut *log {
            return log.add(id, &entry);
        }
        let folder = self.plan.path.join(RESULTS);
        fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
        log.insert(Log::new(&folder, self.worker)?).add(id, &entry)
    }

    fn sync(&self) -> Result<(), WriteError> {
        locked(&self.log).as_mut().map_or(Ok(()), Log::sync)
    }
}

/// Runs a shard of a plan. `list` performs the tasks.
///
/// # Errors
/// When reading or writing fails. Results written before are kept.
pub fn work<L: TaskList>(
    plan: &Plan,
    asked: &WorkRequest,
    worker: &Worker,
    watch: &dyn Watch,
    list: &L,
) -> Result<Summary, Fault> {
    let range = shard::all(&plan.tasks, asked.shard.count).swap_remove(asked.shard.index as usize - 1);
    let seconds = plan.head.lease_seconds;
    let contents = LeaseContents {
        worker: worker.name.clone(),
        host: worker.host.clone(),
        process: worker.process,
        job: worker.job.clone(),
        ..LeaseContents::default()
    };
    let mut summary = Summary { tasks: range.len(), ..Summary::default() };
    let file = ResultFile { plan, worker, log: Mutex::new(None) };
    let store = |place: usize, state: State, seconds: f64, result: Result<L::Output, String>| match result
        .and_then(|output| serde_json::to_string(&output).map_err(|error| error.to_string()))
    {
        Ok(json) => file.add(place, state, seconds, &json),
        Err(words) => file.add(place, State::Crashed, seconds, &Value::from(words).to_string()),
    };
    let sink = ResultSink::new(watch, &store);
    // Each task is tried at most once by this worker, even if it fails again.
    let mut tried: BTreeSet<usize> = BTreeSet::new();
    let mut before = None;
    loop {
        let (lease, others) = Lease::take(&plan.path, range.clone(), &contents, seconds)?;
        // Results are read after the lease is taken. Otherwise another worker could finish a task after the reading and
        // before the lease.
        let look = Instant::now();
        let finished = FinishedTasks::read(&plan.path, false).map_err(Fault::Input)?;
        let look = look.elapsed();
        let is_open = |place: usize| match finished.entries.get(&plan.tasks[place].id) {
            None => true,
            Some(entry) => asked.again.contains(&entry.state) && !tried.contains(&place),
        };
        let open: Vec<usize> = range.clone().filter(|place| is_open(*place)).collect();
        summary.before = *before.get_or_insert(range.len() - open.len());
        summary.left = open.len();
        let is_mine = |place: &usize| lease.as_ref().is_some_and(|lease| lease.contents.has(*place));
        let mine: Vec<usize> = open.iter().copied().filter(is_mine).collect();
        let others: Vec<LeaseContents> =
            others.into_iter().filter(|other| open.iter().any(|place| other.has(*place))).collect();
        if mine.is_empty() {
            drop(lease);
            if others.is_empty() || !watch.goes_on() {
                break;
            }
            watch.waits(&others.into_iter().map(|other| other.worker).collect::<Vec<_>>());
            std::thread::sleep(LOOK.max(look * SHARE));
            continue;
        }
        watch.begins(mine.len());
        let renew = || {
            // An error of the disk is reported when results are written.
            let _ = lease.as_ref().map(|lease| lease.renew(sink.done()));
            let _ = file.sync();
        };
        with_a_heart(Duration::from_secs_f64(seconds / BEATS), renew, || {
            execute(list, &groups(&plan.tasks, &mine), asked.jobs, &sink)
        });
        file.sync()?;
        drop(lease);
        (summary.done, summary.failed) = (sink.done(), sink.failed());
        if let Some(error) = sink.fault() {
            return Err(error.into());
        }
        summary.left = summary.left.saturating_sub(mine.len());
        tried.extend(mine);
        if !sink.goes_on() {
            summary.left = summary.tasks.saturating_sub(summary.before + summary.done);
            break;
        }
    }
    Ok(summary)
}

/// Runs `work` while a second thread calls `beat` at intervals of `every`.
fn with_a_heart<T>(every: Duration, beat: impl Fn() + Sync, work: impl FnOnce() -> T) -> T {
    let (sender, receiver) = mpsc::channel::<()>();
    let beat = &beat;
    std::thread::scope(|scope| {
        scope.spawn(move || {
            while receiver.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                beat();
            }
        });
        // The sender is dropped after the work, even if the work panics. The second thread then ends.
        let _sender = sender;
        work()
    })
}
