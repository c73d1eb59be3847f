//! Writing of files. Each file is written completely or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::scratch::temporary_in;

/// Error when a file or directory cannot be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct WriteError {
    /// Path of the file or directory.
    pub path: PathBuf,
    /// Error of the operating system.
    pub source: io::Error,
}

impl WriteError {
    /// Returns the error of writing `path`.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, source: io::Error) -> Self {
        Self { path: path.into(), source }
    }
}

/// Writes `bytes` to a temporary file and renames it to `path`, so that a reader never sees an incomplete file.
///
/// # Errors
/// When the directory does not exist, is read-only or full, or when `path` is a directory.
pub fn write_file(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> Result<(), WriteError> {
    let path = path.as_ref();
    let write = || -> io::Result<()> {
        let name =
            path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        let beside = temporary_in(parent_of(path))?;
        let staged = beside.path().join(name);
        fs::write(&staged, bytes.as_ref())?;
        fs::rename(&staged, path)
    };
    write().map_err(|source| WriteError::new(path, source))
}

/// Returns the directory that contains `path`. For a bare file name this is the current directory.
#[must_use]
pub fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_beside_it() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_file(&path, "one").unwrap();
        write_file(&path, "two").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn says_what_could_not_be_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("missing/a.txt");
        let message = write_file(&path, "one").unwrap_err().to_string();
        assert!(message.starts_with(&format!("cannot write {}: ", path.display())), "{message}");
        let message = write_file(dir.path(), "one").unwrap_err().to_string();
        assert!(message.contains("cannot write"), "{message}");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
