//! Cache of finished results. Each result has its own file, whose name is the hash of the task.

use grainbench_store::{WriteError, remove_leftovers, write_file};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Function that returns the stored text of a name.
type CacheReader = Box<dyn Fn(&str) -> Option<String> + Send + Sync>;
/// Function that stores a text under a name.
type CacheWriter = Box<dyn Fn(&str, &str) -> Result<(), WriteError> + Send + Sync>;

/// Cache of finished results. A disabled cache stores nothing.
pub struct ResultCache {
    place: Place,
}

/// Storage of a result cache.
enum Place {
    Nowhere,
    /// Folder, and true to ignore existing results.
    Folder(PathBuf, bool),
    /// Functions of the caller that read and store texts.
    Elsewhere(CacheReader, CacheWriter),
}

impl ResultCache {
    /// Opens a cache in a folder and creates the folder if necessary. Existing results are ignored if `fresh` is true.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path, fresh: bool) -> Result<Self, WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError::new(folder, source))?;
        // Removes temporary files of killed programs from the folder and from its parent, which is the directory of the
        // report. Files with final names are complete.
        for place in [Some(folder), folder.parent()].into_iter().flatten() {
            remove_leftovers(place).map_err(|source| WriteError::new(place, source))?;
        }
        Ok(Self { place: Place::Folder(folder.to_owned(), fresh) })
    }

    /// Returns a disabled cache.
    #[must_use]
    pub const fn none() -> Self {
        Self { place: Place::Nowhere }
    }

    /// Returns a cache that reads and stores texts by the given functions.
    #[must_use]
    pub fn elsewhere(
        gives: impl Fn(&str) -> Option<String> + Send + Sync + 'static,
        takes: impl Fn(&str, &str) -> Result<(), WriteError> + Send + Sync + 'static,
    ) -> Self {
        Self { place: Place::Elsewhere(Box::new(gives), Box::new(takes)) }
    }

    /// Returns the result that is stored under a name, or `None` if there is no readable result.
    #[must_use]
    pub fn take<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let text = match &self.place {
            Place::Nowhere | Place::Folder(_, true) => return None,
            Place::Folder(folder, false) => fs::read_to_string(file(folder, name)).ok()?,
            Place::Elsewhere(gives, _) => gives(name)?,
        };
        serde_json::from_str(&text).ok()
    }

    /// Stores a result under a name. The file is written completely or not at all.
    ///
    /// # Errors
    /// When the disk rejects the write.
    pub fn put<T: Serialize>(&self, name: &str, piece: &T) -> Result<(), WriteError> {
        let text = || serde_json::to_string(piece).map_err(|error| WriteError::new(name, io::Error::other(error)));
        match &self.place {
            Place::Nowhere => Ok(()),
            Place::Folder(folder, _) => write_file(file(folder, name), text()?),
            Place::Elsewhere(_, takes) => takes(name, &text()?),
        }
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
