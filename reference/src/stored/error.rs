//! Errors of stored runs.

use std::path::{Path, PathBuf};

use crate::read::read_error::{ReadError, one_line};

/// Error of a stored run that is missing, incomplete or changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoredError {
    /// A file of the run is missing, damaged or changed.
    #[error(transparent)]
    File(#[from] grainbench_store::ReadError),
    /// The provenance lacks the hash of a required file.
    #[error("{}: expected the hash of `{name}`, found none", shown(provenance))]
    Unlisted {
        /// Path of the provenance file.
        provenance: PathBuf,
        /// Name of the file without a hash.
        name: String,
    },
    /// A series of the run is damaged.
    #[error(transparent)]
    Series(#[from] ReadError),
    /// A series lacks a column.
    #[error("{}: expected a column `{name}`, found none", shown(path))]
    Column {
        /// Path of the series.
        path: PathBuf,
        /// Name of the missing column.
        name: String,
    },
    /// The samples of the run and of its half-step run are at different times.
    #[error("{}: expected the times of `series.csv.gz`, found {found}", shown(path))]
    Twin {
        /// Path of the series of the half-step run.
        path: PathBuf,
        /// Description of the difference.
        found: String,
    },
}

/// Returns a path on one line for error messages.
fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy())
}
