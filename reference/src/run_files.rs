//! The files that a run left, snapshot by snapshot, whatever their format.

use crate::read::decoding::{Decoded, decoded};
use crate::read::dump::DumpReader;
use crate::read::line_reader::LineReader;
use crate::read::npz::{self, Course};
use crate::read::parquet;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::DumpSnapshot;
use crate::read::vtk;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// How many bytes of a file tell what it is.
const HEAD: u64 = 512;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A dump of LAMMPS' kind.
    Dump,
    /// A table.
    Table,
    /// One of VTK's.
    Vtk(vtk::Kind),
    /// One of VTK's in HDF5.
    VtkHdf,
    /// Arrays of NumPy's.
    Npz,
}

/// What a file is by its beginning; an empty one does not say, and the reader of dumps then will.
pub(crate) fn kind(path: &Path) -> Result<Kind, ReadError> {
    let name = shown(path);
    let opened = || File::open(path).map_err(|error| ReadError::opening(&name, error));
    let mut mark = Vec::new();
    let marked = opened()?.take(vtk::MARK.len() as u64).read_to_end(&mut mark);
    marked.map_err(|error| ReadError::reading(&name, 1, error))?;
    if mark == vtk::MARK {
        return Ok(Kind::VtkHdf);
    }
    // Other archives are refused where their text is looked for.
    if mark.starts_with(npz::MARK) && path.extension().is_some_and(|end| end.eq_ignore_ascii_case("npz")) {
        return Ok(Kind::Npz);
    }
    if mark.starts_with(parquet::MARK) {
        return Ok(Kind::Table);
    }
    let reading = |error| ReadError::reading(&name, 1, error);
    let mut head = Vec::new();
    if let Decoded::Text(reader) = decoded(BufReader::new(opened()?)).map_err(reading)? {
        reader.take(HEAD).read_to_end(&mut head).map_err(reading)?;
    }
    if let Some(kind) = vtk::kind(&head) {
        return Ok(Kind::Vtk(kind));
    }
    let mut lines = LineReader::new(BufReader::new(opened()?), &name)?;
    while let Some(line) = lines.next_line()? {
        if !line.text.trim().is_empty() {
            return Ok(if line.text.starts_with("ITEM:") { Kind::Dump } else { Kind::Table });
        }
    }
    Ok(Kind::Dump)
}

/// A file, and which moment it is of where it holds one only.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RunFile {
    pub(crate) path: PathBuf,
    kind: Kind,
    moment: Option<Moment>,
    /// The first step of a dump, where it can be read.
    begins: Option<u64>,
}

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moment {
    step: u64,
    /// The time (s), where a collection tells it.
    time: Option<f64>,
}

impl RunFile {
    /// Whether it holds one moment alone.
    pub(crate) const fn is_of_a_moment(&self) -> bool {
        self.moment.is_some()
    }

    /// Whether its steps are those of the run: what stands in a name may be a number of files.
    pub(crate) fn tells_steps(&self) -> bool {
        self.kind == Kind::Dump
    }
}

/// The files that were named: collections as what they list, and all in the order of their steps, which is seldom that of
/// their names.
pub(crate) fn in_order(named: &[PathBuf]) -> Result<Vec<RunFile>, ReadError> {
    let mut files = Vec::new();
    for path in named.iter().filter(|path| !is_box(path)) {
        match kind(path)? {
            kind @ (Kind::Dump | Kind::Table | Kind::Npz) => {
                let begins = if kind == Kind::Dump { first_step(path) } else { None };
                files.push(RunFile { path: path.clone(), kind, moment: None, begins });
            }
            Kind::VtkHdf if vtk::has_steps(path)? => {
                files.push(RunFile { path: path.clone(), kind: Kind::VtkHdf, moment: None, begins: None });
            }
            Kind::VtkHdf | Kind::Vtk(vtk::Kind::Points) => files.push(of_moment(path, None)?),
            Kind::Vtk(vtk::Kind::Collection) => {
                for (time, path) in vtk::read_collection(path)? {
                    files.push(of_moment(&path, Some(time))?);
                }
            }
        }
    }
    files.sort_by_key(|file| file.moment.map(|moment| moment.step).or(file.begins));
    Ok(files)
}

/// The first step of a dump; none of one that is damaged, which whoever reads it is told.
fn first_step(path: &Path) -> Option<u64> {
    /// Lines of units and time may stand in front of it.
    const MOST_LINES: usize = 8;
    let mut lines = LineReader::new(BufReader::new(File::open(path).ok()?), &shown(path)).ok()?;
    let mut is_next = false;
    for _ in 0..MOST_LINES {
        let line = lines.next_line().ok()??;
        if is_next {
            return line.text.trim().parse().ok();
        }
        is_next = line.text.trim() == "ITEM: TIMESTEP";
    }
    None
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
    Ok(RunFile { path: path.to_owned(), kind: kind(path)?, moment: Some(Moment { step, time }), begins: None })
}

/// Snapshot after snapshot of a file.
pub(crate) enum Snapshots {
    Dump(Box<DumpReader<'static>>),
    /// Of a file that holds one, until it was read.
    One(Option<RunFile>),
    /// Of arrays, and the moment that comes next.
    Arrays(Box<Course>, usize),
    /// Of a file of VTK's in HDF5, and the moment that comes next.
    Moments(Box<vtk::Moments>, usize),
}

impl Snapshots {
    /// Of a file, whose snapshots may have so many rows.
    pub(crate) fn open(file: &RunFile, most_rows: u64) -> Result<Self, ReadError> {
        Ok(match file.moment {
            None if file.kind == Kind::Npz => {
                let course = npz::read_course(&file.path)?;
                check_grains(course.name(), course.grains(), most_rows)?;
                Self::Arrays(Box::new(course), 0)
            }
            None if file.kind == Kind::VtkHdf => {
                let moments = vtk::read_moments(&file.path)?;
                check_grains(moments.name(), moments.grains(), most_rows)?;
                Self::Moments(Box::new(moments), 0)
            }
            None => Self::Dump(Box::new(DumpReader::open(&file.path)?.at_most(most_rows))),
            Some(_) => Self::One(Some(file.clone())),
        })
    }

    /// Reads the next snapshot in the place of the last; false at the end of the file.
    pub(crate) fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError> {
        match self {
            Self::Dump(reader) => reader.read(snapshot),
            Self::Arrays(course, moment) => {
                let Some(next) = course.snapshot(*moment) else { return Ok(false) };
                *snapshot = next;
                *moment += 1;
                Ok(true)
            }
            Self::Moments(moments, moment) => {
                let Some(next) = moments.snapshot(*moment)? else { return Ok(false) };
                *snapshot = next;
                *moment += 1;
                Ok(true)
            }
            Self::One(file) => {
                let Some(file) = file.take() else { return Ok(false) };
                let Some(moment) = file.moment else { return Ok(false) };
                let read =
                    if file.kind == Kind::VtkHdf { only_moment(&file.path)? } else { vtk::read_points(&file.path)? };
                *snapshot = DumpSnapshot { step: moment.step, time: read.time.or(moment.time), ..read };
                Ok(true)
            }
        }
    }
}

/// The grains of a file that may hold one moment alone.
fn only_moment(path: &Path) -> Result<DumpSnapshot, ReadError> {
    let moments = vtk::read_moments(path)?;
    match (moments.count(), moments.snapshot(0)?) {
        (1, Some(snapshot)) => Ok(snapshot),
        (count, _) => {
            Err(ReadError::at(&shown(path), 1, "one moment, as a list of files tells its time", count.to_string()))
        }
    }
}

/// Refuses more grains than a scene has.
fn check_grains(name: &str, grains: usize, most_rows: u64) -> Result<(), ReadError> {
    if grains as u64 <= most_rows {
        return Ok(());
    }
    let expected = format!("at most {most_rows} grains, for no more can belong to the scene");
    Err(ReadError::at(name, 1, expected, grains.to_string()))
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
