//! What is read of the snapshots of a run as they come, where all of them together are too many to keep: a reader sees each
//! once and leaves tables.

use grainbench_scene::record::{Record, Snapshot};
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{NotStored, Resolution, RunError, Solver, Watch};
use std::fmt;

/// A way to read the snapshots of a run.
#[derive(Clone, Copy)]
pub struct Reading {
    /// Its name, which tells runs that are read differently apart.
    pub name: &'static str,
    /// A reader that has seen nothing yet, of a scene as the case means it.
    pub begin: fn(&Scene) -> Box<dyn Reader>,
}

impl fmt::Debug for Reading {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// Reads snapshots in order of time.
pub trait Reader: Send {
    /// Sees a snapshot.
    fn see(&mut self, snapshot: Snapshot);
    /// What it found.
    fn end(self: Box<Self>) -> Vec<Table>;
}

/// Numbers under names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The columns, each from top to bottom; no number where there is none.
    pub values: Vec<Vec<f64>>,
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new(name: &str, columns: &[&str]) -> Self {
        let columns: Vec<String> = columns.iter().map(|&column| column.to_owned()).collect();
        Self { name: name.to_owned(), values: vec![Vec::new(); columns.len()], columns }
    }

    /// Adds a row; what is missing of it is no number.
    pub fn push(&mut self, row: &[Option<f64>]) {
        for (at, column) in self.values.iter_mut().enumerate() {
            column.push(row.get(at).copied().flatten().unwrap_or(f64::NAN));
        }
    }

    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// The values of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let at = self.columns.iter().position(|column| column == name)?;
        Some(&self.values[at])
    }
}

/// Runs a scene with so many threads, and reads its snapshots; without a reading the record keeps them.
///
/// # Errors
/// When the solver cannot run the scene or breaks.
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
    // What a program leaves comes all at once.
    record.snapshots.drain(..).for_each(|snapshot| reader.see(snapshot));
    Ok((record, reader.end()))
}

/// Hands snapshots to a reader, and keeps none of those that one takes.
struct Watcher {
    threads: usize,
    reader: Option<Box<dyn Reader>>,
}

impl Watch for Watcher {
    fn threads(&self) -> usize {
        self.threads
    }

    fn progress(&mut self, _done: u64, _total: u64) {}

    fn keeps_snapshots(&self) -> bool {
        self.reader.is_none()
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, NotStored> {
        match &mut self.reader {
            None => Ok(Some(snapshot)),
            Some(reader) => {
                reader.see(snapshot);
                Ok(None)
            }
        }
    }
}
