//! Checkpoint files.

use super::exit::Fault;
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::store::write_file;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// File of the checkpoints of a run. Each checkpoint replaces the previous one.
pub(crate) struct Store {
    pub(crate) path: PathBuf,
    /// Number of steps between checkpoints.
    pub(crate) every: u64,
}

impl Store {
    /// Returns an error if the path exists and is not a checkpoint, because a checkpoint would replace it.
    pub(crate) fn refuse_others(&self) -> Result<(), Fault> {
        let refused = |found: &str| {
            let there = self.path.display();
            Err(Fault::input(format!(
                "--checkpoint {there}: expected no file, or a checkpoint to replace; found {found}"
            )))
        };
        match fs::symlink_metadata(&self.path) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
            Err(error) => refused(&error.to_string()),
            Ok(metadata) if !metadata.is_file() => refused("something that is not a file"),
            Ok(_) => match Checkpoint::is_one(&self.path) {
                Ok(true) => Ok(()),
                Ok(false) => refused("another file"),
                Err(error) => refused(&error.to_string()),
            },
        }
    }

    /// Writes a checkpoint in one atomic operation.
    pub(crate) fn put(&self, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
        write_file(&self.path, checkpoint.to_bytes()?).map_err(|error| CheckpointError::NotStored(error.to_string()))
    }
}

/// Reads a checkpoint from a file.
pub(crate) fn read(path: &Path) -> Result<Checkpoint, Fault> {
    let refused = |reason: String| Fault::input(format!("{}: {reason}", path.display()));
    let bytes = fs::read(path).map_err(|error| refused(error.to_string()))?;
    Checkpoint::from_bytes(&bytes).map_err(|error| refused(error.to_string()))
}
