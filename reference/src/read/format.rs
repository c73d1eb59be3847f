//! Interface of formats with snapshots of grains. To add a format, add a file in `formats`.

use super::read_error::ReadError;
use super::snapshot::{DumpSnapshot, Numbering};
use std::path::{Path, PathBuf};

/// Snapshots of an open file.
pub(crate) type OpenSnapshots = Result<Box<dyn Moments>, ReadError>;

/// File format.
#[derive(Debug)]
pub(crate) struct Format {
    /// Name of the format as text.
    pub(crate) words: &'static str,
    /// Test that identifies a file of this format.
    pub(crate) told_by: FormatCriterion,
    /// Default numbering of the snapshots, if the file contains none.
    pub(crate) numbering: Numbering,
    /// Returns the kind of content of a file.
    pub(crate) holds: fn(&Path) -> Result<FileContent, ReadError>,
    /// Opens a file with a maximum number of rows per snapshot.
    pub(crate) open: fn(&Path, u64) -> OpenSnapshots,
}

/// Criterion that identifies the format of a file.
#[derive(Debug)]
pub(crate) enum FormatCriterion {
    /// Test of the first bytes and the name.
    Beginning(fn(&Beginning<'_>) -> bool),
    /// Beginning of the first non-blank line, if no format matches the first bytes.
    Line(&'static str),
    /// Test of the column names in the first line that is neither blank nor a comment.
    Names(fn(&[&str]) -> bool),
}

/// First bytes of a file.
pub(crate) struct Beginning<'a> {
    /// Path of the file.
    pub(crate) path: &'a Path,
    /// Bytes as stored.
    pub(crate) bytes: &'a [u8],
    /// Bytes after decompression, or empty if the compression is not supported.
    pub(crate) unpacked: &'a [u8],
}

/// Content of a file.
#[derive(Debug)]
pub(crate) enum FileContent {
    /// Snapshots with steps or in a defined order, and the step of the first one if it is known.
    Course(Option<u64>),
    /// One snapshot. Its step is in the name of the file.
    Moment,
    /// Names of other files with their times (s).
    List(Vec<(f64, PathBuf)>),
}

/// Snapshots of a file, read one after the other.
pub(crate) trait Moments {
    /// Replaces `snapshot` by the next snapshot. Returns false at the end of the file.
    fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError>;
}

/// Snapshots that are read by index.
pub(crate) struct IndexedSnapshots<F> {
    file: String,
    of: F,
    next: usize,
}

impl<F: Fn(usize) -> Result<Option<DumpSnapshot>, ReadError> + 'static> IndexedSnapshots<F> {
    /// Returns the snapshots of a file. `read_at` returns the snapshot at an index, or `None` after the last one.
    pub(crate) fn boxed(path: &Path, read_at: F) -> Box<dyn Moments> {
        Box::new(Self { file: path.to_string_lossy().into_owned(), of: read_at, next: 0 })
    }
}

impl<F: Fn(usize) -> Result<Option<DumpSnapshot>, ReadError>> Moments for IndexedSnapshots<F> {
    fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError> {
        let Some(next) = (self.of)(self.next)? else { return Ok(false) };
        if self.next > 0 && snapshot.step == next.step {
            next.check_repeated(&self.file, snapshot)?;
        }
        *snapshot = next;
        self.next += 1;
        Ok(true)
    }
}

/// Returns an error if there are more grains than in the scene.
pub(crate) fn check_grains(name: &str, grains: usize, most_rows: u64) -> Result<(), ReadError> {
    if grains as u64 <= most_rows {
        return Ok(());
    }
    let expected = format!("at most {most_rows} grains, because the scene has no more");
    Err(ReadError::at(name, 1, expected, grains.to_string()))
}

include!(concat!(env!("OUT_DIR"), "/formats.rs"));
