//! Processing of the snapshots of a run while it runs, for runs with too many snapshots to store. A reader receives
//! each snapshot once, and returns tables at the end.

use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{RunError, StorageError};
use grainbench_solver::observer::{Observer, RunOptions};
use grainbench_solver::record::{Record, Snapshot};
use grainbench_solver::resolution::Resolution;
use std::fmt;

/// Named evaluation of the snapshots of a run.
#[derive(Clone, Copy)]
pub struct Reading {
    /// Name. Runs with different evaluations are different runs.
    pub name: &'static str,
    /// Creates a reader for the scene that the solver runs. Under a negative control, this is the wrong scene.
    pub begin: fn(&Scene) -> Box<dyn Reader>,
}

impl fmt::Debug for Reading {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// Receives the snapshots of a run in order of time, and returns tables.
pub trait Reader: Send {
    /// Processes a snapshot.
    fn see(&mut self, snapshot: Snapshot);
    /// Returns the tables after the last snapshot.
    fn end(self: Box<Self>) -> Vec<Table>;
}

/// A named table of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name of the table.
    pub name: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Values of each column from top to bottom. A missing number is NaN.
    pub values: Vec<Vec<f64>>,
}

impl Table {
    /// Returns a table without rows.
    #[must_use]
    pub fn new(name: &str, columns: &[&str]) -> Self {
        let columns: Vec<String> = columns.iter().map(|&column| column.to_owned()).collect();
        Self { name: name.to_owned(), values: vec![Vec::new(); columns.len()], columns }
    }

    /// Adds a row. Missing numbers become NaN.
    pub fn push(&mut self, row: &[Option<f64>]) {
        for (at, column) in self.values.iter_mut().enumerate() {
            column.push(row.get(at).copied().flatten().unwrap_or(f64::NAN));
        }
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Returns the values of a column; none if there is no column with this name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let at = self.columns.iter().position(|column| column == name)?;
        Some(&self.values[at])
    }
}

/// Runs a scene with `threads` threads and processes the snapshots. Without an evaluation, the snapshots stay in the record.
///
/// # Errors
/// When the solver does not support the scene or fails.
pub fn run(
    solver: &dyn Solver,
    scene: &Scene,
    resolution: &Resolution,
    threads: usize,
    reading: Option<Reading>,
) -> Result<(Record, Vec<Table>), RunError> {
    let mut watcher = Watcher { threads, reader: reading.map(|reading| (reading.begin)(scene)) };
    let mut record = solver.run(scene, resolution, &mut watcher)?;
    let Some(mut reader) = watcher.reader else { return Ok((record, Vec::new())) };
    // An external program returns all snapshots at the end of the run.
    record.snapshots.drain(..).for_each(|snapshot| reader.see(snapshot));
    Ok((record, reader.end()))
}

/// Observer that passes snapshots to a reader and discards them. Without a reader it keeps the snapshots.
struct Watcher {
    threads: usize,
    reader: Option<Box<dyn Reader>>,
}

impl Observer for Watcher {
    fn options(&self) -> RunOptions {
        RunOptions { threads: self.threads, keep_snapshots: self.reader.is_none(), ..RunOptions::DEFAULT }
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        match &mut self.reader {
            None => Ok(Some(snapshot)),
            Some(reader) => {
                reader.see(snapshot);
                Ok(None)
            }
        }
    }
}
