//! Observer that stores the messages of a run.

// The fuzz tests use only a part of it.
#![allow(dead_code)]

use grainbench::scene::end_state::EndState;
use grainbench::solver::brief::Brief;
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::solver::failure::StorageError;
use grainbench::solver::observer::{Observer, RunOptions};
use grainbench::solver::record::Snapshot;

/// Observer of a run. The default observer records nothing.
#[derive(Default)]
pub(crate) struct RunObserver {
    pub(crate) options: RunOptions,
    /// Step after which the observer interrupts the run; none to complete it.
    pub(crate) until: Option<u64>,
    /// Number of completed steps.
    pub(crate) done: u64,
    /// Checkpoints, after they were written to bytes and read back.
    pub(crate) checkpoints: Vec<Checkpoint>,
    /// Snapshots that the record does not keep.
    pub(crate) snapshots: Vec<Snapshot>,
    /// Summaries of snapshots that were not delivered in full, with their numbers of rows.
    pub(crate) briefs: Vec<(Brief, u64)>,
    pub(crate) end: Option<EndState>,
}

impl RunObserver {
    /// Returns an observer that requests the given run options.
    pub(crate) fn new(options: RunOptions) -> Self {
        Self { options, ..Self::default() }
    }

    /// Returns an observer that stores a checkpoint after every `every` steps of a run with `threads` threads.
    pub(crate) fn with_checkpoints(every: u64, threads: usize) -> Self {
        Self::new(RunOptions { checkpoint_interval: Some(every), threads, ..RunOptions::DEFAULT })
    }
}

impl Observer for RunObserver {
    fn options(&self) -> RunOptions {
        self.options
    }
    fn progress(&mut self, done: u64, _total: u64) {
        self.done = done;
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.checkpoints.push(Checkpoint::from_bytes(&checkpoint.to_bytes()?)?);
        Ok(())
    }
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        if self.options.keep_snapshots {
            return Ok(Some(snapshot));
        }
        self.snapshots.push(snapshot);
        Ok(None)
    }
    fn in_short(&mut self, brief: Brief, rows: u64) {
        self.briefs.push((brief, rows));
    }
    fn is_over(&self) -> bool {
        self.until.is_some_and(|until| self.done >= until)
    }
    fn end_state(&mut self, state: EndState) {
        self.end = Some(state);
    }
}
