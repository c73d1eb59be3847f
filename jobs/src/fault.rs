//! Errors when plans are made, run or reported.

use grainbench_store::{ReadError, WriteError};
use std::fmt::Display;
use std::path::Path;
use thiserror::Error;

/// Error when a plan is made, run or reported.
#[derive(Debug, Error)]
pub enum Fault {
    /// Invalid input. The message names the place, the expected and the actual content.
    #[error("{0}")]
    Input(String),
    /// A stored file is damaged, or is another file than expected.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The disk rejected a write.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A batch system failed or gave an unexpected answer.
    #[error("{0}")]
    Batch(String),
}

impl Fault {
    /// Returns an input error from the place, the expected and the actual content.
    pub fn expected(place: impl Display, expected: impl Display, found: impl Display) -> Self {
        Self::Input(format!("{place}: expected {expected}, found {found}"))
    }

    /// Returns an input error whose place is a line of a file. `line` is its index, from 0.
    pub fn in_line(path: &Path, line: usize, expected: impl Display, found: impl Display) -> Self {
        Self::expected(format_args!("{}:{}", path.display(), line + 1), expected, found)
    }

    /// Returns an input error whose place is a key of a file.
    pub fn at_key(path: &Path, key: impl Display, expected: impl Display, found: impl Display) -> Self {
        Self::expected(format_args!("{}: {key}", path.display()), expected, found)
    }

    /// Returns an input error whose place is a file.
    pub fn in_file(path: &Path, expected: impl Display, found: impl Display) -> Self {
        Self::expected(path.display(), expected, found)
    }
}
