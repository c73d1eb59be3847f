//! Options of a run, and the observer that receives its output.

use crate::brief::Brief;
use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::failure::StorageError;
use crate::record::{PartialOutput, Snapshot};
use grainbench_scene::end_state::EndState;

/// Size of a run, which is known before the first step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunOutline {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Number of grains or material points in each step.
    pub particles: u64,
}

/// Options of a run, fixed before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// Number of threads, for solvers that can use several. The record is the same for any number, bit for bit.
    pub threads: usize,
    /// Number of steps between checkpoints; `None` for no checkpoints.
    pub checkpoint_interval: Option<u64>,
    /// Largest number of rows (grains, contacts and material points) of a snapshot. A snapshot with more rows is not
    /// created. Instead, [`Observer::in_short`] receives a summary.
    pub most_rows: u64,
    /// True if a run may have a time step at or above the critical one.
    pub allow_unstable: bool,
    /// True if the record contains every snapshot.
    pub keep_snapshots: bool,
    /// True if the observer requests the final state, from which another scene can start.
    pub end_state: bool,
}

impl RunOptions {
    /// One thread, no checkpoints, all snapshots in the record.
    pub const DEFAULT: Self = Self {
        threads: 1,
        checkpoint_interval: None,
        most_rows: u64::MAX,
        allow_unstable: false,
        keep_snapshots: true,
        end_state: false,
    };

    /// Returns the default options, except that time steps at or above the critical one are allowed.
    #[must_use]
    pub const fn unstable() -> Self {
        Self { allow_unstable: true, ..Self::DEFAULT }
    }
}

impl Default for RunOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Receiver of samples, snapshots and checkpoints during a run.
pub trait Observer {
    /// Returns the options of the run.
    fn options(&self) -> RunOptions {
        RunOptions::DEFAULT
    }
    /// Receives the size of the run, once before the first step.
    fn begin(&mut self, _ahead: RunOutline) {}
    /// Receives the number of completed steps and the total number, repeatedly during the run.
    fn progress(&mut self, _done: u64, _total: u64) {}
    /// Receives every snapshot, in order of time. If the snapshot is returned, the record and the checkpoints of the
    /// run contain it. If `None` is returned, they do not, and memory holds one snapshot at a time.
    ///
    /// # Errors
    /// When the snapshot cannot be stored. The run ends with this error.
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        Ok(Some(snapshot))
    }
    /// Receives the summary and the number of rows of a snapshot that has more than [`RunOptions::most_rows`] rows.
    /// [`Observer::snapshot`] is not called for this snapshot.
    fn in_short(&mut self, _brief: Brief, _rows: u64) {}
    /// Receives the final state from solvers that provide it.
    fn end_state(&mut self, _state: EndState) {}
    /// Returns true if the run must end early. The main loop calls this function before each progress report.
    fn is_over(&self) -> bool {
        false
    }
    /// Receives the partial output of a run that broke or was interrupted.
    fn broke(&mut self, _remains: PartialOutput) {}
    /// Receives every checkpoint.
    ///
    /// # Errors
    /// When the checkpoint cannot be stored. The run ends with this error.
    fn checkpoint(&mut self, _checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        Ok(())
    }
}

/// Observer that does nothing.
impl Observer for () {}

/// Observer that only has options.
impl Observer for RunOptions {
    fn options(&self) -> RunOptions {
        *self
    }
}
