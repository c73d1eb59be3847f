//! Manifest of an output directory: the names of the files that this program wrote, and a mark of an interrupted
//! replacement. If a process ends while it replaces files, the directory contains files of two runs.

use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::write::write_file;

/// Name of the manifest file.
pub(crate) const MANIFEST: &str = "manifest.json";

/// Manifest: the files that this program wrote to a directory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// False from the beginning of a replacement of files until all files are replaced.
    pub(crate) whole: bool,
    /// Paths of the files relative to the directory.
    pub(crate) files: Vec<PathBuf>,
}

impl Manifest {
    /// Reads the manifest of a directory; returns `None` if it is missing or invalid.
    pub(crate) fn read(directory: &Path) -> Option<Self> {
        serde_json::from_str(&fs::read_to_string(directory.join(MANIFEST)).ok()?).ok()
    }

    pub(crate) fn write(&self, directory: &Path) -> io::Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(io::Error::other)?;
        write_file(directory.join(MANIFEST), text + "\n").map_err(|error| error.source)
    }
}

/// Returns the names of the files that this program wrote to a directory, relative to it. Without a manifest, there are none.
#[must_use]
pub fn written_files(directory: &Path) -> Vec<PathBuf> {
    Manifest::read(directory).map(|manifest| manifest.files).unwrap_or_default()
}

/// Checks that a directory does not contain files of two runs.
///
/// # Errors
/// When the manifest states that the replacement of files was interrupted.
pub fn refuse_mixed(directory: &Path) -> Result<(), String> {
    match Manifest::read(directory) {
        Some(Manifest { whole: false, .. }) => Err(format!(
            "{}: expected the files of one run, found the directory of an interrupted replacement: repeat the run",
            directory.join(MANIFEST).display()
        )),
        _ => Ok(()),
    }
}
