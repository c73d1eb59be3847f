//! Comparison of two outputs column by column.
//!
//! Samples are matched by step or row number. If the steps differ, samples are matched by time, and the second output
//! is interpolated between its samples.

use std::ops::Range;
use std::path::Path;
use std::vec;

use crate::names::{AXES, Names};
use crate::read::digits::Digits;
use crate::read::format::{RunFile, Snapshots, format_of, in_order};
use crate::read::number_table::Table;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::read_table;

/// Options of a comparison.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Columns to compare, by their names in the first file. An empty list selects all common columns.
    pub columns: Vec<String>,
    /// Names of columns in the second file that differ from those in the first file.
    pub names: Names,
    /// Time steps of both outputs (s); required if a file contains steps but no times.
    pub time_steps: [Option<f64>; 2],
    /// True to read the complete frames of a truncated file.
    pub partial: bool,
}

/// Quantity by which samples of two outputs are matched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// Samples are paired by step number.
    Step,
    /// Samples are compared at the times of the first output. The second output is interpolated if necessary.
    Time,
    /// Samples are paired by row number.
    Row,
}

impl Key {
    /// Returns the name of the quantity.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Time => "time",
            Self::Row => "row",
        }
    }

    fn value(self, place: &Place) -> f64 {
        match self {
            Self::Step => place.step.map_or(f64::NAN, |step| step as f64),
            Self::Time => place.time.unwrap_or(f64::NAN),
            Self::Row => place.number as f64,
        }
    }
}

/// Result of a comparison of two outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Difference of each column.
    pub differences: Vec<Difference>,
    /// Columns that only one of the outputs has.
    pub lonely: [Vec<String>; 2],
    /// For each output, the error at the position where it is truncated, if [`Options::partial`] is set.
    pub cuts: [Option<String>; 2],
    /// Quantity by which samples were matched.
    pub key: Key,
    /// Number of samples of the first output that were compared.
    pub compared: u64,
    /// Number of compared samples for which the second output was interpolated.
    pub interpolated: u64,
    /// Number of samples in each output.
    pub samples: [u64; 2],
    /// Step, time (s) or row of the last sample in each output.
    pub last: [f64; 2],
    /// Step, time (s) or row of the last sample that was compared.
    pub last_compared: f64,
    /// Mean interval between samples in the output with the longer mean interval, in the unit of the key.
    pub interval: f64,
}

/// Difference of one column between two outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Name of the column.
    pub name: String,
    /// Value of the first output at the largest difference. The largest difference is found after subtraction of the
    /// uncertainty of printed digits.
    pub first: f64,
    /// Value of the second output at the largest difference.
    pub second: f64,
    /// Reference magnitude of the column in the first output. For a coordinate that changes, it is the largest change
    /// since the first sample. Otherwise it is the largest magnitude of the column.
    ///
    /// If this magnitude is zero, the second output is used; if both are zero, the scale is 1.
    pub scale: f64,
    /// Uncertainty of the largest difference. It contains half a unit of the last printed digit in each output, and the
    /// interpolation error of the second output.
    pub open: f64,
    /// Difference at each sample.
    pub course: Vec<Sample>,
}

/// Difference of a column at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Step, time (s) or row number of the sample.
    pub at: f64,
    /// Largest absolute difference of all rows of the sample.
    pub off: f64,
    /// Largest absolute difference after subtraction of the uncertainty of printed digits.
    pub beyond_digits: f64,
}

/// Printed digits of a column in a file.
#[derive(Debug, Clone, Copy, Default)]
struct PrintedDigits {
    digits: Digits,
    of_file: Digits,
    /// Box length by which a scaled coordinate is multiplied; `None` for other columns.
    scale: Option<f64>,
}

impl PrintedDigits {
    /// Returns half a unit of the last printed digit of `value`, in the unit of the column.
    fn half_unit(&self, value: f64) -> f64 {
        match self.scale {
            Some(scale) => scale * self.digits.half_unit(1.0, &self.of_file),
            None => self.digits.half_unit(value, &self.of_file),
        }
    }
}

/// Column whose difference is accumulated.
struct Column {
    difference: Difference,
    printed: [PrintedDigits; 2],
    is_coordinate: bool,
    starts: [Vec<f64>; 2],
    /// Largest magnitude of the column in each output.
    magnitudes: [f64; 2],
    changes: [f64; 2],
    worst: f64,
}

impl Column {
    fn new(name: &str, printed: [PrintedDigits; 2]) -> Self {
        let (first, second, name) = (f64::NAN, f64::NAN, name.to_owned());
        let is_coordinate = AXES.contains(&name.as_str());
        let difference = Difference { name, first, second, scale: 0.0, open: 0.0, course: Vec::new() };
        let (magnitudes, changes, worst) = ([0.0; 2], [0.0; 2], f64::NEG_INFINITY);
        Self { difference, printed, is_coordinate, starts: Default::default(), magnitudes, changes, worst }
    }

    /// Adds the values of all rows of both outputs at one step, time (s) or row number.
    fn take(&mut self, at: f64, values: [&[f64]; 2]) {
        for (which, values) in values.into_iter().enumerate() {
            if self.starts[which].is_empty() {
                self.starts[which] = values.to_vec();
            }
            for (value, start) in values.iter().zip(&self.starts[which]) {
                self.magnitudes[which] = self.magnitudes[which].max(value.abs());
                self.changes[which] = self.changes[which].max((value - start).abs());
            }
        }
        let mut sample = Sample { at, off: 0.0, beyond_digits: 0.0 };
        for (a, b) in values[0].iter().zip(values[1]) {
            let open = self.printed[0].half_unit(*a) + self.printed[1].half_unit(*b);
            let off = (b - a).abs();
            let off = if off.is_nan() { f64::INFINITY } else { off };
            sample.off = sample.off.max(off);
            sample.beyond_digits = sample.beyond_digits.max(off - open);
            if off - open > self.worst {
                self.worst = off - open;
                (self.difference.first, self.difference.second, self.difference.open) = (*a, *b, open);
            }
        }
        self.difference.course.push(sample);
    }

    /// Returns the difference. The interpolation error `interpolated` is added to the uncertainty of the difference.
    fn finish(mut self, interpolated: f64) -> Difference {
        let column_extent = |which: usize| {
            let change = self.changes[which];
            if self.is_coordinate && change > 0.0 { change } else { self.magnitudes[which] }
        };
        let extents = [column_extent(0), column_extent(1)];
        let extent = extents.into_iter().find(|extent| *extent > 0.0);
        self.difference.scale = extent.unwrap_or(1.0);
        // If all printed numbers and formats are equal, the uncertainty is zero even if few digits are printed.
        let [a, b] = self.printed;
        let is_alike = a.digits == b.digits && a.scale == b.scale && interpolated == 0.0;
        let is_equal = extent.is_none() || is_alike && self.difference.course.iter().all(|sample| sample.off == 0.0);
        self.difference.open = if is_equal { 0.0 } else { self.difference.open + interpolated };
        self.difference
    }
}

/// Relative difference below which two times are equal.
const ONE_TIME: f64 = 1e-6;

/// Compares two dumps or two tables.
///
/// # Errors
/// If a file cannot be read, the files are of different kinds, they have no common column or sample, or the numbers of
/// rows at a step differ.
pub fn compare(first: &Path, second: &Path, options: &Options) -> Result<Comparison, ReadError> {
    let name = second.to_string_lossy().into_owned();
    let formats = [format_of(first)?, format_of(second)?];
    let is_grains = formats[0].is_some();
    if formats[1].is_some() != is_grains {
        let [first, second] = formats.map(|format| format.map_or("a table", |format| format.words));
        return Err(ReadError::at(&name, 1, format!("{first}, like the other file"), second));
    }
    let open = |which: usize| Frames::open([first, second][which], is_grains, which, options);
    let Survey { mut columns, lonely, places, cuts } = survey([open(0)?, open(1)?], options)?;
    let key = key(&places).ok_or_else(|| {
        let expected = format!("{} rows, as in the other file, or a column `step` or `time`", places[0].len());
        ReadError::at(&name, 1, expected, places[1].len().to_string())
    })?;
    let mut files = [open(0)?, open(1)?];
    let wanted: Vec<String> = columns.iter().map(|column| column.difference.name.clone()).collect();
    files.iter_mut().for_each(|frames| frames.wanted.clone_from(&wanted));
    let ends = [0, 1].map(|which: usize| {
        [places[which].first(), places[which].last()].map(|place| place.map_or(f64::NAN, |place| key.value(place)))
    });
    let interval = |which: usize| (ends[which][1] - ends[which][0]) / (places[which].len().max(2) - 1) as f64;
    let mut found = Comparison {
        differences: Vec::new(),
        lonely,
        cuts,
        key,
        compared: 0,
        interpolated: 0,
        samples: [places[0].len() as u64, places[1].len() as u64],
        last: ends.map(|[_, last]| last),
        last_compared: f64::NAN,
        interval: interval(0).max(interval(1)),
    };
    let bends = walk(&mut files, &mut columns, &mut found)?;
    if found.compared == 0 {
        return Err(ReadError::at(&name, 1, format!("a {} that the other file also has", key.word()), "none"));
    }
    // The error of linear interpolation between two samples is 1/8 of the second difference.
    let error = |bend: f64| if found.interpolated > 0 { bend / 8.0 } else { 0.0 };
    found.differences = columns.into_iter().zip(bends).map(|(column, bend)| column.finish(error(bend))).collect();
    Ok(found)
}

/// Position of a frame in its output.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    /// Step; `None` if the file contains no steps.
    step: Option<u64>,
    /// Time (s); `None` if the file contains no times and it cannot be computed from step and time step.
    time: Option<f64>,
    /// Index of the frame, from 0.
    number: u64,
    /// Line number for error messages.
    line: u64,
}

/// Values of one frame.
#[derive(Debug, Clone)]
struct Frame {
    place: Place,
    /// Ids of the rows in ascending order; `None` if the file contains no ids.
    ids: Option<Vec<f64>>,
    /// Values of each column in the order of the ids.
    values: Vec<Vec<f64>>,
}

/// Sequence of frames of an output. A frame has the values of selected columns at one step, time or row.
struct Frames {
    file: String,
    time_step: Option<f64>,
    names: Names,
    /// Names in the first file of the columns that the following frames contain.
    wanted: Vec<String>,
    number: u64,
    /// Position and numbers of the last frame. For snapshots of grains the numbers are empty.
    last: Option<(Place, Vec<f64>)>,
    partial: bool,
    /// Error at the position where the file is truncated, if truncation is allowed.
    cut: Option<String>,
    from: FrameSource,
}

enum FrameSource {
    Grains { files: vec::IntoIter<RunFile>, reader: Option<Snapshots>, snapshot: Box<DumpSnapshot> },
    Table { table: Table, step: Option<usize>, time: Option<usize>, rows: Range<usize> },
}

impl Frames {
    /// Opens a file. `which` is 0 for the first and 1 for the second of the compared files.
    fn open(path: &Path, is_grains: bool, which: usize, options: &Options) -> Result<Self, ReadError> {
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
    fn columns(&self) -> Vec<String> {
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

    /// Returns true if the file, or its last frame, has a column with this name.
    fn has(&self, name: &str) -> bool {
        match &self.from {
            FrameSource::Grains { snapshot, .. } => snapshot.column(name).is_some(),
            FrameSource::Table { table, .. } => table.column(name).is_some(),
        }
    }

    /// Reads the next frame. Returns `None` at the end of the file. A frame that repeats the previous one is skipped.
    fn next(&mut self) -> Result<Option<Frame>, ReadError> {
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

    /// Reads the next frame. Also returns all numbers of the row for a table, and an empty list for a dump. A truncated
    /// file ends after its last complete frame if truncation is allowed.
    fn frame(&mut self) -> Result<Option<(Frame, Vec<f64>)>, ReadError> {
        let number = self.number;
        let snapshot = match &mut self.from {
            FrameSource::Table { rows, table, step, time } => {
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
            FrameSource::Grains { files, reader, snapshot } => loop {
                let before = reader.is_none().then(|| snapshot.clone());
                let open = match reader {
                    Some(open) => open,
                    None => {
                        let Some(file) = files.next() else { return Ok(None) };
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
                break &**snapshot;
            },
        };
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

    fn units(&self) -> Option<&str> {
        match &self.from {
            FrameSource::Grains { snapshot, .. } => snapshot.units.as_deref(),
            FrameSource::Table { .. } => None,
        }
    }

    /// Returns the printed digits of a column. The result is final after all frames have been read.
    fn printed(&self, name: &str) -> PrintedDigits {
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

struct Survey {
    columns: Vec<Column>,
    /// Columns that only one of the files has.
    lonely: [Vec<String>; 2],
    /// Positions of the samples in each file.
    places: [Vec<Place>; 2],
    cuts: [Option<String>; 2],
}

/// Reads both files to the end and returns their common columns and samples.
fn survey(mut files: [Frames; 2], options: &Options) -> Result<Survey, ReadError> {
    let mut places: [Vec<Place>; 2] = Default::default();
    for (frames, places) in files.iter_mut().zip(&mut places) {
        while let Some(frame) = frames.next()? {
            places.push(frame.place);
        }
    }
    if let (Some(one), Some(other)) = (files[0].units(), files[1].units())
        && one != other
    {
        let expected = format!("the units {} of the other file", quoted(one));
        return Err(ReadError::at(&files[1].file, 1, expected, quoted(other)));
    }
    let [a, b] = [files[0].columns(), files[1].columns()];
    let missing = |which: usize, expected: String| {
        let line = places[which].first().map_or(1, |place| place.line.saturating_sub(1));
        ReadError::at(&files[which].file, line, expected, quoted(&[&a, &b][which].join(" ")))
    };
    for (asked, has) in options.columns.iter().flat_map(|name| [(name, 0), (name, 1)]) {
        if ![&a, &b][has].contains(asked) {
            return Err(missing(has, format!("the column {}", quoted(asked))));
        }
    }
    for (ours, theirs) in &options.names.0 {
        if !a.contains(ours) && !["time", "step"].contains(&ours.as_str()) && !files[0].has(ours) {
            return Err(missing(0, format!("the column {} of --map", quoted(ours))));
        }
        if !files[1].has(theirs) {
            return Err(missing(1, format!("the column {} of --map", quoted(theirs))));
        }
    }
    let is_asked = |name: &String| options.columns.is_empty() || options.columns.contains(name);
    let columns: Vec<Column> = a
        .iter()
        .filter(|name| b.contains(name) && is_asked(name))
        .map(|name| Column::new(name, [files[0].printed(name), files[1].printed(name)]))
        .collect();
    if columns.is_empty() {
        return Err(missing(1, format!("one of the columns {}", quoted(&a.join(" ")))));
    }
    let alone = |own_columns: &[String], other: &[String]| -> Vec<String> {
        own_columns.iter().filter(|name| is_asked(name) && !other.contains(name)).cloned().collect()
    };
    let (lonely, cuts) = ([alone(&a, &b), alone(&b, &a)], files.map(|file| file.cut));
    Ok(Survey { columns, lonely, places, cuts })
}

/// Returns the quantity by which samples are matched.
///
/// The key is the step if all steps of the file with fewer samples occur in the other file at the same times. Otherwise
/// it is the time if both files contain times, and the step if they contain only steps. Files without steps and times
/// are matched by row number if they have equally many rows.
fn key([a, b]: &[Vec<Place>; 2]) -> Option<Key> {
    let tell_times = a.iter().chain(b).all(|place| place.time.is_some());
    let tell_steps = a.iter().chain(b).all(|place| place.step.is_some());
    let fewest = a.len().min(b.len());
    let (mut shared, mut at_one_time, mut at) = (0, true, 0);
    for place in a {
        while b.get(at).is_some_and(|other| other.step < place.step) {
            at += 1;
        }
        if let Some(other) = b.get(at).filter(|other| other.step == place.step) {
            shared += 1;
            at_one_time &= place.time.zip(other.time).is_none_or(|(one, two)| is_one(one, two));
        }
    }
    if tell_steps && ((shared == fewest && at_one_time) || !tell_times) {
        Some(Key::Step)
    } else if tell_times {
        Some(Key::Time)
    } else {
        (a.len() == b.len()).then_some(Key::Row)
    }
}

fn is_one(one: f64, two: f64) -> bool {
    (one - two).abs() <= ONE_TIME * one.abs().max(two.abs())
}

/// Passes through both outputs at once. Adds the samples to `columns` and counts them in `found`. Returns the largest second
/// difference of each column in the second output.
fn walk(
    [first, second]: &mut [Frames; 2],
    columns: &mut [Column],
    found: &mut Comparison,
) -> Result<Vec<f64>, ReadError> {
    let key = found.key;
    let mut bends = vec![0.0; columns.len()];
    let mut recent: Vec<Frame> = Vec::new();
    let mut ahead = second.next()?;
    while let Some(frame) = first.next()? {
        let at = key.value(&frame.place);
        let is_there = |other: f64| if key == Key::Time { is_one(other, at) } else { other == at };
        // Frames of the second output before this time are kept, because later samples may lie between them and the
        // next frame.
        while let Some(next) = ahead.take() {
            let other = key.value(&next.place);
            if other >= at || is_there(other) {
                ahead = Some(next);
                break;
            }
            bend(&mut bends, &mut recent, next);
            ahead = second.next()?;
        }
        let mut take = |others: &[Vec<f64>]| {
            for ((column, values), others) in columns.iter_mut().zip(&frame.values).zip(others) {
                column.take(at, [values, others]);
            }
            found.compared += 1;
            found.last_compared = at;
        };
        match (recent.last(), &ahead) {
            (_, Some(next)) if is_there(key.value(&next.place)) => {
                matched(&frame, next, &second.file, key)?;
                take(&next.values);
            }
            (Some(before), Some(next)) if key == Key::Time => {
                matched(&frame, next, &second.file, key)?;
                matched(&frame, before, &second.file, key)?;
                let [low, high] = [before, next].map(|sample| key.value(&sample.place));
                take(&between(before, next, (at - low) / (high - low)));
                found.interpolated += 1;
            }
            _ => {}
        }
    }
    while let Some(next) = ahead {
        bend(&mut bends, &mut recent, next);
        ahead = second.next()?;
    }
    Ok(bends)
}

/// Stores a frame of the second output and updates the largest second differences of the columns. Two frames are stored.
fn bend(bends: &mut [f64], recent: &mut Vec<Frame>, next: Frame) {
    if let [first, second] = &recent[..] {
        for (at, bend) in bends.iter_mut().enumerate() {
            let rows = first.values[at].iter().zip(&second.values[at]).zip(&next.values[at]);
            let largest = rows.map(|((a, b), c)| (a - 2.0 * b + c).abs()).fold(0.0, f64::max);
            *bend = bend.max(largest);
        }
        recent.remove(0);
    }
    recent.push(next);
}

/// Interpolates linearly between two frames. `share` is 0 at the first and 1 at the second frame.
fn between(before: &Frame, next: &Frame, share: f64) -> Vec<Vec<f64>> {
    let column = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
    before.values.iter().zip(&next.values).map(column).collect()
}

/// Checks that two frames have equally many rows and, if both have ids, the same ids.
fn matched(frame: &Frame, other: &Frame, file: &str, key: Key) -> Result<(), ReadError> {
    let rows = |frame: &Frame| frame.values.first().map_or(0, Vec::len);
    let (word, at) = (key.word(), key.value(&frame.place));
    if rows(frame) != rows(other) {
        let expected = format!("{} rows at {word} {at}, as in the other file", rows(frame));
        return Err(ReadError::at(file, other.place.line, expected, rows(other).to_string()));
    }
    if let (Some(a), Some(b)) = (&frame.ids, &other.ids)
        && let Some((expected, found)) = a.iter().zip(b).find(|(a, b)| a != b)
    {
        let expected = format!("the id {expected} at {word} {at}, as in the other file");
        return Err(ReadError::at(file, other.place.line, expected, found.to_string()));
    }
    Ok(())
}
