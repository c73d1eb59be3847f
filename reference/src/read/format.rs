//! Interface of file formats with snapshots of grains. Each format is a file in the folder `formats`.

use super::read_error::ReadError;
use super::snapshot::{DumpSnapshot, Numbering};
use std::path::{Path, PathBuf};

/// Reader of the snapshots of an open file, one after the other. It replaces its argument by the next snapshot and returns
/// false at the end of the file.
pub(crate) type SnapshotReader = Box<dyn FnMut(&mut DumpSnapshot) -> Result<bool, ReadError>>;

/// File format.
#[derive(Debug)]
pub(crate) struct Format {
    /// Name of the format for error messages, such as `a dump`.
    pub(crate) words: &'static str,
    /// Function that identifies a file of this format by its beginning.
    pub(crate) is_it: fn(&Beginning<'_>) -> bool,
    /// Numbering of a file with one snapshot. [`Numbering::Files`] applies to files with several snapshots too.
    pub(crate) numbering: Numbering,
    /// Function that returns the kind of content of a file.
    pub(crate) holds: fn(&Path) -> Result<FileContent, ReadError>,
    /// Function that opens a file. The second argument is the maximum number of rows in a snapshot.
    pub(crate) open: fn(&Path, u64) -> Result<SnapshotReader, ReadError>,
}

/// Beginning of a file.
pub(crate) struct Beginning<'a> {
    pub(crate) path: &'a Path,
    /// First bytes as stored.
    pub(crate) bytes: &'a [u8],
    /// First bytes after decompression; empty if the compression is not supported.
    pub(crate) unpacked: &'a [u8],
    /// First line that is neither blank nor a comment; empty as long as the first bytes may identify the format.
    pub(crate) line: &'a str,
}

/// Kind of content of a file.
#[derive(Debug)]
pub(crate) enum FileContent {
    /// Snapshots with steps or in a defined order. The first step is `None` if it is unknown.
    Course(Option<u64>),
    /// One snapshot, whose step is in the name of the file.
    Moment,
    /// Collection of other files: their times (s) and paths.
    List(Vec<(f64, PathBuf)>),
}

/// Returns a reader of snapshots that are accessed by index. `read_at` returns the snapshot with an index, or `None` after
/// the last snapshot.
pub(crate) fn indexed(
    path: &Path,
    read_at: impl Fn(usize) -> Result<Option<DumpSnapshot>, ReadError> + 'static,
) -> SnapshotReader {
    let (file, mut index) = (path.to_string_lossy().into_owned(), 0);
    Box::new(move |snapshot: &mut DumpSnapshot| {
        let Some(next) = read_at(index)? else { return Ok(false) };
        if index > 0 && snapshot.step == next.step {
            next.check_repeated(&file, snapshot)?;
        }
        *snapshot = next;
        index += 1;
        Ok(true)
    })
}

/// Checks that there are at most `most_rows` grains, the limit that follows from the scene.
pub(crate) fn check_grains(name: &str, grains: usize, most_rows: u64) -> Result<(), ReadError> {
    if grains as u64 <= most_rows {
        return Ok(());
    }
    let expected = format!("at most {most_rows} grains, because the scene has no more");
    Err(ReadError::at(name, 1, expected, grains.to_string()))
}

include!(concat!(env!("OUT_DIR"), "/formats.rs"));
