//! Solver whose runs end at a deadline.

use grainbench_harness::wrapper::{Start, Wrapped, Wrapper};
use grainbench_scene::end_state::EndState;
use grainbench_solver::Solver;
use grainbench_solver::brief::Brief;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench_solver::failure::{RunError, StorageError};
use grainbench_solver::observer::{Observer, RunOptions, RunOutline};
use grainbench_solver::record::{PartialOutput, Record, Snapshot};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Fraction of the time limit after which the progress of a run is believed.
const SURE: f64 = 0.2;
/// Expected time of a run, relative to the time limit, above which it is ended before its deadline.
const HOPELESS: f64 = 2.0;

/// Solver whose runs are interrupted at a deadline, and when the user stops the study. An external program has its own time
/// limit instead.
pub struct Within<'a> {
    solver: &'a dyn Solver,
    deadline: Instant,
    stop: &'a (dyn Fn() -> bool + Sync),
    /// Numbers of completed steps and of all steps of the last run.
    progress: [AtomicU64; 2],
    /// True if a run was interrupted.
    is_cut: AtomicBool,
}

impl<'a> Within<'a> {
    /// Returns the solver with a deadline. `stop` returns true if the user stops the study.
    #[must_use]
    pub const fn new(solver: &'a dyn Solver, deadline: Instant, stop: &'a (dyn Fn() -> bool + Sync)) -> Wrapped<Self> {
        let progress = [AtomicU64::new(0), AtomicU64::new(0)];
        Wrapped(Self { solver, deadline, stop, progress, is_cut: AtomicBool::new(false) })
    }

    /// Returns true if a run was interrupted, so that a result of several runs is incomplete.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.is_cut.load(Ordering::Relaxed)
    }

    /// Returns the completed fraction of the last run; none if it has not begun.
    #[must_use]
    pub fn completed(&self) -> Option<f64> {
        let [done, total] = [0, 1].map(|at: usize| self.progress[at].load(Ordering::Relaxed) as f64);
        (done > 0.0 && total > 0.0).then(|| done / total)
    }
}

impl Wrapper for Within<'_> {
    fn inner(&self) -> &dyn Solver {
        self.solver
    }

    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError> {
        self.progress.iter().for_each(|count| count.store(0, Ordering::Relaxed));
        let found = start.run(self.solver, &mut Watch { solver: self, observer, begin: Instant::now() });
        self.is_cut.fetch_or(matches!(found, Err(RunError::Interrupted { .. })), Ordering::Relaxed);
        found
    }
}

/// Observer that passes everything on, and ends the run at the deadline.
struct Watch<'a> {
    solver: &'a Within<'a>,
    observer: &'a mut dyn Observer,
    begin: Instant,
}

impl Observer for Watch<'_> {
    fn options(&self) -> RunOptions {
        self.observer.options()
    }

    fn begin(&mut self, ahead: RunOutline) {
        self.observer.begin(ahead);
    }

    fn progress(&mut self, done: u64, total: u64) {
        self.solver.progress[0].store(done, Ordering::Relaxed);
        self.solver.progress[1].store(total, Ordering::Relaxed);
        self.observer.progress(done, total);
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        self.observer.snapshot(snapshot)
    }

    fn in_short(&mut self, brief: Brief, rows: u64) {
        self.observer.in_short(brief, rows);
    }

    fn end_state(&mut self, state: EndState) {
        self.observer.end_state(state);
    }

    fn is_over(&self) -> bool {
        let (now, deadline) = (Instant::now(), self.solver.deadline);
        let (elapsed, limit) = (now - self.begin, deadline.saturating_duration_since(self.begin));
        let whole = self.solver.completed().map_or(0.0, |completed| elapsed.as_secs_f64() / completed);
        let is_hopeless = elapsed > limit.mul_f64(SURE) && whole > HOPELESS * limit.as_secs_f64();
        now >= deadline || is_hopeless || (self.solver.stop)() || self.observer.is_over()
    }

    fn broke(&mut self, remains: PartialOutput) {
        self.observer.broke(remains);
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.observer.checkpoint(checkpoint)
    }
}
