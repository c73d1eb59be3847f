//! The files that a run left, snapshot by snapshot, whatever their format.

use crate::read::decoding::{Decoded, decoded};
use crate::read::format::{Beginning, FORMATS, Format, Holds, Moments, ToldBy, dump};
use crate::read::line_reader::LineReader;
use crate::read::parquet;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::{header, read_table};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// How many bytes of a file tell what it is.
const HEAD: u64 = 512;

/// What a file is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// A table.
    Table,
    /// Grains at moments, in a format.
    Grains(&'static Format),
}

impl Kind {
    /// In words.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Table => "a table",
            Self::Grains(format) => format.words,
        }
    }

    /// Whether it is a table.
    pub(crate) const fn is_table(self) -> bool {
        matches!(self, Self::Table)
    }
}

/// What a file is by its beginning; an empty one does not say, and the reader of dumps then will.
pub(crate) fn kind(path: &Path) -> Result<Kind, ReadError> {
    let name = shown(path);
    let opened = || File::open(path).map_err(|error| ReadError::opening(&name, error));
    let reading = |error| ReadError::reading(&name, 1, error);
    let (mut bytes, mut unpacked) = (Vec::new(), Vec::new());
    opened()?.take(HEAD).read_to_end(&mut bytes).map_err(reading)?;
    if bytes.starts_with(parquet::MARK) {
        return Ok(Kind::Table);
    }
    // What is not packed begins with the same bytes; archives and boxes that are known by them are not unpacked.
    let told = |unpacked: &[u8]| {
        let beginning = Beginning { path, bytes: &bytes, unpacked };
        let is_it = |format: &&&Format| matches!(format.told_by, ToldBy::Beginning(is_it) if is_it(&beginning));
        FORMATS.iter().find(is_it).map(|format| Kind::Grains(format))
    };
    if let Some(kind) = told(&[]) {
        return Ok(kind);
    }
    if let Decoded::Text(reader) = decoded(BufReader::new(opened()?)).map_err(reading)? {
        reader.take(HEAD).read_to_end(&mut unpacked).map_err(reading)?;
    }
    if let Some(kind) = told(&unpacked) {
        return Ok(kind);
    }
    let mut lines = LineReader::new(BufReader::new(opened()?), &name)?;
    let mut has_comments = false;
    while let Some(line) = lines.next_line()? {
        if !line.text.trim().is_empty() {
            let names = header(line.text).1;
            let is_it = |format: &&&Format| match format.told_by {
                ToldBy::Line(begins) => line.text.starts_with(begins),
                ToldBy::Names(is_it) => is_it(&names),
                ToldBy::Beginning(_) => false,
            };
            if line.text.trim_start().starts_with('#') {
                has_comments = true;
                continue;
            }
            // The reader of dumps says why an .xyz file, which begins with a count, is not read.
            if line.text.trim().parse::<u64>().is_ok() {
                return Ok(Kind::Grains(&dump::FORMAT));
            }
            return Ok(FORMATS.iter().find(is_it).map_or(Kind::Table, |format| Kind::Grains(format)));
        }
    }
    Ok(if has_comments { Kind::Table } else { Kind::Grains(&dump::FORMAT) })
}

/// Checks that the content of a file is that of a run: grains at moments, entries of a dump, or a table of numbers. Names do not
/// matter.
///
/// # Errors
/// The content is another one, or cannot be read that far.
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

/// A file, and which moment it is of where it holds one only.
#[derive(Clone, Debug)]
pub(crate) struct RunFile {
    pub(crate) path: PathBuf,
    format: &'static Format,
    moment: Option<Moment>,
    /// The first step of a course, where it can be read.
    begins: Option<u64>,
}

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment {
    step: u64,
    /// The time (s), where a list tells it.
    time: Option<f64>,
}

impl RunFile {
    /// Whether it holds one moment alone.
    pub(crate) const fn is_of_a_moment(&self) -> bool {
        self.moment.is_some()
    }
}

/// The files that were named: lists as what they list, and all in the order of their steps, which is seldom that of their
/// names.
pub(crate) fn in_order(named: &[PathBuf]) -> Result<Vec<RunFile>, ReadError> {
    let mut files = Vec::new();
    for path in named.iter().filter(|path| !is_box(path)) {
        // Whoever looks for grains in a table is told by the reader of dumps.
        let format = format(path)?;
        match (format.holds)(path)? {
            Holds::Course(begins) => files.push(RunFile { path: path.clone(), format, moment: None, begins }),
            Holds::Moment => files.push(of_moment(path, None)?),
            Holds::List(listed) => {
                for (time, path) in listed {
                    files.push(of_moment(&path, Some(time))?);
                }
            }
        }
    }
    files.sort_by_key(|file| file.moment.map(|moment| moment.step).or(file.begins));
    Ok(files)
}

/// The format of a file of grains.
fn format(path: &Path) -> Result<&'static Format, ReadError> {
    Ok(match kind(path)? {
        Kind::Grains(format) => format,
        Kind::Table => &dump::FORMAT,
    })
}

/// LIGGGHTS leaves the box beside each file of grains, under a name that a pattern of theirs catches too.
fn is_box(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().contains("boundingBox"))
}

/// A file whose name tells the step: its last whole number.
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

/// Snapshot after snapshot of a file.
pub(crate) struct Snapshots {
    moments: Box<dyn Moments>,
    /// The moment that the file is of and its name, where it holds one only.
    only: Option<(Moment, String)>,
    numbering: Numbering,
    read: usize,
}

impl Snapshots {
    /// Of a file, whose snapshots may have so many rows.
    pub(crate) fn open(file: &RunFile, most_rows: u64) -> Result<Self, ReadError> {
        let only = file.moment.map(|moment| (moment, shown(&file.path)));
        let numbering = file.format.numbering;
        Ok(Self { moments: (file.format.open)(&file.path, most_rows)?, only, numbering, read: 0 })
    }

    /// Reads the next snapshot in the place of the last; false at the end of the file.
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
            return Err(ReadError::at(name, 1, "one moment, as a list of files or its name tells its time", found));
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
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// Names in the order of letters are those of a pattern: `dump.end` stands in front of `dump.grains`.
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
