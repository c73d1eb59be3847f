//! Points with their data from VTK files. Legacy files (`.vtk`) and XML files (`.vtp`, `.vtu`) may be text or binary.
//! HDF5 files have the ending `.vtkhdf`.
//!
//! Source: "VTK File Formats" of the VTK documentation, up to version 5.1 of the legacy format and version 2.2 of the
//! XML format.

mod legacy;
mod xml;

use super::decoding::decoded;
use super::digits::Digits;
use super::lines::opened;
use super::number_table::{NumberColumn, Table};
use super::read_error::{ReadError, quoted};
use super::snapshot::DumpSnapshot;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

/// Maximum size of a file after decompression (B).
const MOST: u64 = 1 << 30;

/// First bytes of a legacy file.
const LEGACY: &[u8] = b"# vtk DataFile";

/// Returns true if the first bytes belong to a collection of VTK files with their times, false for a VTK file with points
/// at one moment, or `None` for another file.
pub(crate) fn is_collection(head: &[u8]) -> Option<bool> {
    if head.starts_with(LEGACY) {
        return Some(false);
    }
    let text = String::from_utf8_lossy(head);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let is_xml = text.starts_with("<?xml") || text.starts_with("<VTKFile");
    if !is_xml || !text.contains("<VTKFile") {
        return None;
    }
    Some(text.contains("type=\"Collection\"") || text.contains("type='Collection'"))
}

/// Reads the points of a file as a snapshot of grains. The file may be plain, gzip or zstd.
///
/// Arrays with one number per point keep their names. Vectors become columns `NAME_x`, `NAME_y` and `NAME_z`.
/// Velocities and spins with known names become columns such as `vx` and `omegax`.
///
/// # Errors
/// If the file cannot be read, is truncated or is not a VTK file with points.
pub(crate) fn read_points(path: &Path) -> Result<DumpSnapshot, ReadError> {
    parse(&path.to_string_lossy(), &whole(path)?)
}

fn parse(name: &str, bytes: &[u8]) -> Result<DumpSnapshot, ReadError> {
    let bytes = Bytes::new(name, bytes);
    let points = if bytes.all().starts_with(LEGACY) { legacy::read(bytes)? } else { xml::read(bytes)? };
    Ok(points.snapshot(0)?.unwrap_or_default())
}

/// Reads all bytes of a file and decompresses them.
pub(crate) fn whole(path: &Path) -> Result<Vec<u8>, ReadError> {
    let name = path.to_string_lossy();
    let reader = decoded(opened(path)?).map_err(|error| ReadError::reading(&name, 1, error))?;
    let reader = reader.map_err(|found| ReadError::at(&name, 1, "a plain file, gzip or zstd", found))?;
    let mut bytes = Vec::new();
    reader.take(MOST + 1).read_to_end(&mut bytes).map_err(|error| ReadError::reading(&name, 1, error))?;
    if bytes.len() as u64 > MOST {
        return Err(ReadError::at(&name, 1, format!("at most {MOST} bytes"), "more"));
    }
    Ok(bytes)
}

/// Array with the components of all points, point by point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub(crate) name: String,
    pub(crate) components: usize,
    pub(crate) numbers: Vec<f64>,
    pub(crate) digits: Digits,
}

/// Names of velocities in different programs, in lower case.
const VELOCITY: [&str; 7] =
    ["v", "velocity", "vel", "velocity_lin", "linvelocity", "linear_velocity", "linear velocity"];
/// Names of angular velocities in different programs, in lower case.
const SPIN: [&str; 8] =
    ["omega", "spin", "angvel", "velocity_ang", "angvelocity", "angular_velocity", "angular velocity", "w"];
/// Names of grain ids in different programs, in lower case.
const ID: [&str; 4] = ["id", "particle_id", "particleid", "particle id"];

const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns true if a name is a known name of grain ids.
pub(crate) fn is_id(name: &str) -> bool {
    ID.contains(&name.to_lowercase().as_str())
}

/// Returns the name that a component of a vector has in a dump.
pub(crate) fn component(vector: &str, axis: usize) -> String {
    let lower = vector.to_lowercase();
    let is = |names: &[&str]| names.contains(&lower.as_str());
    let axis = AXES.get(axis).copied().unwrap_or_default();
    if is(&VELOCITY) {
        format!("v{axis}")
    } else if is(&SPIN) {
        format!("omega{axis}")
    } else {
        format!("{vector}_{axis}")
    }
}

impl Array {
    /// Returns the names of the columns that the array becomes.
    fn columns(&self) -> Vec<String> {
        match self.components {
            1 if is_id(&self.name) => vec!["id".to_owned()],
            1 => vec![self.name.clone()],
            3 => (0..3).map(|axis| component(&self.name, axis)).collect(),
            other => (0..other).map(|at| format!("{}_{at}", self.name)).collect(),
        }
    }
}

/// Points with their data at one or several moments, which may share arrays.
#[derive(Debug)]
pub(crate) struct Points {
    /// Name of the file for error messages.
    pub(crate) name: String,
    pub(crate) positions: Array,
    pub(crate) arrays: Vec<Array>,
    pub(crate) moments: Vec<Moment>,
}

/// Time of a moment, number of its points, and their first row in the positions and in each array.
#[derive(Debug)]
pub(crate) struct Moment {
    pub(crate) time: Option<f64>,
    pub(crate) points: usize,
    /// First rows; `None` if the arrays have only the rows of this moment.
    pub(crate) first: Option<(usize, Vec<usize>)>,
}

impl Points {
    /// Returns points at one moment, to which all rows of the arrays belong.
    fn of_moment(name: &str, time: Option<f64>, positions: Array, arrays: Vec<Array>) -> Self {
        let moment = Moment { time, points: positions.numbers.len() / 3, first: None };
        Self { name: name.to_owned(), positions, arrays, moments: vec![moment] }
    }

    /// Returns the largest number of grains at any moment.
    pub(crate) fn grains(&self) -> usize {
        self.moments.iter().map(|moment| moment.points).max().unwrap_or(0)
    }

    /// Returns the grains at a moment, whose index is used as the step. Returns `None` after the last moment.
    ///
    /// # Errors
    /// If the length of an array does not match the number of points, or if a number is not finite.
    pub(crate) fn snapshot(&self, at: usize) -> Result<Option<DumpSnapshot>, ReadError> {
        let Some(Moment { time, points, first }) = self.moments.get(at) else { return Ok(None) };
        let rows = |array: &Array, first: Option<usize>| match first {
            None => Ok(0..array.numbers.len()),
            Some(first) => self.rows(array, first, *points),
        };
        let first_of = |place: usize| first.as_ref().map(|(_, first)| first[place]);
        let others = self.arrays.iter().enumerate();
        let others = others.map(|(place, array)| Ok((array, rows(array, first_of(place))?, array.columns())));
        let others: Vec<_> = others.collect::<Result<_, ReadError>>()?;
        let of_positions = rows(&self.positions, first.as_ref().map(|(first, _)| *first))?;
        let positions = (&self.positions, of_positions, AXES.map(str::to_owned).to_vec());
        let mut columns: Vec<NumberColumn> = Vec::new();
        // Numbers of the moment in the array of each column, with the number of components and the component.
        let mut parts: Vec<(&[f64], usize, usize)> = Vec::new();
        for (array, rows, names) in [positions].into_iter().chain(others) {
            let (numbers, width) = (&array.numbers[rows], array.components);
            if numbers.len() != points * width {
                let expected = format!("{points} of {width} numbers in the array {}", quoted(&array.name));
                return Err(ReadError::at(&self.name, 1, expected, numbers.len().to_string()));
            }
            if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
                let expected = format!("finite numbers in the array {}", quoted(&array.name));
                let found = format!("{} at point {}", numbers[at], at / width.max(1) + 1);
                return Err(ReadError::at(&self.name, 1, expected, found));
            }
            for (component, name) in names.into_iter().enumerate() {
                // If two arrays have the same meaning, the first one is used.
                if columns.iter().all(|column| column.name != name) {
                    columns.push(NumberColumn { digits: array.digits, ..NumberColumn::new(&name) });
                    parts.push((numbers, width, component));
                }
            }
        }
        let row =
            |point: usize| parts.iter().map(move |(numbers, width, component)| numbers[point * width + component]);
        let table = Table::new(columns, (0..*points).flat_map(row).collect());
        Ok(Some(DumpSnapshot { step: at as u64, time: *time, table, first_line: 1, ..DumpSnapshot::default() }))
    }

    /// Returns the range of the numbers of points in an array from its row `first` on.
    fn rows(&self, array: &Array, first: usize, points: usize) -> Result<Range<usize>, ReadError> {
        let width = array.components;
        let last = first.checked_add(points).and_then(|last| last.checked_mul(width));
        let range = last.map(|last| first.saturating_mul(width)..last);
        range.filter(|range| array.numbers.get(range.clone()).is_some()).ok_or_else(|| {
            let expected = format!("{points} points from {first} on in the array {}", quoted(&array.name));
            ReadError::at(&self.name, 1, expected, format!("{} in all", array.numbers.len() / width))
        })
    }
}

/// File in memory with a reading position.
#[derive(Clone, Copy, Default)]
pub(crate) struct Bytes<'b> {
    file: &'b str,
    all: &'b [u8],
    at: usize,
}

impl<'b> Bytes<'b> {
    pub(crate) const fn new(file: &'b str, all: &'b [u8]) -> Self {
        Self { file, all, at: 0 }
    }

    /// Returns the whole file.
    pub(crate) const fn all(&self) -> &'b [u8] {
        self.all
    }

    /// Returns the name of the file for error messages.
    pub(crate) const fn file(&self) -> &'b str {
        self.file
    }

    /// Returns an error at the line that contains the byte `at`.
    pub(crate) fn error_at(&self, at: usize, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        let before = &self.all[..at.min(self.all.len())];
        let line = memchr::memchr_iter(b'\n', before).count() as u64 + 1;
        ReadError::at(self.file, line, expected, found)
    }

    /// Returns an error at the reading position, with the next word as the actual content.
    pub(crate) fn error(&self, expected: impl Into<String>) -> ReadError {
        let rest = &self.all[self.at.min(self.all.len())..];
        let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let word: Vec<u8> = rest[start..].iter().copied().take_while(|byte| !byte.is_ascii_whitespace()).collect();
        let found =
            if word.is_empty() { "the end of the file".to_owned() } else { quoted(&String::from_utf8_lossy(&word)) };
        let error = self.error_at(self.at + start, expected, found);
        if word.is_empty() { error.cut() } else { error }
    }

    /// Reads the next line without its line end. Returns `None` at the end of the file.
    pub(crate) fn line(&mut self) -> Option<&'b [u8]> {
        let rest = self.all.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Some(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    /// Returns the words of the next line that is not blank. The reading position does not change.
    pub(crate) fn next_words(&self) -> Option<Vec<&'b str>> {
        let mut ahead = *self;
        loop {
            let words: Vec<&str> = std::str::from_utf8(ahead.line()?).ok()?.split_whitespace().collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }

    /// Reads `count` bytes.
    pub(crate) fn take(&mut self, count: usize) -> Result<&'b [u8], ReadError> {
        match self.at.checked_add(count).and_then(|end| self.all.get(self.at..end)) {
            Some(bytes) => {
                self.at += count;
                Ok(bytes)
            }
            None => {
                let found = format!("the end of the file after {}", self.all.len().saturating_sub(self.at));
                Err(self.error_at(self.all.len(), format!("{count} bytes"), found).cut())
            }
        }
    }

    /// Reads `count` printed numbers and updates `digits` from their texts.
    pub(crate) fn printed(&mut self, count: usize, digits: &mut Digits) -> Result<Vec<f64>, ReadError> {
        // Memory grows with the numbers that are present, not with the declared number.
        let mut numbers = Vec::new();
        for _ in 0..count {
            let rest = &self.all[self.at..];
            let start = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let word = &rest[start..];
            let word = &word[..word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len())];
            match fast_float2::parse::<f64, _>(word) {
                Ok(number) => numbers.push(number),
                Err(_) => return Err(self.error(format!("{count} numbers"))),
            }
            digits.see(word);
            self.at += start + word.len();
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests;
