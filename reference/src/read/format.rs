//! File formats with snapshots of grains, and the output files of a run, read snapshot by snapshot. Each format is a file
//! in the folder `formats`.

use super::decoding::decoded;
use super::lines::{Lines, opened};
use super::read_error::{ReadError, quoted};
use super::snapshot::{DumpSnapshot, Numbering};
use super::table::{MARK, read_table};
use std::io::Read;
use std::path::{Path, PathBuf};

include!(concat!(env!("OUT_DIR"), "/formats.rs"));

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

/// Number of bytes at the beginning of a file that identify its kind.
const HEAD: u64 = 512;

/// Returns the format of a file of grains from its beginning, or `None` for a table. An empty file counts as a dump, whose
/// reader reports the error.
pub(crate) fn format_of(path: &Path) -> Result<Option<&'static Format>, ReadError> {
    let name = shown(path);
    let reading = |error| ReadError::reading(&name, 1, error);
    let (mut bytes, mut unpacked) = (Vec::new(), Vec::new());
    opened(path)?.take(HEAD).read_to_end(&mut bytes).map_err(reading)?;
    let find = |unpacked: &[u8], line: &str| {
        let beginning = Beginning { path, bytes: &bytes, unpacked, line };
        FORMATS.iter().copied().find(|format| (format.is_it)(&beginning))
    };
    // `unpacked` is empty at first, so that archives and containers are identified before decompression.
    if let Some(format) = find(&[], "") {
        return Ok(Some(format));
    }
    if bytes.starts_with(MARK) {
        return Ok(None);
    }
    if let Ok(reader) = decoded(opened(path)?).map_err(reading)? {
        reader.take(HEAD).read_to_end(&mut unpacked).map_err(reading)?;
    }
    if let Some(format) = find(&unpacked, "") {
        return Ok(Some(format));
    }
    let mut lines = Lines::open(path)?;
    let mut has_comments = false;
    while let Some(line) = lines.next_text()? {
        let text = line.text.trim();
        if text.starts_with('#') {
            has_comments = true;
        } else if text.parse::<u64>().is_ok() {
            // A number alone is the first line of an .xyz file. The reader of dumps reports that this format is not
            // supported.
            return Ok(Some(&dump::FORMAT));
        } else if !text.is_empty() {
            return Ok(find(&unpacked, line.text));
        }
    }
    Ok((!has_comments).then_some(&dump::FORMAT))
}

/// Checks that a file contains output of a run: snapshots of grains, contacts of a dump, or a table of numbers. The
/// name of the file does not matter.
///
/// # Errors
/// If the file has other content or cannot be read.
pub fn is_of_a_run(path: &Path) -> Result<(), ReadError> {
    let length = std::fs::metadata(path).map_err(|error| ReadError::opening(&shown(path), error))?.len();
    if length == 0 {
        return Err(ReadError::at(&shown(path), 1, "grains or a table of numbers", "an empty file"));
    }
    if format_of(path)?.is_none() {
        read_table(path)?;
    }
    Ok(())
}

/// Output file of a run.
#[derive(Clone, Debug)]
pub(crate) struct RunFile {
    pub(crate) path: PathBuf,
    format: &'static Format,
    /// True if the file contains one snapshot, whose step is `first_step`.
    pub(crate) is_moment: bool,
    /// First step, if it is known.
    first_step: Option<u64>,
    /// Time of a file with one snapshot (s), if a collection of files contains it.
    time: Option<f64>,
}

/// Returns files sorted by step, which is often not the order of their names. A collection is replaced by the files
/// that it lists.
pub(crate) fn in_order(named: &[PathBuf]) -> Result<Vec<RunFile>, ReadError> {
    let mut files = Vec::new();
    for path in named.iter().filter(|path| !is_box(path)) {
        // A table is opened as a dump, so that the reader of dumps reports the error.
        let format = format_of(path)?.unwrap_or(&dump::FORMAT);
        match (format.holds)(path)? {
            FileContent::Course(first_step) => {
                files.push(RunFile { path: path.clone(), format, is_moment: false, first_step, time: None });
            }
            FileContent::Moment => files.push(of_moment(path, None)?),
            FileContent::List(mut listed) => {
                listed.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut moments = Vec::new();
                for (time, path) in listed {
                    moments.push(of_moment(&path, Some(time))?);
                }
                // Names such as `grains_0.05.vtu` contain times. Such files are numbered in the order of their times.
                if !moments.is_sorted_by(|a, b| a.first_step < b.first_step) {
                    (0..).zip(&mut moments).for_each(|(number, file)| file.first_step = Some(number));
                }
                files.extend(moments);
            }
        }
    }
    files.sort_by_key(|file| file.first_step);
    Ok(files)
}

/// Returns true for a file with the simulation box, which LIGGGHTS writes for each file of grains. Patterns for files of
/// grains match its name too.
fn is_box(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().contains("boundingBox"))
}

/// Returns a file with one snapshot. The last whole number in its name is the step.
fn of_moment(path: &Path, time: Option<f64>) -> Result<RunFile, ReadError> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let last = stem.trim_end_matches(|letter: char| !letter.is_ascii_digit());
    let digits = last.len() - last.bytes().rev().take_while(u8::is_ascii_digit).count();
    let step = last[digits..].parse().map_err(|_| {
        ReadError::at(&shown(path), 1, "the step in the file's name, as in `dump_5000.vtk`", quoted(&stem))
    })?;
    let format = format_of(path)?.unwrap_or(&dump::FORMAT);
    Ok(RunFile { path: path.to_owned(), format, is_moment: true, first_step: Some(step), time })
}

/// Reader of the snapshots of a file.
pub(crate) struct Snapshots {
    file: RunFile,
    reader: SnapshotReader,
    /// True after the snapshot of a file with one snapshot has been read.
    is_read: bool,
    /// True if the complete frames of a truncated file are read.
    partial: bool,
    /// Error at the position where the file is truncated, if this is allowed.
    pub(crate) cut: Option<String>,
}

impl Snapshots {
    /// Opens a file whose snapshots must have at most `most_rows` rows. If `partial` is true, a truncated file ends after
    /// its last complete frame.
    pub(crate) fn open(file: &RunFile, most_rows: u64, partial: bool) -> Result<Self, ReadError> {
        let reader = (file.format.open)(&file.path, most_rows)?;
        Ok(Self { file: file.clone(), reader, is_read: false, partial, cut: None })
    }

    /// Replaces `snapshot` by the next snapshot. Returns false at the end of the file.
    pub(crate) fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError> {
        let is_there = match (self.reader)(snapshot) {
            Err(error) if error.is_cut() && self.partial => {
                self.cut = Some(error.to_string());
                return Ok(false);
            }
            read => read?,
        };
        let RunFile { path, format, is_moment, first_step, time } = &self.file;
        if *is_moment && is_there == self.is_read {
            let found = if is_there { "several" } else { "none" };
            return Err(ReadError::at(&shown(path), 1, "one time per file, from a list or the file name", found));
        }
        self.is_read = true;
        if is_there && *is_moment {
            snapshot.step = first_step.unwrap_or_default();
            snapshot.time = snapshot.time.or(*time);
        }
        if is_there && (*is_moment || format.numbering == Numbering::Files) {
            snapshot.numbering = format.numbering;
        }
        Ok(is_there)
    }
}

pub(crate) fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file pattern yields names in alphabetical order, so that `dump.end` is before `dump.grains`.
    #[test]
    fn dumps_are_in_the_order_of_their_steps() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["dump.end", "dump.grains", "dump.later"].map(|name| folder.path().join(name));
        for (path, head) in paths.iter().zip([
            "ITEM: UNITS\nsi\nITEM: TIMESTEP\n900\n",
            "ITEM: TIMESTEP\n0\n",
            "ITEM: TIMESTEP\n1000\n",
        ]) {
            std::fs::write(path, head).unwrap();
        }
        let found: Vec<PathBuf> = in_order(&paths).unwrap().into_iter().map(|file| file.path).collect();
        assert_eq!(found, [&paths[1], &paths[0], &paths[2]].map(PathBuf::clone));
    }
}
