//! Manifest of an output directory, with the names of its files. It also states if all files are from one run, because a
//! process that ends while it replaces files leaves files of two runs.

use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::write::write_file;

/// Name of the manifest file.
pub(crate) const MANIFEST: &str = "manifest.json";

/// Our files in a directory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// True if all files are from one run.
    pub(crate) whole: bool,
    /// The files, relative to the directory.
    pub(crate) files: Vec<PathBuf>,
}

impl Manifest {
    /// Reads the manifest of a directory; none if there is none.
    pub(crate) fn read(directory: &Path) -> Option<Self> {
        serde_json::from_str(&fs::read_to_string(directory.join(MANIFEST)).ok()?).ok()
    }

    pub(crate) fn write(&self, directory: &Path) -> io::Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(io::Error::other)?;
        write_file(directory.join(MANIFEST), text + "\n").map_err(|error| error.source)
    }
}

/// Rejects a directory that contains files of two runs.
///
/// # Errors
/// When the manifest states that the files are of two runs.
pub fn refuse_mixed(directory: &Path) -> Result<(), String> {
    match Manifest::read(directory) {
        Some(Manifest { whole: false, .. }) => Err(format!(
            "{}: expected the files of one run, found the directory of an interrupted replacement: repeat the run",
            directory.join(MANIFEST).display()
        )),
        _ => Ok(()),
    }
}
