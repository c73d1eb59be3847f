//! Sequence of frames of an output. A frame has the values of selected columns at one step, time or row.

use std::ops::Range;
use std::path::Path;
use std::vec;

use super::{Options, PrintedDigits};
use crate::names::{AXES, Names};
use crate::read::format::{RunFile, Snapshots, in_order};
use crate::read::number_table::Table;
use crate::read::read_error::ReadError;
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::read_table;

/// Position of a frame in its output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Step; `None` if the file contains no steps.
    pub(super) step: Option<u64>,
    /// Time (s); `None` if the file contains no times and it cannot be computed from step and time step.
    pub(super) time: Option<f64>,
    /// Index of the frame, from 0.
    pub(super) number: u64,
    /// Line number for error messages.
    pub(super) line: u64,
}

/// Values of one frame.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub(super) place: Place,
    /// Ids of the rows in ascending order; `None` if the file contains no ids.
    pub(super) ids: Option<Vec<f64>>,
    /// Values of each column in the order of the ids.
    pub(super) values: Vec<Vec<f64>>,
}

pub(super) struct Frames {
    pub(super) file: String,
    time_step: Option<f64>,
    names: Names,
    /// Names in the first file of the columns that the following frames contain.
    pub(super) wanted: Vec<String>,
    number: u64,
    /// Position and numbers of the last frame. For snapshots of grains the numbers are empty.
    last: Option<(Place, Vec<f64>)>,
    partial: bool,
    /// Error at the position where the file is truncated, if truncation is allowed.
    pub(super) cut: Option<String>,
    from: FrameSource,
}

enum FrameSource {
    Grains { files: vec::IntoIter<RunFile>, reader: Option<Snapshots>, snapshot: Box<DumpSnapshot> },
    Table { table: Table, step: Option<usize>, time: Option<usize>, rows: Range<usize> },
}

impl Frames {
    /// Opens a file. `which` is 0 for the first and 1 for the second of the compared files.
    pub(super) fn open(path: &Path, is_grains: bool, which: usize, options: &Options) -> Result<Self, ReadError> {
        let names = if which == 1 { options.names.clone() } else { Names::default() };
        let from = if is_grains {
            let files = in_order(&[path.to_owned()])?.into_iter();
            FrameSource::Grains { files, reader: None, snapshot: Box::default() }
        } else {
            let table = read_table(path)?;
            let time = ["time", "t"].into_iter().find_map(|name| table.column(names.in_file(name)));
            FrameSource::Table { step: table.column(names.in_file("step")), time, rows: 0..table.rows(), table }
        };
        let (file, time_step) = (path.to_string_lossy().into_owned(), options.time_steps[which]);
        let (wanted, partial) = (Vec::new(), options.partial);
        Ok(Self { file, time_step, names, wanted, number: 0, last: None, partial, cut: None, from })
    }

    /// Returns the columns of the file by their names in the first file. Coordinates come first. Ids and text columns of
    /// dumps are omitted, and steps and times of tables. The columns of a dump are known only after its first frame.
    pub(super) fn columns(&self) -> Vec<String> {
        let ours = |theirs: &str| {
            let renamed = self.names.0.iter().find(|(_, known)| known == theirs);
            renamed.map_or_else(|| theirs.to_owned(), |(ours, _)| ours.clone())
        };
        match &self.from {
            FrameSource::Grains { snapshot, .. } => {
                let coordinate = |name: &'static str| Some((name, self.names.coordinate(snapshot, name)?));
                let axes: Vec<_> = AXES.into_iter().filter_map(coordinate).collect();
                let mut names: Vec<String> = axes.iter().map(|(name, _)| (*name).to_owned()).collect();
                let others = snapshot.columns.iter().enumerate().filter(|(at, column)| {
                    !(column.is_text || column.name == "id" || axes.iter().any(|(_, axis)| axis.column == *at))
                });
                names.extend(others.map(|(_, column)| ours(&column.name)));
                names
            }
            FrameSource::Table { table, step, time, .. } => {
                let keys = [*step, *time];
                let columns = table.columns.iter().enumerate().filter(|(at, _)| !keys.contains(&Some(*at)));
                columns.map(|(_, column)| ours(&column.name)).collect()
            }
        }
    }

    /// Reads the next frame. Returns `None` at the end of the file. A frame that repeats the previous one is skipped.
    pub(super) fn next(&mut self) -> Result<Option<Frame>, ReadError> {
        loop {
            let Some((frame, numbers)) = self.frame()? else { return Ok(None) };
            let place = frame.place;
            let repeats = match &self.last {
                Some((before, of_before)) => self.is_repeated(before, of_before, &place, &numbers)?,
                None => false,
            };
            if !repeats {
                self.number += 1;
                self.last = Some((place, numbers));
                return Ok(Some(frame));
            }
        }
    }

    /// Returns true if a frame repeats the previous one.
    ///
    /// # Errors
    /// If the step or time decreases, or if it equals that of the previous frame and the numbers differ.
    fn is_repeated(&self, before: &Place, of_before: &[f64], at: &Place, numbers: &[f64]) -> Result<bool, ReadError> {
        let steps = before.step.zip(at.step);
        let times = before.time.zip(at.time);
        let same_step = steps.is_none_or(|(before, now)| before == now);
        let same_time = times.is_none_or(|(before, now)| before == now);
        let is_keyed = steps.is_some() || times.is_some();
        if is_keyed && same_step && same_time && of_before == numbers {
            return Ok(true);
        }
        let fault = |expected: String, found: String| Err(ReadError::at(&self.file, at.line, expected, found));
        match (steps, times) {
            (Some((before, now)), _) if now <= before => fault(format!("a step after {before}"), now.to_string()),
            (_, Some((before, now))) if now <= before => fault(format!("a time after {before:?}"), format!("{now:?}")),
            _ => Ok(false),
        }
    }

    /// Reads the next frame. Also returns all numbers of the row for a table, and an empty list for a dump.
    fn frame(&mut self) -> Result<Option<(Frame, Vec<f64>)>, ReadError> {
        let number = self.number;
        if let FrameSource::Table { rows, table, step, time } = &mut self.from {
            let Some(row) = rows.next() else { return Ok(None) };
            let numbers = table.row(row).to_vec();
            let value = |at: usize| numbers.get(at).copied().unwrap_or(f64::NAN);
            let step = step.map(|at| value(at) as u64);
            let time = time.map(value).or_else(|| Some(step? as f64 * self.time_step?));
            let place = Place { step, time, number, line: row as u64 + 2 };
            let column = |name: &String| table.column(self.names.in_file(name)).map_or(f64::NAN, value);
            let values = self.wanted.iter().map(|name| vec![column(name)]).collect();
            return Ok(Some((Frame { place, ids: None, values }, numbers)));
        }
        if !self.next_snapshot()? {
            return Ok(None);
        }
        let FrameSource::Grains { snapshot, .. } = &self.from else { return Ok(None) };
        let id = snapshot.column(self.names.in_file("id"));
        id.map_or(Ok(()), |id| snapshot.check_ids(&self.file, id))?;
        let order = snapshot.rows_by(id);
        let values = self.wanted.iter().map(|name| {
            if let Some(coordinate) = self.names.coordinate(snapshot, name) {
                return order.iter().map(|&row| coordinate.value(snapshot.row(row))).collect();
            }
            let at = snapshot.column(self.names.in_file(name));
            order.iter().map(|&row| at.map_or(f64::NAN, |at| snapshot.row(row)[at])).collect()
        });
        let of_step =
            || Some(snapshot.step as f64 * self.time_step.filter(|_| snapshot.numbering != Numbering::Frames)?);
        let time = snapshot.time.or_else(of_step);
        let place = Place { step: Some(snapshot.step), time, number, line: snapshot.first_line };
        let ids = id.map(|id| order.iter().map(|&row| snapshot.row(row)[id]).collect());
        // A snapshot that repeats a step has already been compared with the previous one by its reader.
        Ok(Some((Frame { place, ids, values: values.collect() }, Vec::new())))
    }

    /// Reads the next snapshot. Returns false after the last one, or where the file is truncated if truncation is
    /// allowed.
    fn next_snapshot(&mut self) -> Result<bool, ReadError> {
        let FrameSource::Grains { files, reader, snapshot } = &mut self.from else { return Ok(false) };
        loop {
            let before = reader.is_none().then(|| snapshot.clone());
            let open = match reader {
                Some(open) => open,
                None => {
                    let Some(file) = files.next() else { return Ok(false) };
                    reader.insert(Snapshots::open(&file, u64::MAX, self.partial)?)
                }
            };
            if !open.read(snapshot)? {
                self.cut = open.cut.take().or(self.cut.take());
                *reader = None;
                continue;
            }
            if let Some(before) = before
                && !before.columns.is_empty()
                && before.step == snapshot.step
            {
                snapshot.check_repeated(&self.file, &before)?;
            }
            return Ok(true);
        }
    }

    pub(super) fn units(&self) -> Option<&str> {
        match &self.from {
            FrameSource::Grains { snapshot, .. } => snapshot.units.as_deref(),
            FrameSource::Table { .. } => None,
        }
    }

    /// Returns the printed digits of a column. The result is final after all frames have been read.
    pub(super) fn printed(&self, name: &str) -> PrintedDigits {
        let (table, coordinate): (&Table, _) = match &self.from {
            FrameSource::Grains { snapshot, .. } => (snapshot, self.names.coordinate(snapshot, name)),
            FrameSource::Table { table, .. } => (table, None),
        };
        let column = coordinate.map(|at| at.column).or_else(|| table.column(self.names.in_file(name)));
        column.map_or(PrintedDigits::default(), |column| {
            let scale = coordinate.map(|at| at.parts().map(|(_, scale)| scale.abs()).sum());
            let (digits, of_file) = (table.columns[column].digits, table.digits());
            PrintedDigits { digits, of_file, scale: scale.filter(|scale| *scale != 1.0) }
        })
    }
}
