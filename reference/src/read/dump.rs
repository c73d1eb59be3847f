//! Text dumps of LAMMPS and LIGGGHTS (`dump custom`, `dump atom` and `dump local`), read one snapshot at a time.

use std::io::BufRead;
use std::mem;
use std::path::Path;

use crate::read::dump_header::DumpHeader;
use crate::read::lines::{Lines, opened};
use crate::read::numbers::{NonFiniteNumbers, RowForm};
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot};

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
        let form = RowForm { separator: None, not_finite: NonFiniteNumbers::default() };
        let most_rows = u64::MAX;
        Ok(Self { lines: Lines::new(reader, name)?, form, units: None, last_step: None, most_rows })
    }

    /// Sets the maximum number of rows in a snapshot. By default the number is not limited.
    #[must_use]
    pub fn at_most(self, rows: u64) -> Self {
        Self { most_rows: rows, ..self }
    }

    /// Sets the treatment of NaN and infinity. By default they are errors.
    #[must_use]
    pub fn not_finite(mut self, not_finite: NonFiniteNumbers) -> Self {
        self.form.not_finite = not_finite;
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

/// Maximum number of numbers in a snapshot. They need half a gigabyte of memory.
const MOST_NUMBERS: usize = 1 << 26;
