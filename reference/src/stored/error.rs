//! Errors of stored runs.

use crate::read::read_error::ReadError;

/// Error of a stored run that is missing, incomplete or changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoredError {
    /// A file of the run is missing, damaged or changed.
    #[error(transparent)]
    File(#[from] grainbench_store::ReadError),
    /// A series of the run is damaged.
    #[error(transparent)]
    Series(#[from] ReadError),
}
