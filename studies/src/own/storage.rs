//! Finished runs of a study, one file each. The name of a file is the hash of everything that determines the run.

use grainbench_store::{WriteError, remove_leftovers, write_file};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Storage of finished runs in a folder, or nowhere.
pub struct RunStore {
    folder: Option<PathBuf>,
    /// True to ignore existing files.
    is_fresh: bool,
}

impl RunStore {
    /// Opens a folder and creates it if necessary. Existing files are ignored if `is_fresh` is true.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path, is_fresh: bool) -> Result<Self, WriteError> {
        let failed = |source| WriteError::new(folder, source);
        fs::create_dir_all(folder).map_err(failed)?;
        remove_leftovers(folder).map_err(failed)?;
        Ok(Self { folder: Some(folder.to_owned()), is_fresh })
    }

    /// Returns a storage that stores nothing.
    #[must_use]
    pub const fn none() -> Self {
        Self { folder: None, is_fresh: true }
    }

    /// Returns the run that is stored under a name, or `None` if there is no readable file.
    #[must_use]
    pub fn take<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let folder = self.folder.as_ref().filter(|_| !self.is_fresh)?;
        serde_json::from_str(&fs::read_to_string(file(folder, name)).ok()?).ok()
    }

    /// Stores a run under a name. The file is written completely or not at all.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn put<T: Serialize>(&self, name: &str, run: &T) -> Result<(), WriteError> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let text = serde_json::to_string(run).map_err(|error| WriteError::new(name, io::Error::other(error)))?;
        write_file(file(folder, name), text)
    }
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.json"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn gives_back_whole_files_alone() {
        let folder = tempfile::tempdir().unwrap();
        let runs = RunStore::open(folder.path(), false).unwrap();
        assert_eq!(runs.take::<u32>("a"), None);
        runs.put("a", &7_u32).unwrap();
        assert_eq!(runs.take::<u32>("a"), Some(7));
        assert_eq!(RunStore::open(folder.path(), true).unwrap().take::<u32>("a"), None);
        fs::write(folder.path().join("a.json"), "[7").unwrap();
        assert_eq!(runs.take::<u32>("a"), None);
        RunStore::none().put("a", &7_u32).unwrap();
        assert_eq!(RunStore::none().take::<u32>("a"), None);
    }
}
