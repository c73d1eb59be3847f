//! Store of the snapshots of a run. The latest snapshots are in memory, and all others are in parts on disk.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use grainbench_scene::columns::Columns;
use grainbench_solver::brief::Brief;
use grainbench_solver::record::Snapshot;
use serde::{Deserialize, Serialize};
use tempfile::TempDir;
use thiserror::Error;

use super::part::{OpenPart, Seal, files, rows_of, snapshots};
use super::rows::left_out;
use grainbench_store::{WriteError, parent_of, remove_leftovers, temporary_in};

/// Largest number of rows (grains, contacts and points) of a small run, whose snapshots are written as readable text.
pub const READABLE: u64 = 200_000;

/// Size of the snapshots in memory above which they are written to disk (bytes).
const WAITING: usize = 8 << 20;
/// Size at which a part is closed (bytes).
const PART: usize = 64 << 20;

/// Error when snapshots cannot be stored, or when the snapshots of a checkpoint cannot be restored.
#[derive(Debug, Error)]
pub enum StoreError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A part that belongs to the checkpoint is missing or has changed.
    #[error("the checkpoint needs its snapshots in {}: {found}", path.display())]
    Lost {
        /// Path of the part.
        path: PathBuf,
        /// Description of the part: missing or changed.
        found: &'static str,
    },
    /// The checkpoint belongs to a run that omitted snapshots, and the continued run needs them.
    #[error(
        "expected a checkpoint with the earlier snapshots, found a checkpoint of a run without snapshots: continue \
         without --write, or with --write none"
    )]
    LeftOut,
    /// The list of snapshots in the checkpoint cannot be read.
    #[error("the checkpoint is damaged: {0}")]
    Damaged(String),
}

/// Store of the snapshots of a run, in order of time.
#[derive(Default)]
pub struct SnapshotStore {
    /// Folder of the parts or, for scratch, the folder in which a hidden folder is created when it is first needed.
    root: PathBuf,
    /// True if the parts are in a hidden folder, which is deleted with the store.
    is_scratch: bool,
    scratch: Option<TempDir>,
    kept: CheckpointSnapshots,
    /// Size of the snapshots in memory (bytes).
    waiting_bytes: usize,
    open: Option<OpenPart>,
    /// True if no snapshot format is requested (see [`SnapshotStore::in_short`]).
    in_short: bool,
    /// Columns of the grains table that are not written.
    without: Vec<&'static str>,
}

/// Snapshots in a checkpoint: those in memory, and the list of closed parts.
#[derive(Default, Serialize, Deserialize)]
struct CheckpointSnapshots {
    waiting: Vec<Snapshot>,
    closed: Vec<Seal>,
    /// Number of all snapshots of the run.
    snapshots: u64,
    /// Summary and number of rows of the last snapshot.
    end: Option<(Brief, u64)>,
    /// Number of rows of grains, contacts and points of all snapshots.
    rows: u64,
    /// True if snapshots were omitted because no snapshot format is requested.
    left_out: bool,
}

impl SnapshotStore {
    /// Returns a store for a run with output in `out`. The parts are on the same disk, and are deleted with the store.
    #[must_use]
    pub fn for_output(out: &Path) -> Self {
        let beside = if out.is_dir() { out } else { parent_of(out) };
        Self { root: beside.to_path_buf(), is_scratch: true, ..Self::default() }
    }

    /// Returns a store whose parts are in `<checkpoint>.parts`, so that another run can continue from the checkpoint.
    #[must_use]
    pub fn for_checkpoint(checkpoint: &Path) -> Self {
        Self { root: parts_of(checkpoint), ..Self::default() }
    }

    /// Sets the grain columns of the run. Columns that its snapshots do not contain are not written.
    #[must_use]
    pub fn holding(self, columns: &Columns) -> Self {
        Self { without: left_out(columns), ..self }
    }

    /// Sets up the store for a run without a snapshot format. If the run exceeds [`READABLE`] rows, only the last
    /// snapshot is stored, and only if it has at most [`READABLE`] rows.
    #[must_use]
    pub fn in_short(self) -> Self {
        Self { in_short: true, ..self }
    }

    /// Restores the snapshots of a checkpoint (see [`SnapshotStore::keep`]). Parts in another folder are linked or
    /// copied.
    ///
    /// # Errors
    /// When a part is missing, has changed or cannot be copied, or when needed snapshots are not in the checkpoint.
    pub fn resume(mut self, checkpoint: &Path, kept: &[u8]) -> Result<Self, StoreError> {
        let kept: CheckpointSnapshots =
            postcard::from_bytes(kept).map_err(|error| StoreError::Damaged(error.to_string()))?;
        if kept.left_out && !self.in_short {
            return Err(StoreError::LeftOut);
        }
        let source = parts_of(checkpoint);
        for seal in &kept.closed {
            let from = source.join(&seal.name);
            let lost = |found| StoreError::Lost { path: from.clone(), found };
            if !from.is_dir() {
                return Err(lost("found nothing"));
            }
            if !seal.fits(&from) {
                return Err(lost("the files differ from the written files"));
            }
            let refused = |source| WriteError::new(&from, source);
            let to = self.folder().map_err(refused)?.join(&seal.name);
            if !same_place(&to, &from) {
                fs::create_dir_all(&to).map_err(refused)?;
                for (name, path) in files(&from) {
                    link_or_copy(&path, &to.join(name)).map_err(refused)?;
                }
            }
        }
        self.waiting_bytes = kept.waiting.iter().map(bytes).sum();
        self.kept = kept;
        Ok(self)
    }

    /// Adds a snapshot.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn add(&mut self, snapshot: Snapshot) -> Result<(), WriteError> {
        let rows = rows_of(&snapshot);
        self.kept.rows += rows;
        self.kept.snapshots += 1;
        self.kept.end = Some((Brief::from_snapshot(&snapshot), rows));
        if self.in_short && self.kept.rows > READABLE {
            self.leave_out();
            if rows > READABLE {
                return Ok(());
            }
        }
        self.waiting_bytes += bytes(&snapshot);
        self.kept.waiting.push(snapshot);
        if self.waiting_bytes < WAITING || self.in_short {
            return Ok(());
        }
        self.spill().map_err(|source| WriteError::new(&self.root, source))
    }

    /// Adds the last state of a run that crashed or was interrupted. It is stored even if no snapshot format is
    /// requested.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn add_last(&mut self, snapshot: Snapshot) -> Result<(), WriteError> {
        self.in_short = false;
        self.add(snapshot)
    }

    /// Returns true if snapshots were omitted because no snapshot format is requested.
    pub(crate) const fn has_left_out(&self) -> bool {
        self.in_short && self.kept.left_out
    }

    /// Returns the number of rows up to which the run must deliver a snapshot in full, not as a summary.
    #[must_use]
    pub const fn most_rows(&self) -> u64 {
        if self.in_short { READABLE } else { u64::MAX }
    }

    /// Counts a snapshot of which only a summary exists. `rows` is the number of its rows.
    pub fn pass(&mut self, brief: Brief, rows: u64) {
        self.kept.rows += rows;
        self.kept.snapshots += 1;
        self.kept.end = Some((brief, rows));
        self.leave_out();
    }

    /// Discards the snapshots in memory, and notes that snapshots were omitted.
    fn leave_out(&mut self) {
        self.kept.waiting.clear();
        (self.waiting_bytes, self.kept.left_out) = (0, true);
    }

    /// Closes the open part and returns the snapshots for a checkpoint: those in memory, and the names of the closed
    /// parts.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn keep(&mut self) -> Result<Vec<u8>, WriteError> {
        self.settle()?;
        postcard::to_allocvec(&self.kept).map_err(|error| WriteError::new(&self.root, io::Error::other(error)))
    }

    /// Deletes all parts that the store does not list. Call it only after writing a checkpoint that lists all parts.
    pub fn forget_others(&self) {
        if self.is_scratch {
            return;
        }
        let folder = &self.root;
        let _ = remove_leftovers(folder);
        let known: BTreeSet<OsString> = self.kept.closed.iter().map(|seal| OsString::from(&seal.name)).collect();
        let Ok(entries) = fs::read_dir(folder) else { return };
        for entry in entries.flatten().filter(|entry| !known.contains(&entry.file_name())) {
            remove_part(&entry.path());
        }
        if known.is_empty() {
            // This removes the folder only if it is empty.
            let _ = fs::remove_dir(folder);
        }
    }

    /// Writes the snapshots in memory to the open part and closes it. All snapshots can then be read. If no part is open, the
    /// snapshots stay in memory.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn settle(&mut self) -> Result<(), WriteError> {
        self.write_out(self.open.is_some())
    }

    /// Closes the open part. If `spills`, the snapshots in memory are written to it first.
    fn write_out(&mut self, spills: bool) -> Result<(), WriteError> {
        let spilled = if spills { self.spill() } else { Ok(()) };
        spilled.and_then(|()| self.close()).map_err(|source| WriteError::new(&self.root, source))
    }

    /// Returns the number of all snapshots of the run.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.kept.snapshots
    }

    /// Returns true if the run has no snapshots yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kept.snapshots == 0
    }

    /// Returns the number of rows of grains, contacts and points of all snapshots.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.kept.rows
    }

    /// Passes every snapshot, in closed parts and in memory, to `look`, one after another from the first.
    ///
    /// # Errors
    /// When a part cannot be read (`unreadable` makes the error), or when `look` fails.
    pub fn each<E>(
        &self,
        unreadable: impl Fn(io::Error) -> E,
        mut look: impl FnMut(&Snapshot) -> Result<(), E>,
    ) -> Result<(), E> {
        for seal in &self.kept.closed {
            for snapshot in snapshots(&self.place().join(&seal.name)).map_err(&unreadable)? {
                look(&snapshot.map_err(&unreadable)?)?;
            }
        }
        self.kept.waiting.iter().try_for_each(look)
    }

    /// Returns the summary of the last snapshot.
    #[must_use]
    pub fn end(&self) -> Option<&Brief> {
        self.kept.end.as_ref().map(|(end, _)| end)
    }

    /// Returns the last snapshot if it is stored and has at most [`READABLE`] rows; none otherwise.
    ///
    /// # Errors
    /// When the part of the snapshot cannot be read.
    pub(crate) fn readable_end(&self) -> io::Result<Option<Snapshot>> {
        if self.kept.end.as_ref().is_some_and(|&(_, rows)| rows > READABLE) {
            return Ok(None);
        }
        match (self.kept.waiting.last(), self.kept.closed.last()) {
            (None, Some(seal)) => {
                snapshots(&self.place().join(&seal.name))?.try_fold(None, |_, snapshot| snapshot.map(Some))
            }
            (last, _) => Ok(last.cloned()),
        }
    }

    /// Writes all snapshots in memory to disk. Returns the files of all parts: path, and path relative to the folder of
    /// the parts.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn files(&mut self) -> Result<Vec<(PathBuf, PathBuf)>, WriteError> {
        self.write_out(!self.kept.waiting.is_empty())?;
        let of_part = |seal: &Seal| {
            let name = PathBuf::from(&seal.name);
            files(&self.place().join(&seal.name)).into_iter().map(move |(file, path)| (path, name.join(file)))
        };
        Ok(self.kept.closed.iter().flat_map(of_part).collect())
    }

    fn spill(&mut self) -> io::Result<()> {
        let folder = self.folder()?;
        let waiting = std::mem::take(&mut self.kept.waiting);
        self.waiting_bytes = 0;
        let open = match &mut self.open {
            Some(open) => open,
            none => none.insert(OpenPart::begin(&folder, &self.without)?),
        };
        open.add(self.kept.snapshots - waiting.len() as u64, &waiting)?;
        if open.bytes() >= PART { self.close() } else { Ok(()) }
    }

    fn close(&mut self) -> io::Result<()> {
        if let Some(open) = self.open.take() {
            let folder = self.folder()?;
            self.kept.closed.push(open.close(&folder, self.kept.closed.len())?);
        }
        Ok(())
    }

    /// Returns the folder of the parts, and creates it if it is missing.
    fn folder(&mut self) -> io::Result<PathBuf> {
        if self.scratch.is_none() {
            fs::create_dir_all(&self.root)?;
            if self.is_scratch {
                self.scratch = Some(temporary_in(&self.root)?);
            }
        }
        Ok(self.place().to_path_buf())
    }

    /// Returns the folder of the parts, which may be missing.
    fn place(&self) -> &Path {
        self.scratch.as_ref().map_or(self.root.as_path(), TempDir::path)
    }
}

fn parts_of(checkpoint: &Path) -> PathBuf {
    let mut name = checkpoint.as_os_str().to_owned();
    name.push(".parts");
    PathBuf::from(name)
}

fn same_place(a: &Path, b: &Path) -> bool {
    fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
}

fn link_or_copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::remove_file(to).or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
    fs::hard_link(from, to).or_else(|_| fs::copy(from, to).map(drop))
}

/// Deletes a folder if it contains nothing but the files of a part.
fn remove_part(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    if entries.flatten().count() == files(folder).len() {
        let _ = fs::remove_dir_all(folder);
    }
}

/// Returns the approximate size of a snapshot in memory (bytes).
fn bytes(snapshot: &Snapshot) -> usize {
    size_of_val(snapshot)
        + size_of_val(snapshot.grains.as_slice())
        + size_of_val(snapshot.told_contacts())
        + size_of_val(snapshot.points.as_slice())
        + size_of_val(snapshot.walls.as_slice())
        + size_of_val(snapshot.bodies.as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    /// Returns snapshots with all tables, all kinds of absent values, and numbers that short text would round.
    fn snapshots(count: u64) -> Vec<Snapshot> {
        let make = |step: u64| {
            let mut snapshot = if step.is_multiple_of(2) { sample::snapshot() } else { sample::deformable() };
            (snapshot.step, snapshot.time) = (step, 0.1 * step as f64);
            snapshot.grains[0].position.x = f64::from_bits(0x3fb9_9999_9999_999a + step);
            snapshot.grains[1].velocity.y = -0.0;
            if step.is_multiple_of(3) {
                snapshot.contacts = None;
                snapshot.grains[1].force = None;
                snapshot.grains[1].angle = None;
                snapshot.walls[0].force = None;
            }
            snapshot
        };
        (0..count).map(make).collect()
    }

    fn all(store: &SnapshotStore) -> Vec<Snapshot> {
        let mut all = Vec::new();
        let read = store.each(std::convert::identity, |snapshot| {
            all.push(snapshot.clone());
            Ok(())
        });
        read.unwrap();
        all
    }

    #[test]
    fn what_was_added_comes_back_in_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = SnapshotStore::for_output(&folder.path().join("out"));
        let snapshots = snapshots(40);
        for (at, snapshot) in snapshots.iter().enumerate() {
            store.add(snapshot.clone()).unwrap();
            if at % 7 == 3 {
                store.spill().unwrap();
            }
            if at % 14 == 3 {
                store.close().unwrap();
            }
        }
        store.settle().unwrap();
        assert!(store.kept.closed.len() > 2 && store.len() == 40, "{:?}", store.kept.closed);
        assert_eq!(format!("{:?}", all(&store)), format!("{snapshots:?}"));
        assert_eq!(store.readable_end().unwrap().as_ref(), snapshots.last());
        drop(store);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "scratch goes with the store");
    }

    #[test]
    fn a_checkpoint_names_its_parts_and_continues_from_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoint = folder.path().join("run.checkpoint");
        let snapshots = snapshots(20);
        let mut store = SnapshotStore::for_checkpoint(&checkpoint);
        snapshots[..10].iter().for_each(|snapshot| store.add(snapshot.clone()).unwrap());
        store.spill().unwrap();
        let kept = store.keep().unwrap();
        // The run writes further snapshots after the checkpoint and is then killed.
        store.add(snapshots[10].clone()).unwrap();
        store.spill().unwrap();
        store.close().unwrap();
        let parts = parts_of(&checkpoint);
        assert_eq!(fs::read_dir(&parts).unwrap().count(), 2);

        let mut resumed = SnapshotStore::for_checkpoint(&checkpoint).resume(&checkpoint, &kept).unwrap();
        assert_eq!(all(&resumed), snapshots[..10]);
        snapshots[10..].iter().for_each(|snapshot| resumed.add(snapshot.clone()).unwrap());
        assert_eq!(all(&resumed), snapshots);
        resumed.keep().unwrap();
        resumed.forget_others();
        assert_eq!(fs::read_dir(&parts).unwrap().count(), 1, "what nothing names goes");

        // A store in another folder links or copies the parts.
        let elsewhere = SnapshotStore::for_output(&folder.path().join("out")).resume(&checkpoint, &kept).unwrap();
        assert_eq!(all(&elsewhere), snapshots[..10]);

        let part = fs::read_dir(&parts).unwrap().next().unwrap().unwrap().path();
        let grains = part.join("grains.parquet");
        let mut bytes = fs::read(&grains).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&grains, bytes).unwrap();
        let again = || SnapshotStore::for_checkpoint(&checkpoint).resume(&checkpoint, &kept);
        assert!(matches!(again(), Err(StoreError::Lost { .. })), "changed");
        fs::remove_dir_all(&part).unwrap();
        assert!(matches!(again(), Err(StoreError::Lost { .. })), "gone");
    }

    #[test]
    fn what_nobody_wants_is_not_kept_and_cannot_be_asked_for_later() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoint = folder.path().join("run.checkpoint");
        let many = Snapshot { grains: vec![sample::snapshot().grains[0].clone(); 150_000], ..sample::snapshot() };
        let mut store = SnapshotStore::for_checkpoint(&checkpoint).in_short();
        for step in 0..3 {
            store.add(Snapshot { step, ..many.clone() }).unwrap();
        }
        assert_eq!((all(&store).len(), store.len(), store.end().unwrap().step), (1, 3, 2));
        assert_eq!(store.readable_end().unwrap().unwrap().step, 2);
        let kept = store.keep().unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing goes to disk");
        let again = || SnapshotStore::for_checkpoint(&checkpoint);
        assert!(matches!(again().resume(&checkpoint, &kept), Err(StoreError::LeftOut)));
        let resumed = again().in_short().resume(&checkpoint, &kept).unwrap();
        assert_eq!((resumed.len(), resumed.rows(), resumed.end()), (3, store.rows(), store.end()));
        assert!(resumed.rows() > 2 * READABLE);
    }

    #[test]
    fn memory_holds_a_few_snapshots_and_disk_the_others() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = SnapshotStore::for_output(&folder.path().join("out"));
        let many = Snapshot { grains: vec![sample::snapshot().grains[0].clone(); 10_000], ..sample::snapshot() };
        for _ in 0..20 {
            store.add(many.clone()).unwrap();
            assert!(store.waiting_bytes < WAITING);
        }
        store.settle().unwrap();
        assert!(store.kept.waiting.is_empty() && all(&store).len() == 20);
    }
}
