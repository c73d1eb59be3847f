//! Finished pieces of work, each in a file of its own under a name that says what it is.

use grainbench_reports::{WriteError, sweep, write_file};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Where finished pieces are kept, or nowhere.
#[derive(Clone, Debug)]
pub struct ResultCache {
    folder: Option<PathBuf>,
    fresh: bool,
}

impl ResultCache {
    /// A result cache in a folder, which is made when it is not there; with `fresh`, what stands on it is not taken.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn open(folder: &Path, fresh: bool) -> Result<Self, WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError::new(folder, source))?;
        let cache = Self { folder: Some(folder.to_owned()), fresh };
        // Of a program that was killed while it wrote, here or in the directory of the report; what has its name is
        // whole.
        for place in [Some(folder), folder.parent()].into_iter().flatten() {
            sweep(place).map_err(|source| WriteError::new(place, source))?;
        }
        Ok(cache)
    }

    /// No result cache: nothing is kept, nothing is found.
    #[must_use]
    pub const fn none() -> Self {
        Self { folder: None, fresh: false }
    }

    fn path(&self, name: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(format!("{name}.json")))
    }

    /// A piece of that name, if it stands here and can be read. One that cannot is done again.
    #[must_use]
    pub fn take<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        if self.fresh {
            return None;
        }
        let text = fs::read_to_string(self.path(name)?).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps a piece, whole or not at all.
    ///
    /// # Errors
    /// When the disk refuses.
    pub fn put<T: Serialize>(&self, name: &str, piece: &T) -> Result<(), WriteError> {
        let Some(path) = self.path(name) else { return Ok(()) };
        let text = serde_json::to_string(piece).map_err(|error| WriteError::new(&path, io::Error::other(error)))?;
        write_file(&path, text)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    #[test]
    fn gives_back_what_was_kept_and_nothing_that_was_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let cache = ResultCache::open(folder.path(), false).unwrap();
        assert_eq!(cache.take::<u32>("a"), None);
        cache.put("a", &7_u32).unwrap();
        assert_eq!(cache.take::<u32>("a"), Some(7));
        assert_eq!(ResultCache::open(folder.path(), true).unwrap().take::<u32>("a"), None);
        fs::write(folder.path().join("a.json"), "[7").unwrap();
        assert_eq!(cache.take::<u32>("a"), None);
        assert_eq!(ResultCache::none().take::<u32>("a"), None);
    }
}
