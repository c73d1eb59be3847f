//! Points of VTKHDF files (`.vtkhdf`) with `PolyData` or `UnstructuredGrid`, at one or several moments.
//!
//! Source: "VTKHDF File Format" of the VTK documentation, versions 1.0 to 2.3. Moment `s` has `Steps/NumberOfParts[s]`
//! parts from `Steps/PartOffsets[s]` on, with `NumberOfPoints` points each. The points of the moment begin at
//! `Steps/PointOffsets[s]`, and the data of the points at `Steps/PointDataOffsets/NAME[s]`.

use crate::read::binary::{Number, NumberKind};
use crate::read::digits::Digits;
use crate::read::format::{FileContent, Format, check_grains, indexed};
use crate::read::read_error::{ReadError, one_line, quoted};
use crate::read::snapshot::Numbering;
use crate::read::vtk::{Array, Moment, Points};
use hdf5_reader::error::Error;
use hdf5_reader::group::Group;
use hdf5_reader::messages::datatype::Datatype;
use hdf5_reader::{Dataset, Hdf5File, OpenOptions};
use std::cell::Cell;
use std::fmt::Display;
use std::fs;
use std::path::Path;

pub(crate) static FORMAT: Format = Format {
    words: "a VTK file",
    is_it: |beginning| beginning.bytes.starts_with(MARK),
    numbering: Numbering::Files,
    holds: |path| Ok(if has_steps(path)? { FileContent::Course(None) } else { FileContent::Moment }),
    open: |path, most_rows| {
        let moments = read_moments(path)?;
        check_grains(&moments.name, moments.grains(), most_rows)?;
        Ok(indexed(path, move |place| moments.snapshot(place)))
    },
};

/// First bytes of an HDF5 file.
const MARK: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Maximum size of a file, and of all its arrays together after decompression (B).
const MOST: usize = 1 << 30;
/// Name of the array that contains the time in a file of one moment.
const TIME: &str = "TimeValue";
/// Name of the group at the root.
const ROOT: &str = "VTKHDF";
/// Types of data sets that contain points.
const KINDS: [&str; 2] = ["PolyData", "UnstructuredGrid"];

/// Open VTKHDF file.
struct File {
    name: String,
    root: Group,
    /// Remaining number of bytes that may be decompressed. A small file may contain large arrays, or one array under
    /// several names.
    left: Cell<usize>,
}

/// Returns true if a file contains several moments.
///
/// # Errors
/// If the file cannot be read or is not a VTKHDF file.
pub(crate) fn has_steps(path: &Path) -> Result<bool, ReadError> {
    let file = File::open(path)?;
    Ok(file.group(&file.root, "Steps")?.is_some())
}

/// Reads the grains of a file at all moments. Arrays are kept whole, because moments may share them.
///
/// # Errors
/// If the file cannot be read, is truncated or is not a VTKHDF file.
pub(crate) fn read_moments(path: &Path) -> Result<Points, ReadError> {
    let file = File::open(path)?;
    let positions = file.array(&file.root, "Points", Some(3))?;
    let counts = file.whole(&file.root, "NumberOfPoints")?;
    let mut arrays = Vec::new();
    if let Some(point_data) = file.group(&file.root, "PointData")? {
        for name in file.members(&point_data)?.1 {
            arrays.push(file.array(&point_data, &name, None)?);
        }
    }
    let moments = match file.group(&file.root, "Steps")? {
        Some(steps) => file.moments(&steps, &counts, &arrays)?,
        None => {
            let points: usize = counts.iter().sum();
            // The number of rows must equal the declared number of points, because further rows would have no defined
            // meaning.
            for array in [&positions].into_iter().chain(&arrays) {
                let rows = array.numbers.len() / array.components;
                if rows != points {
                    let expected = format!("{points} points in the array {}", quoted(&array.name));
                    return Err(file.fault(&expected, rows));
                }
            }
            vec![Moment { time: file.time()?, points, first: None }]
        }
    };
    Ok(Points { name: file.name, positions, arrays, moments })
}

impl File {
    fn open(path: &Path) -> Result<Self, ReadError> {
        let name = path.to_string_lossy().into_owned();
        let fault =
            |expected: &str, found: &dyn Display| ReadError::at(&name, 1, expected, one_line(&found.to_string()));
        let length = fs::metadata(path).map_err(|error| ReadError::opening(&name, error))?.len();
        if length > MOST as u64 {
            return Err(fault(&format!("at most {MOST} bytes"), &"more"));
        }
        // Links to other files are not followed, because the user has not named these files.
        let options = OpenOptions { max_read_bytes: MOST, max_chunk_bytes: MOST, ..OpenOptions::default() };
        let bytes = fs::read(path).map_err(|error| ReadError::opening(&name, error))?;
        let file = Hdf5File::from_vec_with_options(bytes, options);
        let file = file.map_err(|error| fault("an HDF5 file", &error))?;
        let whole = file.superblock().eof_address;
        if length < whole {
            return Err(fault(&format!("{whole} bytes, as the file states"), &length));
        }
        let root = file.group(ROOT);
        let root = root.map_err(|error| fault("an HDF5 file with the group `VTKHDF`", &error))?;
        let kind = root.attribute("Type").and_then(|kind| kind.read_string());
        let kind = kind.map_err(|error| fault("the attribute `Type` of `VTKHDF`", &error))?;
        if !KINDS.contains(&kind.trim_end_matches('\0').trim()) {
            return Err(fault(&format!("points: {}", KINDS.join(" or ")), &quoted(&kind)));
        }
        Ok(Self { name, root, left: Cell::new(MOST) })
    }

    fn fault(&self, expected: &str, found: impl Display) -> ReadError {
        ReadError::at(&self.name, 1, expected, one_line(&found.to_string()))
    }

    /// Returns the names of the subgroups and the arrays of a group.
    fn members(&self, group: &Group) -> Result<(Vec<String>, Vec<String>), ReadError> {
        let members = group.member_names();
        members.map_err(|error| self.fault(&format!("the content of `{}`", group.name()), error))
    }

    /// Returns a subgroup, or `None` if there is none of this name. A damaged subgroup is an error.
    fn group(&self, parent: &Group, name: &str) -> Result<Option<Group>, ReadError> {
        if !self.members(parent)?.0.iter().any(|member| member == name) {
            return Ok(None);
        }
        parent.group(name).map(Some).map_err(|error| self.fault(&format!("the group `{name}`"), error))
    }

    /// Returns true if a group has an array of this name.
    fn has(&self, group: &Group, name: &str) -> Result<bool, ReadError> {
        Ok(self.members(group)?.1.iter().any(|member| member == name))
    }

    /// Reads an array with one entry per row. `components` is the number of components per row, if it is known.
    fn array(&self, group: &Group, name: &str, components: Option<usize>) -> Result<Array, ReadError> {
        let expected = format!("the array `{name}`");
        let read = || -> Result<(Dataset, usize), Error> {
            let dataset = group.dataset(name)?;
            let length = dataset.raw_byte_len()?;
            Ok((dataset, length))
        };
        let read_error = |error: Error| self.fault(&expected, error);
        let (dataset, length) = read().map_err(read_error)?;
        let left = self.left.get().checked_sub(length);
        self.left.set(left.ok_or_else(|| self.fault(&format!("at most {MOST} bytes in all arrays"), "more"))?);
        let bytes = dataset.read_native_bytes().map_err(read_error)?;
        let kind = number(dataset.dtype());
        let kind = kind.ok_or_else(|| self.fault(&format!("numbers in `{name}`"), "something else"))?;
        let width = match *dataset.shape() {
            [_] => Some(1),
            [_, width] => usize::try_from(width).ok(),
            _ => None,
        };
        let width = width.filter(|width| *width > 0 && components.is_none_or(|wanted| wanted == *width));
        let width =
            width.ok_or_else(|| self.fault(&expected, format!("an array of the shape {:?}", dataset.shape())))?;
        let numbers = kind.decode(&bytes, cfg!(target_endian = "big"));
        Ok(Array { name: name.to_owned(), components: width, numbers, digits: kind.digits(Digits::exact()) })
    }

    /// Reads an array of whole numbers that are not negative.
    fn whole(&self, group: &Group, name: &str) -> Result<Vec<usize>, ReadError> {
        let is_whole = |number: &f64| *number >= 0.0 && number.fract() == 0.0 && *number <= MOST as f64;
        let numbers = self.array(group, name, Some(1))?.numbers;
        match numbers.iter().find(|number| !is_whole(number)) {
            Some(other) => Err(self.fault(&format!("whole numbers in `{name}`"), other)),
            None => Ok(numbers.into_iter().map(|number| number as usize).collect()),
        }
    }

    /// Reads the time of a file of one moment, if the file contains it.
    fn time(&self) -> Result<Option<f64>, ReadError> {
        match self.group(&self.root, "FieldData")? {
            Some(field) if self.has(&field, TIME)? => Ok(self.array(&field, TIME, None)?.numbers.first().copied()),
            _ => Ok(None),
        }
    }

    /// Reads time, number of points and first rows of each moment in a file of several moments.
    fn moments(&self, steps: &Group, counts: &[usize], arrays: &[Array]) -> Result<Vec<Moment>, ReadError> {
        let times = self.array(steps, "Values", Some(1))?.numbers;
        let per_moment = |group: &Group, name: &str| -> Result<Vec<usize>, ReadError> {
            let list = self.whole(group, name)?;
            if list.len() == times.len() {
                return Ok(list);
            }
            Err(self.fault(&format!("{} numbers in `{name}`, one for each step", times.len()), list.len()))
        };
        // If the array `NumberOfParts` is missing, each moment has one part.
        let parts = "NumberOfParts";
        let parts = if self.has(steps, parts)? { per_moment(steps, parts)? } else { vec![1; times.len()] };
        let first_part = per_moment(steps, "PartOffsets")?;
        let first_point = per_moment(steps, "PointOffsets")?;
        let of_data = self.group(steps, "PointDataOffsets")?;
        let mut first = Vec::new();
        for array in arrays {
            first.push(match &of_data {
                Some(group) if self.has(group, &array.name)? => per_moment(group, &array.name)?,
                _ => first_point.clone(),
            });
        }
        let moment = |(at, time): (usize, &f64)| {
            let last = first_part[at].checked_add(parts[at]);
            let counts = last.and_then(|last| counts.get(first_part[at]..last)).ok_or_else(|| {
                self.fault(&format!("{} parts from {} on in `NumberOfPoints`", parts[at], first_part[at]), "fewer")
            })?;
            let first = Some((first_point[at], first.iter().map(|first| first[at]).collect()));
            Ok(Moment { time: Some(*time), points: counts.iter().sum(), first })
        };
        let moments: Vec<Moment> = times.iter().enumerate().map(moment).collect::<Result<_, ReadError>>()?;
        if moments.is_empty() { Err(self.fault("at least one step", "none")) } else { Ok(moments) }
    }
}

/// Returns the number type of an HDF5 type, or `None` if the type is not a number.
fn number(kind: &Datatype) -> Option<Number> {
    match *kind {
        Datatype::FixedPoint { size, signed: true, .. } => Number::new(NumberKind::Signed, usize::from(size)),
        Datatype::FixedPoint { size, signed: false, .. } => Number::new(NumberKind::Unsigned, usize::from(size)),
        Datatype::FloatingPoint { size, .. } => Number::new(NumberKind::Float, usize::from(size)),
        _ => None,
    }
}
