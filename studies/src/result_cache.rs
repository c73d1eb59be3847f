//! Finished pieces of work, each in a file of its own under a name that says what it is.

use grainbench_reports::{WriteError, sweep, write_file};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Gives the text of the piece of a name.
type Gives = Box<dyn Fn(&str) -> Option<String> + Send + Sync>;
/// Takes the text of the piece of a name.
type Takes = Box<dyn Fn(&str, &str) -> Result<(), WriteError> + Send + Sync>;

/// Where finished pieces are kept, or nowhere.
pub struct ResultCache {
    place: Place,
}

/// The place.
enum Place {
    Nowhere,
    /// A folder, of which nothing is taken where all is to be done anew.
    Folder(PathBuf, bool),
    /// Somebody else's.
    Elsewhere(Gives, Takes),
}

impl ResultCache {
    /// A result cache in a folder, which is made when it is not there; with `fresh`, what stands on it is not taken.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn open(folder: &Path, fresh: bool) -> Result<Self, WriteError> {
        fs::create_dir_all(folder).map_err(|source| WriteError::new(folder, source))?;
        // Of a program that was killed while it wrote, here or in the directory of the report; what has its name is
        // whole.
        for place in [Some(folder), folder.parent()].into_iter().flatten() {
            sweep(place).map_err(|source| WriteError::new(place, source))?;
        }
        Ok(Self { place: Place::Folder(folder.to_owned(), fresh) })
    }

    /// No result cache: nothing is kept, nothing is found.
    #[must_use]
    pub const fn none() -> Self {
        Self { place: Place::Nowhere }
    }

    /// A result cache of somebody else's, who gives the texts of pieces and takes them.
    #[must_use]
    pub fn elsewhere(
        gives: impl Fn(&str) -> Option<String> + Send + Sync + 'static,
        takes: impl Fn(&str, &str) -> Result<(), WriteError> + Send + Sync + 'static,
    ) -> Self {
        Self { place: Place::Elsewhere(Box::new(gives), Box::new(takes)) }
    }

    /// A piece of that name, if it stands here and can be read. One that cannot is done again.
    #[must_use]
    pub fn take<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let text = match &self.place {
            Place::Nowhere | Place::Folder(_, true) => return None,
            Place::Folder(folder, false) => fs::read_to_string(file(folder, name)).ok()?,
            Place::Elsewhere(gives, _) => gives(name)?,
        };
        serde_json::from_str(&text).ok()
    }

    /// Keeps a piece, whole or not at all.
    ///
    /// # Errors
    /// When the disk refuses.
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
