//! Complete record of a run as JSON, and reader of the output directory of `simulate`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use grainbench_solver::record::{Cost, Provenance, Record, Series, Snapshot};
use grainbench_store::ReadError;
use grainbench_store::artifact::read_json;
use serde::ser::{Error, SerializeSeq};
use serde::{Serialize, Serializer};

use crate::export::BROKEN_FILE;
use crate::parts::{READABLE, SnapshotStore, snapshots};

/// Name of the file of a record.
pub const RECORD_FILE: &str = "record.json";

/// Writes the record on one line, because it may contain millions of numbers. The numbers read back to the same bits.
///
/// The snapshots come from the store. The record of a run with at most [`READABLE`] rows contains all snapshots. The record of
/// a larger run contains only the last snapshot, or no snapshot if the last one alone has more than [`READABLE`] rows.
///
/// # Errors
/// When `out` cannot be written, or when a snapshot cannot be read.
pub fn write(record: &Record, snapshots: &SnapshotStore, mut out: impl Write) -> io::Result<()> {
    let Record { provenance, series, cost, .. } = record;
    serde_json::to_writer(&mut out, &StreamedRecord { provenance, series, snapshots, cost })?;
    out.write_all(b"\n")
}

/// A record in the format of [`Record`]. Its snapshots are read from the store while it is written.
#[derive(Serialize)]
struct StreamedRecord<'r> {
    provenance: &'r Provenance,
    series: &'r Series,
    #[serde(serialize_with = "stored")]
    snapshots: &'r SnapshotStore,
    cost: &'r Cost,
}

fn stored<S: Serializer>(snapshots: &SnapshotStore, serializer: S) -> Result<S::Ok, S::Error> {
    let mut all = serializer.serialize_seq(None)?;
    if snapshots.rows() <= READABLE {
        snapshots.each(S::Error::custom, |snapshot| all.serialize_element(snapshot))?;
    } else if let Some(last) = snapshots.readable_end().map_err(S::Error::custom)? {
        all.serialize_element(&last)?;
    }
    all.end()
}

/// Reads the record of a simulation from `dir`.
///
/// # Errors
/// When the file is missing or damaged, or when the run crashed. The message names the file.
pub fn load(dir: &Path) -> Result<Record, ReadError> {
    let (path, broken) = (dir.join(RECORD_FILE), dir.join(BROKEN_FILE));
    if broken.is_file() {
        let found = "the reason why the run did not finish";
        return Err(ReadError::other(&broken, "a complete record", found));
    }
    read_json(&path)
}

/// Passes every stored snapshot of a run to `look`, in order of time. The snapshots come from the parts in `snapshots/` if
/// this folder exists, otherwise from the record.
///
/// # Errors
/// When the directory contains no run, when a file cannot be read (`unreadable` makes the error), or when `look` fails.
pub fn each_snapshot<E>(
    dir: &Path,
    unreadable: impl Fn(String) -> E,
    look: &mut impl FnMut(Snapshot) -> Result<(), E>,
) -> Result<(), E> {
    let folder = dir.join("snapshots");
    if !folder.is_dir() {
        let record = load(dir).map_err(|error| unreadable(error.to_string()))?;
        return record.snapshots.into_iter().try_for_each(look);
    }
    let failed = |path: &Path, error: io::Error| unreadable(format!("{}: cannot be read: {error}", path.display()));
    let entries = fs::read_dir(&folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let entries = entries.map_err(|error| failed(&folder, error))?.into_iter();
    let mut parts: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
    // The name of a part begins with its number.
    parts.sort();
    for part in parts {
        let failed = |error| failed(&part, error);
        for snapshot in snapshots(&part).map_err(failed)? {
            look(snapshot.map_err(failed)?)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn reads_back_the_same() {
        let record = sample::record();
        let folder = tempfile::tempdir().unwrap();
        let mut store = SnapshotStore::for_output(&folder.path().join("out"));
        record.snapshots.iter().for_each(|snapshot| store.add(snapshot.clone()).unwrap());
        let mut out = Vec::new();
        write(&record, &store, &mut out).unwrap();
        assert_eq!(serde_json::from_slice::<Record>(&out).unwrap(), record);
        assert_eq!(out.iter().filter(|&&letter| letter == b'\n').count(), 1);
    }

    #[test]
    fn a_large_run_keeps_its_last_snapshot() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = SnapshotStore::for_output(&folder.path().join("out"));
        let many = Snapshot { grains: vec![sample::snapshot().grains[0].clone(); 70_000], ..sample::snapshot() };
        for step in 0..3 {
            store.add(Snapshot { step, ..many.clone() }).unwrap();
        }
        store.settle().unwrap();
        let mut out = Vec::new();
        write(&sample::record(), &store, &mut out).unwrap();
        let read: Record = serde_json::from_slice(&out).unwrap();
        assert_eq!(read.snapshots.iter().map(|snapshot| snapshot.step).collect::<Vec<_>>(), [2]);
    }
}
