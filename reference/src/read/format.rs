//! Interface of file formats with snapshots of grains. Each format is a file in the folder `formats`.

use super::read_error::ReadError;
use super::snapshot::{DumpSnapshot, Numbering};
use std::path::{Path, PathBuf};

/// Snapshots of an open file.
pub(crate) type OpenSnapshots = Result<Box<dyn Moments>, ReadError>;

/// File format.
#[derive(Debug)]
pub(crate) struct Format {
    /// Name of the format for error messages, such as `a dump`.
    pub(crate) words: &'static str,
    /// Criterion that identifies a file of this format.
    pub(crate) told_by: FormatCriterion,
    /// Numbering of a file with one snapshot. [`Numbering::Files`] applies to files with several snapshots too.
    pub(crate) numbering: Numbering,
    /// Function that returns the kind of content of a file.
    pub(crate) holds: fn(&Path) -> Result<FileContent, ReadError>,
    /// Function that opens a file. The second argument is the maximum number of rows in a snapshot.
    pub(crate) open: fn(&Path, u64) -> OpenSnapshots,
}

/// Criterion that identifies the format of a file.
#[derive(Debug)]
pub(crate) enum FormatCriterion {
    /// Test of the first bytes and the name.
    Beginning(fn(&Beginning<'_>) -> bool),
    /// Text at the beginning of the first line that is neither blank nor a comment. It is tested if no format matches
    /// the first bytes.
    Line(&'static str),
    /// Test of the column names in the first line that is neither blank nor a comment. It is applied if no format
    /// matches the first bytes.
    Names(fn(&[&str]) -> bool),
}

/// First bytes of a file.
pub(crate) struct Beginning<'a> {
    /// Path of the file.
    pub(crate) path: &'a Path,
    /// Bytes as stored.
    pub(crate) bytes: &'a [u8],
    /// Bytes after decompression; empty if the compression is not supported.
    pub(crate) unpacked: &'a [u8],
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

/// Reader of the snapshots of a file, one after the other.
pub(crate) trait Moments {
    /// Replaces `snapshot` by the next snapshot. Returns false at the end of the file.
    fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError>;
}

/// Reader of snapshots that are accessed by index.
pub(crate) struct IndexedSnapshots<F> {
    file: String,
    of: F,
    next: usize,
}

impl<F: Fn(usize) -> Result<Option<DumpSnapshot>, ReadError> + 'static> IndexedSnapshots<F> {
    /// Returns a reader for a file. `read_at` returns the snapshot with an index, or `None` after the last snapshot.
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

/// Checks that there are at most `most_rows` grains, the limit that follows from the scene.
pub(crate) fn check_grains(name: &str, grains: usize, most_rows: u64) -> Result<(), ReadError> {
    if grains as u64 <= most_rows {
        return Ok(());
    }
    let expected = format!("at most {most_rows} grains, because the scene has no more");
    Err(ReadError::at(name, 1, expected, grains.to_string()))
}

include!(concat!(env!("OUT_DIR"), "/formats.rs"));
