//! Errors of stored runs.

use std::io;
use std::path::{Path, PathBuf};

use crate::read::read_error::{ReadError, one_line};

/// Error of a stored run that is missing, incomplete or changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoredError {
    /// The name of a run or a file is not a plain name.
    #[error("{place}: expected a plain name of letters, digits, `.`, `-` and `_`, found `{}`", name.escape_debug())]
    Name {
        /// Path of the file that contains the name.
        place: String,
        /// The invalid name.
        name: String,
    },
    /// A file of the run cannot be read.
    #[error("{}: expected a readable file, found {source}", shown(path))]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The provenance file is not valid.
    #[error("{}:{line}: expected the provenance of a stored run, found {}", shown(path), one_line(source.message()))]
    Provenance {
        /// Path of the provenance file.
        path: PathBuf,
        /// Line number, counted from 1.
        line: usize,
        /// Error of the TOML parser.
        source: Box<toml::de::Error>,
    },
    /// A file of the run has changed since it was stored.
    #[error("{}: expected the file with BLAKE3 {}, found {found}", shown(path), one_line(expected))]
    Changed {
        /// Path of the file.
        path: PathBuf,
        /// BLAKE3 hash in the provenance.
        expected: String,
        /// Actual BLAKE3 hash of the file.
        found: String,
    },
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
