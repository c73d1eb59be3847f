//! Why a plan cannot be read, worked on or collected.

use grainbench_reports::WriteError;
use std::fmt::Display;
use std::path::Path;
use thiserror::Error;

/// What went wrong.
#[derive(Debug, Error)]
pub enum Fault {
    /// What was given is not what it should be: place, what was expected, what was found.
    #[error("{0}")]
    Input(String),
    /// The disk refused.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A batch system did not do what it was asked for.
    #[error("{0}")]
    Batch(String),
}

impl Fault {
    /// What was expected at a place, and what was found there.
    pub fn expected(place: impl Display, expected: impl Display, found: impl Display) -> Self {
        Self::Input(format!("{place}: expected {expected}, found {found}"))
    }

    /// The same of a file.
    pub fn in_file(path: &Path, expected: impl Display, found: impl Display) -> Self {
        Self::expected(path.display(), expected, found)
    }
}
