//! Arrays in files of NumPy (`.npz`), which are ZIP archives with one `.npy` file per array.
//!
//! Source: "numpy.lib.format", versions 1.0 to 3.0 of `.npy`.

use crate::read::binary::Number;
use crate::read::digits::Digits;
use crate::read::format::{FileContent, Format, check_grains, indexed};
use crate::read::lines::opened;
use crate::read::number_table::{NumberColumn, Table};
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot, Numbering};
use crate::read::vtk::{self, Moment, Points};
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use zip::ZipArchive;

pub(crate) static FORMAT: Format = Format {
    words: "NumPy arrays",
    // ZIP archives with other endings are read as text and then refused.
    is_it: |beginning| {
        beginning.bytes.starts_with(MARK)
            && beginning.path.extension().is_some_and(|end| end.eq_ignore_ascii_case("npz"))
    },
    numbering: Numbering::Steps,
    holds: |_| Ok(FileContent::Course(None)),
    open: |path, most_rows| {
        let course = read_course(path)?;
        check_grains(&course.grains.name, course.grains.grains(), most_rows)?;
        Ok(indexed(path, move |place| course.snapshot(place)))
    },
};

/// First bytes of an `.npz` file.
const MARK: &[u8] = b"PK\x03\x04";
/// First bytes of an `.npy` file.
const ARRAY: &[u8] = b"\x93NUMPY";
/// Maximum size of all arrays together (B).
const MOST: u64 = 1 << 30;

/// Array of numbers, in which the last index varies fastest.
#[derive(Clone, Debug, PartialEq)]
struct Array {
    shape: Vec<usize>,
    numbers: Vec<f64>,
    digits: Digits,
}

/// Grains at several moments, from one file.
#[derive(Debug)]
struct Course {
    /// Step of each moment. If the file has no steps, this is the index of the moment.
    steps: Vec<u64>,
    /// Numbering of the moments. If the file has both steps and times, the steps are those of the run. Otherwise the
    /// numbers may count frames.
    numbering: Numbering,
    grains: Points,
    contacts: Option<Contacts>,
}

/// Array of the positions of the grains, which is required.
const POSITION: &str = "position";
/// Known arrays of grains: name, and number of components.
///
/// An array of vectors has the shape (moments, grains, 3). An array of numbers has the shape (moments, grains) or
/// (grains).
const KNOWN: [(&str, usize); 5] = [(POSITION, 3), ("velocity", 3), ("spin", 3), ("id", 1), ("radius", 1)];

/// Ending of the name of an array with the forces of a wall on the grains, as in `floor.force`.
const OF_WALL: &str = ".force";
/// Array with the step of each contact, in ascending order. The other arrays of contacts have the same number of rows.
const CONTACT_STEP: &str = "contact_step";
/// Arrays of contacts: name and columns.
const CONTACT: [(&str, &[&str]); 2] =
    [("contact_id", &["id1", "id2"]), ("contact_force", &["force_x", "force_y", "force_z"])];

/// Reads the arrays `position`, `velocity`, `spin`, `id` and `radius` of grains, the forces of walls, the contacts between
/// grains, and the arrays `step` and `time` of moments. At least one of `step` and `time` is required.
///
/// # Errors
/// If the file cannot be read, lacks a required array, or has arrays of other shapes.
fn read_course(path: &Path) -> Result<Course, ReadError> {
    let name = path.to_string_lossy();
    let arrays = arrays(path, &name)?;
    let fault = |expected: String, found: String| ReadError::at(&name, 1, expected, found);
    let have = || quoted(&arrays.keys().cloned().collect::<Vec<_>>().join(" "));
    let of_moments = |key: &str| match arrays.get(key) {
        Some(Array { shape, numbers, .. }) if shape.len() == 1 => Ok(Some(numbers.clone())),
        Some(Array { shape, .. }) => {
            let expected = format!("one number for each time in the array `{key}`");
            Err(fault(expected, format!("the shape {shape:?}")))
        }
        None => Ok(None),
    };
    let (steps, times) = (of_moments("step")?, of_moments("time")?);
    let moments = steps.as_ref().or(times.as_ref()).map(Vec::len);
    let moments = moments.ok_or_else(|| fault("an array `step` or `time`".to_owned(), have()))?;
    if times.as_ref().is_some_and(|times| times.len() != moments) {
        return Err(fault("as many times as steps".to_owned(), "others".to_owned()));
    }
    let numbering = if steps.is_some() && times.is_some() { Numbering::Steps } else { Numbering::Files };
    let steps = match steps {
        None => (0..moments as u64).collect(),
        Some(steps) => {
            let whole = |step: f64| if step >= 0.0 && step.fract() == 0.0 { Ok(step as u64) } else { Err(step) };
            let steps: Result<Vec<u64>, f64> = steps.into_iter().map(whole).collect();
            steps.map_err(|step| fault("whole numbers of steps, zero or more".to_owned(), step.to_string()))?
        }
    };
    if let Some(at) = steps.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(fault(format!("a step after {}", steps[at]), steps[at + 1].to_string()));
    }
    let contacts = contacts(&arrays, &steps).map_err(|(expected, found)| fault(expected, found))?;
    // Number of grains, and arrays of grains with their number of rows per moment, which is 0 for a constant array.
    let (mut count, mut found) = (0, Vec::new());
    let of_walls = arrays.keys().filter(|key| key.ends_with(OF_WALL)).map(|key| (key.as_str(), 3));
    for (key, width) in KNOWN.into_iter().chain(of_walls) {
        let must = key == POSITION;
        let Some(array) = arrays.get(key) else {
            if must {
                return Err(fault(format!("an array `{key}`"), have()));
            }
            continue;
        };
        let inner: &[usize] =
            if width == 1 { &array.shape } else { array.shape.split_last().map_or(&[], |(_, rest)| rest) };
        let is_wide = width == 1 || array.shape.last() == Some(&width);
        let (grains, of_moments) = match *inner {
            [all, grains] if all == moments => (grains, true),
            [grains] if width == 1 => (grains, false),
            _ => (0, true),
        };
        let expected = if must { grains } else { count };
        if !is_wide || grains != expected || (must && (inner.len() != 2 || inner[0] != moments)) {
            let words = if width == 1 { "grains" } else { "grains, 3" };
            let grains = if must { "grains".to_owned() } else { count.to_string() };
            let words = words.replace("grains", &grains);
            let expected = format!("the shape ({moments}, {words}) of the array `{key}`");
            return Err(fault(expected, format!("{:?}", array.shape)));
        }
        if let Some(wrong) = array.numbers.iter().find(|number| !number.is_finite()) {
            return Err(fault(format!("finite numbers in the array `{key}`"), wrong.to_string()));
        }
        count = expected;
        let (name, numbers, digits) = (key.to_owned(), array.numbers.clone(), array.digits);
        found.push((vtk::Array { name, components: width, numbers, digits }, if of_moments { grains } else { 0 }));
    }
    let positions = found.remove(0).0;
    let (arrays, rows): (Vec<_>, Vec<usize>) = found.into_iter().unzip();
    let moment = |at: usize| Moment {
        time: times.as_ref().map(|times| times[at]),
        points: count,
        first: Some((at * count, rows.iter().map(|rows| at * rows).collect())),
    };
    let grains = Points { name: name.to_string(), positions, arrays, moments: (0..moments).map(moment).collect() };
    Ok(Course { steps, numbering, grains, contacts })
}

impl Course {
    /// Returns the contacts of each moment, if the file contains them, then the grains of each moment, or `None` after
    /// the last.
    fn snapshot(&self, place: usize) -> Result<Option<DumpSnapshot>, ReadError> {
        let (contacts, at) = match &self.contacts {
            Some(contacts) if place < self.steps.len() => (Some(contacts), place),
            Some(_) => (None, place - self.steps.len()),
            None => (None, place),
        };
        let Some(Moment { time, .. }) = self.grains.moments.get(at) else { return Ok(None) };
        let snapshot = if let Some((contacts, rows)) = contacts {
            let [first, count] = rows[at];
            let (kind, table) = (DumpKind::Entries, contacts.part(first, count));
            Some(DumpSnapshot { kind, time: *time, table, first_line: 1, ..DumpSnapshot::default() })
        } else {
            self.grains.snapshot(at)?
        };
        Ok(snapshot.map(|next| DumpSnapshot { step: self.steps[at], numbering: self.numbering, ..next }))
    }
}

/// Contacts of all moments, and first row and number of rows of each moment.
type Contacts = (Table, Vec<[usize; 2]>);

/// Returns the contacts in the arrays, if there are any. `steps` are the
/// steps of the moments. An error consists of the expected and the actual content.
fn contacts(arrays: &BTreeMap<String, Array>, steps: &[u64]) -> Result<Option<Contacts>, (String, String)> {
    let Some(step) = arrays.get(CONTACT_STEP) else { return Ok(None) };
    let rows = step.numbers.len();
    let (mut names, mut parts) = (Vec::new(), Vec::new());
    for (key, columns) in CONTACT {
        let expected = || format!("the shape ({rows}, {}) of the array `{key}`", columns.len());
        let array = arrays.get(key).ok_or_else(|| (expected(), "no such array".to_owned()))?;
        if array.shape != [rows, columns.len()] {
            return Err((expected(), format!("{:?}", array.shape)));
        }
        if let Some(wrong) = array.numbers.iter().find(|number| !number.is_finite()) {
            return Err((format!("finite numbers in the array `{key}`"), wrong.to_string()));
        }
        names.extend(columns.iter().map(|name| NumberColumn { digits: array.digits, ..NumberColumn::new(name) }));
        parts.push((columns.len(), &array.numbers));
    }
    let numbers = |row: usize| parts.iter().flat_map(move |&(width, numbers)| &numbers[row * width..(row + 1) * width]);
    let contacts = Table::new(names, (0..rows).flat_map(numbers).copied().collect());
    let (mut ranges, mut row) = (Vec::new(), 0);
    for &moment in steps {
        let count = step.numbers[row..].iter().take_while(|step| **step == moment as f64).count();
        ranges.push([row, count]);
        row += count;
    }
    if row < rows {
        let expected = format!("steps of the grains in ascending order in the array `{CONTACT_STEP}`");
        return Err((expected, format!("{} in row {}", step.numbers[row], row + 1)));
    }
    Ok(Some((contacts, ranges)))
}

/// Returns all arrays of a file by name.
fn arrays(path: &Path, name: &str) -> Result<BTreeMap<String, Array>, ReadError> {
    let damaged =
        |error: zip::result::ZipError| ReadError::at(name, 1, "a complete `.npz` file", quoted(&error.to_string()));
    let mut archive = ZipArchive::new(opened(path)?).map_err(damaged)?;
    let mut arrays = BTreeMap::new();
    let mut left = MOST;
    for place in 0..archive.len() {
        let entry = archive.by_index(place).map_err(damaged)?;
        let entry_name = entry.name().map_err(damaged)?.into_owned();
        let Some(key) = entry_name.strip_suffix(".npy").map(str::to_owned) else { continue };
        let mut bytes = Vec::new();
        // Memory grows with the bytes that are present, not with the declared size.
        entry.take(left + 1).read_to_end(&mut bytes).map_err(|error| ReadError::reading(name, 1, error))?;
        left = left
            .checked_sub(bytes.len() as u64)
            .ok_or_else(|| ReadError::at(name, 1, format!("at most {MOST} bytes of arrays"), "more"))?;
        let array = array(&bytes).map_err(|(expected, found)| {
            ReadError::at(name, 1, format!("{expected} in the array {}", quoted(&key)), found)
        })?;
        if let Some(array) = array {
            arrays.insert(key, array);
        }
    }
    Ok(arrays)
}

/// Returns an array, or `None` if its elements are not numbers. An error consists of the expected and the actual
/// content.
fn array(bytes: &[u8]) -> Result<Option<Array>, (String, String)> {
    let short = || ("a complete header".to_owned(), "the end of the file".to_owned());
    let rest = bytes.strip_prefix(ARRAY).ok_or_else(|| ("`.npy`".to_owned(), "something else".to_owned()))?;
    let (version, rest) = rest.split_at_checked(2).ok_or_else(short)?;
    let (length, rest) = rest.split_at_checked(if version[0] == 1 { 2 } else { 4 }).ok_or_else(short)?;
    let length = length.iter().rev().fold(0_usize, |sum, byte| sum << 8 | usize::from(*byte));
    let (head, data) = rest.split_at_checked(length).ok_or_else(short)?;
    let head = String::from_utf8_lossy(head).into_owned();
    let value = |key: &str| {
        let (_, rest) = head.split_once(&format!("'{key}':"))?;
        Some(rest.trim_start())
    };
    let kind = value("descr").and_then(|rest| rest.strip_prefix('\'')?.split_once('\'')).map(|(kind, _)| kind);
    let (Some(kind), Some(order), Some(shape)) = (kind, value("fortran_order"), value("shape")) else {
        return Ok(None);
    };
    if order.starts_with("True") {
        return Err(("arrays in C order (last index fastest)".to_owned(), "`fortran_order`".to_owned()));
    }
    let shape = shape.strip_prefix('(').and_then(|rest| rest.split_once(')')).map_or("", |(shape, _)| shape);
    let lengths = shape.split(',').map(str::trim).filter(|length| !length.is_empty()).map(str::parse);
    let shape: Vec<usize> = lengths.collect::<Result<_, _>>().map_err(|_| ("a shape".to_owned(), quoted(shape)))?;
    let Some(number) = Number::of_numpy(kind.trim_start_matches(['<', '>', '|', '='])) else { return Ok(None) };
    let count = shape.iter().try_fold(1_usize, |product, length| product.checked_mul(*length));
    if count.and_then(|count| count.checked_mul(number.size())) != Some(data.len()) {
        return Err((format!("numbers for the shape {shape:?}"), format!("{} bytes", data.len())));
    }
    Ok(Some(Array {
        numbers: number.decode(data, kind.starts_with('>')),
        shape,
        digits: number.digits(Digits::exact()),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn read(name: &str) -> Result<Course, String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/npz").join(name);
        read_course(&path).map_err(|error| error.to_string().rsplit('/').next().unwrap_or_default().to_owned())
    }

    #[test]
    fn arrays_of_numpy_are_read() {
        for name in ["grains.npz", "grains-compressed.npz"] {
            let course = read(name).unwrap();
            assert_eq!(course.grains.grains(), 2);
            let last = course.snapshot(2).unwrap().unwrap();
            assert_eq!((last.step, last.time), (25, Some(0.25)));
            // A file with steps and times has steps of the run.
            assert_eq!(last.numbering, Numbering::Steps);
            assert!(course.snapshot(3).unwrap().is_none());
            let value = |column: &str, row: usize| last.row(row)[last.column(column).unwrap()];
            assert_eq!([value("id", 0), value("id", 1)], [2.0, 1.0]);
            assert_eq!([value("x", 0), value("z", 1)], [12.0 / 7.0, 17.0 / 7.0]);
            assert_eq!(value("vx", 0), f64::from(-12.0_f32 / 7.0));
            assert_eq!([value("omegaz", 0), value("omegax", 1)], [5.0, 0.0]);
            let digits = |column: &str| last.columns[last.column(column).unwrap()].digits;
            assert!(digits("vx").uncertainty(1.0, &last.digits()) > 1e-8, "a single number is not exact");
            assert!(digits("x").uncertainty(1.0, &last.digits()) < 1e-15);
        }
    }

    #[test]
    fn contacts_and_forces_of_walls_are_read() {
        let course = read("contacts.npz").unwrap();
        let value =
            |snapshot: &DumpSnapshot, row: usize, column: &str| snapshot.row(row)[snapshot.column(column).unwrap()];
        let [first, second, third, fourth] = [0, 1, 2, 3].map(|place| course.snapshot(place).unwrap().unwrap());
        assert!(course.snapshot(4).unwrap().is_none());
        assert_eq!([&first, &second, &third, &fourth].map(|snapshot| snapshot.step), [0, 10, 0, 10]);
        assert_eq!((first.kind, first.rows(), second.rows()), (DumpKind::Entries, 1, 2));
        assert_eq!([value(&second, 0, "id1"), value(&second, 0, "id2")], [2.0, 1.0]);
        assert_eq!([value(&second, 0, "force_x"), value(&second, 1, "force_z")], [3.0 / 7.0, 8.0 / 7.0]);
        assert_eq!((third.kind, value(&fourth, 1, "x")), (DumpKind::Atoms, 1.0));
        assert_eq!([value(&third, 0, "floor.force_y"), value(&fourth, 1, "floor.force_z")], [1.0 / 3.0, 11.0 / 3.0]);
    }

    #[test]
    fn other_shapes_are_refused_in_words() {
        for (file, message) in [
            ("contacts-late", "steps of the grains in ascending order in the array `contact_step`, found 5 in row 2"),
            ("contacts-short", "the shape (3, 3) of the array `contact_force`, found [2, 3]"),
            ("wall-flat", "the shape (2, 2, 3) of the array `floor.force`, found [2, 2]"),
            ("flat", "the shape (3, grains, 3) of the array `position`, found [3, 3]"),
            ("moment-lost", "the shape (3, grains, 3) of the array `position`, found [2, 2, 3]"),
            ("fortran", "arrays in C order (last index fastest) in the array `position`, found `fortran_order`"),
        ] {
            let file = format!("{file}.npz");
            assert_eq!(read(&file).unwrap_err(), format!("{file}:1: expected {message}"));
        }
    }

    #[test]
    fn damaged_files_are_refused_or_read() {
        let folder = tempfile::tempdir().unwrap();
        let damaged = folder.path().join("damaged.npz");
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/npz/grains.npz");
        let whole = fs::read(path).unwrap();
        for cut in 0..whole.len() {
            fs::write(&damaged, &whole[..cut]).unwrap();
            assert!(read_course(&damaged).is_err(), "cut at {cut}");
        }
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            fs::write(&damaged, &bytes).unwrap();
            // Any result is allowed, but no panic.
            let _ = read_course(&damaged);
        }
    }
}
