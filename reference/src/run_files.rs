//! Output files of a run, read snapshot by snapshot in any format.

use crate::read::decoding::{InputContent, decoded};
use crate::read::format::{Beginning, FORMATS, FileContent, Format, FormatCriterion, Moments, dump};
use crate::read::lines::{Lines, opened};
use crate::read::parquet;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::{header, read_table};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Number of bytes at the beginning of a file that identify its kind.
const HEAD: u64 = 512;

/// Kind of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Table,
    /// Snapshots of grains in a format.
    Grains(&'static Format),
}

impl Kind {
    /// Returns the name of the kind for error messages.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Table => "a table",
            Self::Grains(format) => format.words,
        }
    }

    pub(crate) const fn is_table(self) -> bool {
        matches!(self, Self::Table)
    }
}

/// Returns the kind of a file from its beginning. An empty file counts as a dump, whose reader reports the error.
pub(crate) fn kind(path: &Path) -> Result<Kind, ReadError> {
    let name = shown(path);
    let reading = |error| ReadError::reading(&name, 1, error);
    let (mut bytes, mut unpacked) = (Vec::new(), Vec::new());
    opened(path)?.take(HEAD).read_to_end(&mut bytes).map_err(reading)?;
    if bytes.starts_with(parquet::MARK) {
        return Ok(Kind::Table);
    }
    // `unpacked` is empty at first, so that archives and containers are identified before decompression.
    let kind_of_bytes = |unpacked: &[u8]| {
        let beginning = Beginning { path, bytes: &bytes, unpacked };
        let is_it =
            |format: &&&Format| matches!(format.told_by, FormatCriterion::Beginning(is_it) if is_it(&beginning));
        FORMATS.iter().find(is_it).map(|format| Kind::Grains(format))
    };
    if let Some(kind) = kind_of_bytes(&[]) {
        return Ok(kind);
    }
    if let InputContent::Text(reader) = decoded(opened(path)?).map_err(reading)? {
        reader.take(HEAD).read_to_end(&mut unpacked).map_err(reading)?;
    }
    if let Some(kind) = kind_of_bytes(&unpacked) {
        return Ok(kind);
    }
    let mut lines = Lines::open(path)?;
    let mut has_comments = false;
    while let Some(line) = lines.next_text()? {
        if !line.text.trim().is_empty() {
            let names = header(line.text).1;
            let is_it = |format: &&&Format| match format.told_by {
                FormatCriterion::Line(begins) => line.text.starts_with(begins),
                FormatCriterion::Names(is_it) => is_it(&names),
                FormatCriterion::Beginning(_) => false,
            };
            if line.text.trim_start().starts_with('#') {
                has_comments = true;
                continue;
            }
            // A number alone is the first line of an .xyz file. The reader of dumps reports that this format is not
            // supported.
            if line.text.trim().parse::<u64>().is_ok() {
                return Ok(Kind::Grains(&dump::FORMAT));
            }
            return Ok(FORMATS.iter().find(is_it).map_or(Kind::Table, |format| Kind::Grains(format)));
        }
    }
    Ok(if has_comments { Kind::Table } else { Kind::Grains(&dump::FORMAT) })
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
    match kind(path)? {
        Kind::Table => read_table(path).map(drop),
        Kind::Grains(_) => Ok(()),
    }
}

/// Output file of a run. `moment` is `None` if the file contains several snapshots.
#[derive(Clone, Debug)]
pub(crate) struct RunFile {
    pub(crate) path: PathBuf,
    format: &'static Format,
    moment: Option<Moment>,
    /// First step of a file with several snapshots, if it is known.
    begins: Option<u64>,
}

/// Step and time of a file with one snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment {
    step: u64,
    /// Time (s), if a collection of files contains it.
    time: Option<f64>,
}

impl RunFile {
    /// Returns true if the file contains one snapshot only.
    pub(crate) const fn is_of_a_moment(&self) -> bool {
        self.moment.is_some()
    }
}

/// Returns files sorted by step, which is often not the order of their names. A collection is replaced by the files
/// that it lists.
pub(crate) fn in_order(named: &[PathBuf]) -> Result<Vec<RunFile>, ReadError> {
    let mut files = Vec::new();
    for path in named.iter().filter(|path| !is_box(path)) {
        // A table is opened as a dump, so that the reader of dumps reports the error.
        let format = format(path)?;
        match (format.holds)(path)? {
            FileContent::Course(begins) => files.push(RunFile { path: path.clone(), format, moment: None, begins }),
            FileContent::Moment => files.push(of_moment(path, None)?),
            FileContent::List(listed) => {
                for (time, path) in listed {
                    files.push(of_moment(&path, Some(time))?);
                }
            }
        }
    }
    files.sort_by_key(|file| file.moment.map(|moment| moment.step).or(file.begins));
    Ok(files)
}

/// Returns the format of a file of grains. For a table, returns the format of dumps.
fn format(path: &Path) -> Result<&'static Format, ReadError> {
    Ok(match kind(path)? {
        Kind::Grains(format) => format,
        Kind::Table => &dump::FORMAT,
    })
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
    let step = last[digits..].parse();
    let step = step.map_err(|_| {
        ReadError::at(&shown(path), 1, "the step in the file's name, as in `dump_5000.vtk`", quoted(&stem))
    })?;
    Ok(RunFile { path: path.to_owned(), format: format(path)?, moment: Some(Moment { step, time }), begins: None })
}

/// Reader of the snapshots of a file.
pub(crate) struct Snapshots {
    moments: Box<dyn Moments>,
    /// Moment and file name if the file contains one snapshot only; otherwise `None`.
    only: Option<(Moment, String)>,
    numbering: Numbering,
    read: usize,
}

impl Snapshots {
    /// Opens a file whose snapshots must have at most `most_rows` rows.
    pub(crate) fn open(file: &RunFile, most_rows: u64) -> Result<Self, ReadError> {
        let only = file.moment.map(|moment| (moment, shown(&file.path)));
        let numbering = file.format.numbering;
        Ok(Self { moments: (file.format.open)(&file.path, most_rows)?, only, numbering, read: 0 })
    }

    /// Replaces `snapshot` by the next snapshot. Returns false at the end of the file.
    pub(crate) fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError> {
        let Some((moment, name)) = &self.only else {
            let is_there = self.moments.read(snapshot)?;
            if is_there && self.numbering == Numbering::Files {
                snapshot.numbering = Numbering::Files;
            }
            return Ok(is_there);
        };
        let mut next = DumpSnapshot::default();
        let is_there = self.moments.read(&mut next)?;
        if is_there != (self.read == 0) {
            let found = if is_there { "several" } else { "none" };
            return Err(ReadError::at(name, 1, "one time per file, from a list or the file name", found));
        }
        self.read += 1;
        if is_there {
            let numbering = self.numbering;
            *snapshot = DumpSnapshot { step: moment.step, numbering, time: next.time.or(moment.time), ..next };
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
