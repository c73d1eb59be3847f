//! Observer that records what a run reports.

// The fuzz program uses a part of it.
#![allow(dead_code)]

use grainbench::scene::brief::Brief;
use grainbench::scene::checkpoint::{Checkpoint, CheckpointError};
use grainbench::scene::end_state::EndState;
use grainbench::scene::record::Snapshot;
use grainbench::scene::solver::{StorageError, Watch};

/// Observer of a run. The default observer records nothing.
#[derive(Default)]
pub(crate) struct RunObserver {
    /// Threads of the run; 0 for one thread.
    pub(crate) threads: usize,
    /// Steps between checkpoints.
    pub(crate) every: Option<u64>,
    /// Step after which the run is interrupted.
    pub(crate) until: Option<u64>,
    /// Largest number of rows of a recorded snapshot. If absent, snapshots stay in the record of the run.
    pub(crate) most_rows: Option<u64>,
    /// Completed steps.
    pub(crate) done: u64,
    /// Checkpoints after conversion to and from bytes.
    pub(crate) checkpoints: Vec<Checkpoint>,
    /// Snapshots with at most `most_rows` rows.
    pub(crate) snapshots: Vec<Snapshot>,
    /// Summaries of the other snapshots, with their numbers of rows.
    pub(crate) briefs: Vec<(Brief, u64)>,
    /// Final state.
    pub(crate) end: Option<EndState>,
}

impl RunObserver {
    /// Returns an observer that records a checkpoint after every `every` steps.
    pub(crate) fn with_checkpoints(every: u64) -> Self {
        Self { every: Some(every), ..Self::default() }
    }
}

impl Watch for RunObserver {
    fn progress(&mut self, done: u64, _total: u64) {
        self.done = done;
    }
    fn threads(&self) -> usize {
        self.threads.max(1)
    }
    fn checkpoint_interval(&self) -> Option<u64> {
        self.every
    }
    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        self.checkpoints.push(Checkpoint::from_bytes(&checkpoint.to_bytes()?)?);
        Ok(())
    }
    fn most_rows(&self) -> u64 {
        self.most_rows.unwrap_or(u64::MAX)
    }
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        if self.most_rows.is_none() {
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
    fn wants_end_state(&self) -> bool {
        self.until.is_some()
    }
    fn end_state(&mut self, state: EndState) {
        self.end = Some(state);
    }
}
