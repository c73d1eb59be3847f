//! What a format of files with snapshots of grains owes. A new one is a file in `formats`, where it is found.

use super::read_error::ReadError;
use super::snapshot::{DumpSnapshot, Numbering};
use std::path::{Path, PathBuf};

/// The moments of a file that was opened.
pub(crate) type Opened = Result<Box<dyn Moments>, ReadError>;

/// A format.
#[derive(Debug)]
pub(crate) struct Format {
    /// What a file of it is, in words.
    pub(crate) words: &'static str,
    /// What tells that a file is of it.
    pub(crate) told_by: ToldBy,
    /// How its snapshots are numbered, where a file does not say otherwise.
    pub(crate) numbering: Numbering,
    /// What a file of it holds.
    pub(crate) holds: fn(&Path) -> Result<Holds, ReadError>,
    /// Opens a file of it, whose snapshots may have so many rows.
    pub(crate) open: fn(&Path, u64) -> Opened,
}

/// What tells that a file is of a format.
#[derive(Debug)]
pub(crate) enum ToldBy {
    /// Its beginning and its name.
    Beginning(fn(&Beginning<'_>) -> bool),
    /// How its first line that is not blank begins, if the beginning did not tell another format.
    Line(&'static str),
    /// The names of columns in its first line that is neither blank nor a comment.
    Names(fn(&[&str]) -> bool),
}

/// The first bytes of a file.
pub(crate) struct Beginning<'a> {
    /// The file.
    pub(crate) path: &'a Path,
    /// As they are.
    pub(crate) bytes: &'a [u8],
    /// Unpacked, where it is packed in a way that is known; empty otherwise.
    pub(crate) unpacked: &'a [u8],
}

/// What a file holds.
#[derive(Debug)]
pub(crate) enum Holds {
    /// Moments that tell their steps, or their order; with the step of the first, where it is at hand.
    Course(Option<u64>),
    /// One moment, whose step the name of the file tells.
    Moment,
    /// The names of other files, with their times (s).
    List(Vec<(f64, PathBuf)>),
}

/// The moments of a file, one after the other.
pub(crate) trait Moments {
    /// Reads the next in the place of the last; false at the end of the file.
    fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError>;
}

/// Moments that are had by their place.
pub(crate) struct ByPlace<F> {
    file: String,
    of: F,
    next: usize,
}

impl<F: Fn(usize) -> Result<Option<DumpSnapshot>, ReadError> + 'static> ByPlace<F> {
    /// Of a file, by what gives the one at a place, and none after the last.
    pub(crate) fn boxed(path: &Path, of: F) -> Box<dyn Moments> {
        Box::new(Self { file: path.to_string_lossy().into_owned(), of, next: 0 })
    }
}

impl<F: Fn(usize) -> Result<Option<DumpSnapshot>, ReadError>> Moments for ByPlace<F> {
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

/// Refuses more grains than a scene has.
pub(crate) fn check_grains(name: &str, grains: usize, most_rows: u64) -> Result<(), ReadError> {
    if grains as u64 <= most_rows {
        return Ok(());
    }
    let expected = format!("at most {most_rows} grains, for no more can belong to the scene");
    Err(ReadError::at(name, 1, expected, grains.to_string()))
}

include!(concat!(env!("OUT_DIR"), "/formats.rs"));
