//! Text dumps of LAMMPS and LIGGGHTS (`dump custom`, `dump atom` and `dump local`), read one snapshot at a time.

use std::io::BufRead;
use std::mem;
use std::path::Path;

use crate::read::format::{FileContent, Format};
use crate::read::lines::{Fields, Line, Lines, opened};
use crate::read::number_table::{NumberColumn, RowForm};
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot, Numbering};

pub(crate) static FORMAT: Format = Format {
    words: "a dump",
    is_it: |beginning| beginning.line.starts_with("ITEM:"),
    numbering: Numbering::Steps,
    holds: |path| Ok(FileContent::Course(first_step(path))),
    open: |path, most_rows| {
        let mut reader = DumpReader::open(path)?.at_most(most_rows);
        Ok(Box::new(move |snapshot: &mut DumpSnapshot| reader.read(snapshot)))
    },
};

/// Returns the first step, or `None` if it cannot be read. The reader of the dump then reports the error.
fn first_step(path: &Path) -> Option<u64> {
    /// Maximum number of lines up to and including the step. Units and time may precede it.
    const MOST_LINES: usize = 8;
    let mut lines = Lines::open(path).ok()?;
    let mut is_next = false;
    for _ in 0..MOST_LINES {
        let line = lines.next_text().ok()??;
        if is_next {
            return line.text.trim().parse().ok();
        }
        is_next = line.text.trim() == "ITEM: TIMESTEP";
    }
    None
}

/// Maximum number of rows in a snapshot. More rows would not fit in memory, and the limit prevents an overflow of line
/// numbers.
const MOST_ROWS: u64 = u32::MAX as u64;

/// Maximum number of numbers in a snapshot. They need half a gigabyte of memory.
const MOST_NUMBERS: usize = 1 << 26;

/// Reader of a dump, one snapshot after the other. It needs memory for the largest snapshot only.
pub struct DumpReader<'r> {
    lines: Lines<'r>,
    form: RowForm,
    units: Option<String>,
    last_step: Option<u64>,
    /// Maximum number of rows in a snapshot.
    most_rows: u64,
}

impl DumpReader<'static> {
    /// Opens the dump at `path`, plain, gzip or zstd. The name of the file does not matter.
    ///
    /// # Errors
    /// If the file cannot be opened or has an unsupported compression.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        Self::new(opened(path)?, &path.to_string_lossy())
    }
}

impl<'r> DumpReader<'r> {
    /// Opens a dump from `reader`. `name` is the name of the dump in error messages.
    ///
    /// # Errors
    /// If the beginning cannot be read or has an unsupported compression.
    pub fn new(reader: impl BufRead + 'r, name: &str) -> Result<Self, ReadError> {
        let (form, most_rows) = (RowForm::default(), u64::MAX);
        Ok(Self { lines: Lines::new(reader, name)?, form, units: None, last_step: None, most_rows })
    }

    /// Sets the maximum number of rows in a snapshot. By default the number is not limited.
    #[must_use]
    pub fn at_most(self, rows: u64) -> Self {
        Self { most_rows: rows, ..self }
    }

    /// Keeps NaN and infinity, so that the caller can report the step at which they occur. By default they are errors.
    #[must_use]
    pub fn keep_non_finite(mut self) -> Self {
        self.form.keeps_non_finite = true;
        self
    }

    /// Replaces `snapshot` by the next snapshot. Returns false at the end of the file. The digits of the columns
    /// accumulate as long as their names stay the same.
    ///
    /// # Errors
    /// If the file is truncated, is not text or has unknown content, if the step decreases, if a step is repeated with
    /// other numbers, or if the id of an atom is repeated. See [`ReadError`].
    pub fn read(&mut self, snapshot: &mut DumpSnapshot) -> Result<bool, ReadError> {
        let header = DumpHeader::read(&mut self.lines).map_err(|error| self.lines.cut_if_unended(error))?;
        let Some(DumpHeader { snapshot: mut next, step_line, units_line, rows, .. }) = header else {
            if self.last_step.is_none() {
                return Err(self.lines.error("a dump that begins with `ITEM: TIMESTEP`", "an empty file"));
            }
            return Ok(false);
        };
        if let Some(units) = next.units.take() {
            if let Some(before) = self.units.as_ref().filter(|before| **before != units) {
                let expected = format!("the units `{before}` of the earlier snapshots");
                return Err(ReadError::at(self.lines.name(), units_line, expected, quoted(&units)));
            }
            self.units = Some(units);
        }
        if let Some(last) = self.last_step.filter(|last| next.step < *last) {
            let expected = format!("a step of at least {last}, the step of the previous snapshot");
            return Err(ReadError::at(self.lines.name(), step_line, expected, next.step.to_string()));
        }
        let is_repeated = self.last_step == Some(next.step) && snapshot.step == next.step;
        let before = is_repeated.then(|| snapshot.clone());
        self.last_step = Some(next.step);
        if snapshot.columns.iter().map(|column| &column.name).eq(next.columns.iter().map(|column| &column.name)) {
            next.table.columns = mem::take(&mut snapshot.table.columns);
        }
        // Memory grows with the rows that are present, not with the declared number.
        next.table.values = mem::take(&mut snapshot.table.values);
        next.table.values.clear();
        next.units.clone_from(&self.units);
        next.first_line = self.lines.number() + 1;
        *snapshot = next;
        if rows > self.most_rows {
            let expected = format!("at most {} rows, because the scene has no more", self.most_rows);
            return Err(self.lines.error(expected, rows.to_string()));
        }
        for row in 0..rows {
            let read = self.read_row(row, rows, snapshot);
            read.map_err(|error| self.lines.cut_if_unended(error))?;
            if snapshot.table.values.len() > MOST_NUMBERS {
                let expected = format!("at most {MOST_NUMBERS} numbers in a snapshot");
                return Err(self.lines.error(expected, "more"));
            }
        }
        if let Some(column) = snapshot.column("id").filter(|_| snapshot.kind == DumpKind::Atoms) {
            snapshot.check_ids(self.lines.name(), column)?;
        }
        if let Some(before) = before {
            snapshot.check_repeated(self.lines.name(), &before)?;
        }
        Ok(true)
    }

    fn read_row(&mut self, row: u64, rows: u64, snapshot: &mut DumpSnapshot) -> Result<(), ReadError> {
        let place = || format!("row {} of {rows}", row + 1);
        let Some(line) = self.lines.next_line()? else {
            return Err(self.lines.error(place(), "the end of the file").cut());
        };
        if line.bytes.starts_with(b"ITEM:") {
            let found = quoted(line.text()?.text.trim_end());
            return Err(ReadError::at(line.file, line.number, place(), found));
        }
        self.form.read(line, &mut snapshot.table)?;
        if !line.ended {
            let expected = format!("the end of {}", place());
            let column = line.text()?.text.chars().count() + 1;
            let error = ReadError::at(line.file, line.number, expected, "the end of the file");
            return Err(error.with_column(column));
        }
        Ok(())
    }
}

/// Header of one snapshot.
#[derive(Default)]
struct DumpHeader {
    /// Snapshot without rows.
    snapshot: DumpSnapshot,
    /// Line number of the step; 0 before the step has been read.
    step_line: u64,
    /// Line number of the unit system.
    units_line: u64,
    rows: u64,
    /// Word for a row, such as `ATOMS`; empty before the number of rows has been read.
    row_word: String,
    has_bounds: bool,
}

impl DumpHeader {
    /// Reads the items of a header up to the item with the column names. Returns `None` at the end of the file.
    fn read(lines: &mut Lines<'_>) -> Result<Option<Self>, ReadError> {
        let mut header = Self::default();
        let mut any = false;
        loop {
            let Some(line) = lines.next_text()? else {
                return if any { Err(missing(lines, "the rest of the header")) } else { Ok(None) };
            };
            let text = line.text.trim_end();
            if text.is_empty() && !any {
                continue;
            }
            any = true;
            let Some(item) = text.strip_prefix("ITEM: ") else {
                return Err(not_an_item(line, text));
            };
            match item.split_whitespace().collect::<Vec<_>>()[..] {
                ["TIMESTEP"] => {
                    let what = "a step, a whole number";
                    header.snapshot.step = one(lines, what, |fields| fields.whole(what, 0..))?;
                    header.step_line = lines.number();
                }
                ["TIME"] => {
                    let time = one(lines, "the time", |fields| fields.finite("a time, a finite number"))?;
                    header.snapshot.time = Some(time);
                }
                ["UNITS"] => {
                    let line = lines.next_text()?;
                    let Some(line) = line else { return Err(missing(lines, "the name of a unit system")) };
                    let word = line.text.trim();
                    if word.is_empty() || word.contains(char::is_whitespace) {
                        return Err(line.error("the name of a unit system", quoted(word)));
                    }
                    (header.snapshot.units, header.units_line) = (Some(word.to_owned()), line.number);
                }
                ["NUMBER", "OF", word] => {
                    header.row_word = word.to_owned();
                    let what = format!("a number of rows of at most {MOST_ROWS}");
                    header.rows = one(lines, &what, |fields| fields.whole(&what, 0..=MOST_ROWS))?;
                }
                ["BOX", "BOUNDS", ref words @ ..] => {
                    let (periodic, is_tilted) = boundaries(line, words)?;
                    header.snapshot.periodic = periodic;
                    header.read_bounds(lines, is_tilted)?;
                }
                [word, ref columns @ ..] if word == header.row_word => {
                    header.finish(line, word, columns)?;
                    return Ok(Some(header));
                }
                _ => return Err(header.unknown(line, item)),
            }
        }
    }

    fn read_bounds(&mut self, lines: &mut Lines<'_>, is_tilted: bool) -> Result<(), ReadError> {
        let DumpSnapshot { bounds: (low, high), tilt, .. } = &mut self.snapshot;
        for axis in 0..3 {
            let numbers = if is_tilted { "two numbers and a tilt" } else { "two numbers" };
            let what = format!("the bounds of the box along {}, {numbers}", ["x", "y", "z"][axis]);
            [low[axis], high[axis], tilt[axis]] = one(lines, &what, |fields| {
                let tilt = |fields: &mut Fields<'_>| if is_tilted { fields.finite(&what) } else { Ok(0.0) };
                Ok([fields.finite(&what)?, fields.finite(&what)?, tilt(fields)?])
            })?;
            if low[axis] > high[axis] {
                let expected = "a lower bound that is not above the upper bound";
                return Err(lines.error(expected, format!("{:?}", low[axis])));
            }
        }
        self.has_bounds = true;
        Ok(())
    }

    /// Checks that the header is complete, and adds the columns.
    fn finish(&mut self, line: Line<'_>, word: &str, columns: &[&str]) -> Result<(), ReadError> {
        let items = [(self.step_line > 0, "TIMESTEP"), (self.has_bounds, "BOX BOUNDS")];
        if let Some((_, what)) = items.into_iter().find(|(is_there, _)| !is_there) {
            return Err(line.error(format!("`ITEM: {what}` before the columns"), "none"));
        }
        if columns.is_empty() {
            return Err(line.error(format!("names of columns after `ITEM: {word}`"), "none"));
        }
        for (place, name) in columns.iter().enumerate() {
            if columns[..place].contains(name) {
                return Err(
                    line.error("columns with different names", format!("two columns with the name {}", quoted(name)))
                );
            }
        }
        self.snapshot.kind = if word == "ATOMS" { DumpKind::Atoms } else { DumpKind::Entries };
        self.snapshot.table.columns = columns.iter().map(|name| NumberColumn::new(name)).collect();
        Ok(())
    }

    fn unknown(&self, line: Line<'_>, item: &str) -> ReadError {
        let word = &self.row_word;
        let columns = if word.is_empty() { String::new() } else { format!(" or `{word} COLUMN…`") };
        let expected = format!(
            "`ITEM: ` with `TIMESTEP`, `TIME`, `UNITS`, `NUMBER OF ATOMS`, `NUMBER OF ENTRIES`, `BOX BOUNDS …`{columns}"
        );
        line.error(expected, quoted(&format!("ITEM: {item}")))
    }
}

/// Returns the error of a line that is not an item. If the first line of a file is a single number, the error reports
/// an .xyz file.
fn not_an_item(line: Line<'_>, text: &str) -> ReadError {
    if line.number == 1 && text.trim().parse::<u64>().is_ok() {
        let expected = "a dump with ids and times, such as `dump … custom … id type x y z vx vy vz` writes";
        return line.error(expected, "an .xyz file, which has neither ids nor times");
    }
    line.error("a line `ITEM: …`", quoted(text))
}

/// Returns the periodic axes from the words after `BOX BOUNDS`, and true if the box is tilted. Without words for
/// boundaries, as in old files, no axis is periodic.
fn boundaries(line: Line<'_>, words: &[&str]) -> Result<([bool; 3], bool), ReadError> {
    let known = |word: &&str| word.len() == 2 && word.bytes().all(|byte| b"pfsm".contains(&byte));
    match *words {
        [] => Ok(([false; 3], false)),
        ["xy", "xz", "yz"] => Ok(([false; 3], true)),
        ["xy", "xz", "yz", x, y, z] if [x, y, z].iter().all(known) => Ok(([x, y, z].map(|word| word == "pp"), true)),
        [x, y, z] if [x, y, z].iter().all(known) => Ok(([x, y, z].map(|word| word == "pp"), false)),
        ["abc", "origin", ..] => {
            let found = format!("{}, a general triclinic box", quoted(&words.join(" ")));
            Err(line.error("a box with right angles, or a box with the tilts `xy xz yz`", found))
        }
        _ => Err(line.error("three boundaries such as `pp ff ff` after `BOX BOUNDS`", quoted(&words.join(" ")))),
    }
}

/// Reads the value of an item that consists of one line.
fn one<T>(
    lines: &mut Lines<'_>,
    what: &str,
    read: impl FnOnce(&mut Fields<'_>) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let Some(line) = lines.next_text()? else { return Err(missing(lines, what)) };
    let mut fields = Fields::new(line, line.text);
    let value = read(&mut fields)?;
    fields.end(what)?;
    Ok(value)
}

fn missing(lines: &Lines<'_>, what: &str) -> ReadError {
    lines.error(what, "the end of the file").cut()
}
