//! Reader of the snapshots in an output directory of `simulate`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use grainbench_solver::record::Snapshot;

use super::part::snapshots;
use crate::export::record_json;

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
        let record = record_json::load(dir).map_err(|error| unreadable(error.to_string()))?;
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
