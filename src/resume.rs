//! Runs that can be interrupted and continued from periodic checkpoints.

use crate::scene::end_state::EndState;
use crate::scene::scene::Scene;
use crate::solver::Solver;
use crate::solver::brief::Brief;
use crate::solver::checkpoint::{Checkpoint, CheckpointError};
use crate::solver::failure::{RunError, StorageError};
use crate::solver::observer::{Observer, RunOptions, RunOutline};
use crate::solver::record::{PartialOutput, Record, Snapshot};
use crate::solver::resolution::Resolution;
use crate::store::write_file;
use std::path::Path;

/// File of the checkpoints of a run. Each checkpoint replaces the previous one.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Path of the file.
    pub path: &'a Path,
    /// Number of steps between checkpoints.
    pub every: u64,
}

impl Place<'_> {
    /// Writes a checkpoint in one atomic operation.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn put(&self, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
        write_file(self.path, checkpoint.to_bytes()?).map_err(|error| CheckpointError::NotStored(error.to_string()))
    }
}

/// Runs a scene from its start or from a checkpoint of the same run. The checkpoint was written by this function or by
/// `simulate --checkpoint`.
///
/// The record equals that of an uninterrupted run to the bit, except for the run time (s). The run time is NaN if
/// `simulate` wrote the checkpoint.
///
/// # Errors
/// When the solver fails, or when the checkpoint belongs to another run.
pub fn run(
    solver: &dyn Solver,
    scene: &Scene,
    resolution: &Resolution,
    from: Option<&Checkpoint>,
    place: Place<'_>,
    observer: &mut dyn Observer,
) -> Result<Record, RunError> {
    let before = from.map_or(Some(0.0), seconds).unwrap_or(f64::NAN);
    let mut watcher = CheckpointWriter { observer, place, before, begun: std::time::Instant::now() };
    let mut record = solver.run_from(scene, resolution, from, &mut watcher)?;
    record.cost.wall_seconds += before;
    Ok(record)
}

/// Text before the elapsed time (s) in the output section of a checkpoint.
const TAKEN: &str = "taken ";

/// Returns the elapsed time at a checkpoint (s); `None` if another command wrote the checkpoint.
fn seconds(checkpoint: &Checkpoint) -> Option<f64> {
    std::str::from_utf8(checkpoint.output()).ok()?.strip_prefix(TAKEN)?.parse().ok()
}

/// Observer that stores checkpoints and forwards all other calls to another observer.
struct CheckpointWriter<'a> {
    observer: &'a mut dyn Observer,
    place: Place<'a>,
    /// Run time before the checkpoint from which the run started (s).
    before: f64,
    begun: std::time::Instant,
}

impl Observer for CheckpointWriter<'_> {
    fn begin(&mut self, ahead: RunOutline) {
        self.observer.begin(ahead);
        self.begun = std::time::Instant::now();
    }

    fn progress(&mut self, done: u64, total: u64) {
        self.observer.progress(done, total);
    }

    fn options(&self) -> RunOptions {
        RunOptions { checkpoint_interval: Some(self.place.every), ..self.observer.options() }
    }

    fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        let taken = format!("{TAKEN}{:?}", self.before + self.begun.elapsed().as_secs_f64());
        self.place.put(&checkpoint.with_output(taken.into_bytes()))
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
        self.observer.is_over()
    }

    fn broke(&mut self, remains: PartialOutput) {
        self.observer.broke(remains);
    }
}
