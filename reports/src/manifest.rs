//! What stands in an output directory: the files of one run, or of two where a process was ended while it put them in
//! place.

use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::write::write_file;

/// Its name.
pub(crate) const MANIFEST: &str = "manifest.json";

/// The files of ours in a directory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// Whether all of them are of one run.
    pub(crate) whole: bool,
    /// The files, relative to the directory.
    pub(crate) files: Vec<PathBuf>,
}

impl Manifest {
    /// That of a directory; none where there is none of ours.
    pub(crate) fn read(directory: &Path) -> Option<Self> {
        serde_json::from_str(&fs::read_to_string(directory.join(MANIFEST)).ok()?).ok()
    }

    pub(crate) fn write(&self, directory: &Path) -> io::Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(io::Error::other)?;
        write_file(directory.join(MANIFEST), text + "\n").map_err(|error| error.source)
    }
}

/// Refuses a directory whose files are of two runs.
///
/// # Errors
/// When its manifest says so.
pub fn refuse_mixed(directory: &Path) -> Result<(), String> {
    match Manifest::read(directory) {
        Some(Manifest { whole: false, .. }) => Err(format!(
            "{}: expected the files of one run, found a directory that a process was ended in while it replaced them: run \
             it again",
            directory.join(MANIFEST).display()
        )),
        _ => Ok(()),
    }
}
