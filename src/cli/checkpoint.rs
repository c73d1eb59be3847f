//! Checkpoint files.

use super::exit::Fault;
use grainbench::solver::checkpoint::Checkpoint;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Returns an error if the path exists and is not a checkpoint, because a checkpoint would replace it.
pub(crate) fn refuse_others(path: &Path) -> Result<(), Fault> {
    let found = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => error.to_string(),
        Ok(metadata) if !metadata.is_file() => "something that is not a file".to_owned(),
        Ok(_) => match Checkpoint::is_one(path) {
            Ok(true) => return Ok(()),
            Ok(false) => "another file".to_owned(),
            Err(error) => error.to_string(),
        },
    };
    let there = path.display();
    Err(Fault::input(format!("--checkpoint {there}: expected no file, or a checkpoint to replace; found {found}")))
}

pub(crate) fn read(path: &Path) -> Result<Checkpoint, Fault> {
    let refused = |reason: String| Fault::input(format!("{}: {reason}", path.display()));
    let bytes = fs::read(path).map_err(|error| refused(error.to_string()))?;
    Checkpoint::from_bytes(&bytes).map_err(|error| refused(error.to_string()))
}
