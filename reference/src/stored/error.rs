//! Why a stored run cannot be used.

use std::io;
use std::path::{Path, PathBuf};

use crate::read::read_error::{ReadError, one_line};

/// A stored run that is missing, incomplete, or not what it was when it was stored.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoredError {
    /// A name that could lead out of the folder it belongs to.
    #[error("{place}: expected a plain name of letters, digits, `.`, `-` and `_`, found `{}`", name.escape_debug())]
    Name {
        /// Where the name stands.
        place: String,
        /// The name.
        name: String,
    },
    /// A file of the run cannot be read.
    #[error("{}: expected a readable file, found {source}", shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The provenance is not understood.
    #[error("{}:{line}: expected the provenance of a stored run, found {}", shown(path), one_line(source.message()))]
    Provenance {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What the reader of TOML says.
        source: Box<toml::de::Error>,
    },
    /// A file of the run is no longer the one that was stored.
    #[error("{}: expected the file with BLAKE3 {}, found {found}", shown(path), one_line(expected))]
    Changed {
        /// The file.
        path: PathBuf,
        /// The hash in the provenance.
        expected: String,
        /// The hash of the file as it is.
        found: String,
    },
    /// A file is asked for that the provenance does not vouch for.
    #[error("{}: expected the hash of `{name}`, found none", shown(provenance))]
    Unlisted {
        /// The provenance.
        provenance: PathBuf,
        /// The file.
        name: String,
    },
    /// A series of the run is damaged.
    #[error(transparent)]
    Series(#[from] ReadError),
    /// A series lacks a column.
    #[error("{}: expected a column `{name}`, found none", shown(path))]
    Column {
        /// The series.
        path: PathBuf,
        /// The column.
        name: String,
    },
    /// The run and its half-step run cannot be compared line by line.
    #[error("{}: expected the times of `series.csv.gz`, found {found}", shown(path))]
    Twin {
        /// The half-step run's series.
        path: PathBuf,
        /// How it differs.
        found: String,
    },
}

/// A path as an error may repeat it, on one line.
fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy())
}
