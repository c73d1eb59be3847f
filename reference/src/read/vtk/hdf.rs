//! Points of VTKHDF files (`.vtkhdf`): `PolyData` and `UnstructuredGrid`, of one moment or of several.
//!
//! Source: "VTKHDF File Format" of the VTK documentation, versions 1.0 to 2.3. A moment `s` has the parts from
//! `Steps/PartOffsets[s]` on, `Steps/NumberOfParts[s]` of them, with `NumberOfPoints` each. Its points begin at
//! `Steps/PointOffsets[s]`, what is told of them at `Steps/PointDataOffsets/NAME[s]`.

use super::points::{Array, Points};
use crate::read::binary::Number;
use crate::read::read_error::{ReadError, one_line, quoted};
use crate::read::snapshot::DumpSnapshot;
use hdf5_reader::group::Group;
use hdf5_reader::messages::datatype::Datatype;
use hdf5_reader::{Dataset, Hdf5File, OpenOptions};
use std::fs;
use std::path::Path;

/// How a file begins.
pub(crate) const MARK: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Most bytes of a file, and of an array that is unpacked from it.
const MOST: usize = 1 << 30;
/// The time of a file of one moment.
const TIME: &str = "TimeValue";
/// The one group at the root.
const ROOT: &str = "VTKHDF";
/// Kinds that have points.
const KINDS: [&str; 2] = ["PolyData", "UnstructuredGrid"];

/// A file that is open.
struct File {
    name: String,
    root: Group,
}

/// Whether a file holds several moments, or one.
///
/// # Errors
/// The file cannot be read or is none of VTK's.
pub(crate) fn has_steps(path: &Path) -> Result<bool, ReadError> {
    let file = File::open(path)?;
    Ok(file.group(&file.root, "Steps")?.is_some())
}

/// The grains of a file moment after moment; the steps are the places of the moments where there are several.
///
/// # Errors
/// The file cannot be read, breaks off, or is not such a file.
pub(crate) fn read_moments(path: &Path) -> Result<Vec<DumpSnapshot>, ReadError> {
    let file = File::open(path)?;
    let positions = file.array(&file.root, "Points", Some(3))?;
    let counts = file.whole(&file.root, "NumberOfPoints")?;
    let mut arrays = Vec::new();
    if let Some(told) = file.group(&file.root, "PointData")? {
        for name in file.members(&told)?.1 {
            arrays.push(file.array(&told, &name, None)?);
        }
    }
    let Some(steps) = file.group(&file.root, "Steps")? else {
        let field = file.group(&file.root, "FieldData")?;
        let time = match field {
            Some(field) if file.has(&field, TIME)? => file.array(&field, TIME, None)?.numbers.first().copied(),
            _ => None,
        };
        let points: usize = counts.iter().sum();
        let moment = Moment { time, points, position: 0, of: vec![0; arrays.len()] };
        return Ok(vec![file.snapshot(0, &moment, &positions, &arrays)?]);
    };
    let times = file.array(&steps, "Values", Some(1))?.numbers;
    let moments = times.len();
    let per_moment = |group: &Group, name: &str| -> Result<Vec<usize>, ReadError> {
        let list = file.whole(group, name)?;
        if list.len() == moments {
            return Ok(list);
        }
        Err(file.fault(&format!("{moments} numbers in `{name}`, one a step"), &list.len().to_string()))
    };
    // One part a moment where nothing is said of parts.
    let parts =
        if file.has(&steps, "NumberOfParts")? { per_moment(&steps, "NumberOfParts")? } else { vec![1; moments] };
    let first_part = per_moment(&steps, "PartOffsets")?;
    let first_point = per_moment(&steps, "PointOffsets")?;
    let of_data = file.group(&steps, "PointDataOffsets")?;
    let mut first = Vec::new();
    for array in &arrays {
        first.push(match &of_data {
            Some(group) if file.has(group, &array.name)? => per_moment(group, &array.name)?,
            _ => first_point.clone(),
        });
    }
    let mut snapshots = Vec::new();
    for at in 0..moments {
        let last = first_part[at].checked_add(parts[at]);
        let counts = last.and_then(|last| counts.get(first_part[at]..last)).ok_or_else(|| {
            file.fault(&format!("{} parts from {} on in `NumberOfPoints`", parts[at], first_part[at]), "fewer")
        })?;
        let points = counts.iter().try_fold(0_usize, |sum, count| sum.checked_add(*count));
        let points = points.ok_or_else(|| file.fault("a number of points", "more than can be counted"))?;
        let of = first.iter().map(|first| first[at]).collect();
        let moment = Moment { time: Some(times[at]), points, position: first_point[at], of };
        snapshots.push(file.snapshot(at as u64, &moment, &positions, &arrays)?);
    }
    if snapshots.is_empty() { Err(file.fault("at least one step", "none")) } else { Ok(snapshots) }
}

/// Where a moment stands in the arrays.
struct Moment {
    time: Option<f64>,
    points: usize,
    position: usize,
    of: Vec<usize>,
}

impl File {
    fn open(path: &Path) -> Result<Self, ReadError> {
        let name = path.to_string_lossy().into_owned();
        let fault = |expected: &str, found: &str| ReadError::at(&name, 1, expected, one_line(found));
        let length = fs::metadata(path).map_err(|error| ReadError::opening(&name, error))?.len();
        if length > MOST as u64 {
            return Err(fault(&format!("at most {MOST} bytes"), "more"));
        }
        // What lies in other files stays there: nobody named them.
        let options = OpenOptions { max_read_bytes: MOST, max_chunk_bytes: MOST, ..OpenOptions::default() };
        let bytes = fs::read(path).map_err(|error| ReadError::opening(&name, error))?;
        let file = Hdf5File::from_vec_with_options(bytes, options);
        let file = file.map_err(|error| fault("an HDF5 file", &error.to_string()))?;
        let whole = file.superblock().eof_address;
        if length < whole {
            return Err(fault(&format!("{whole} bytes, as the file says itself"), &length.to_string()));
        }
        let root = file.group(ROOT);
        let root = root.map_err(|error| fault("an HDF5 file with the group `VTKHDF`", &error.to_string()))?;
        let kind = root.attribute("Type").and_then(|kind| kind.read_string());
        let kind = kind.map_err(|error| fault("the attribute `Type` of `VTKHDF`", &error.to_string()))?;
        if !KINDS.contains(&kind.trim_end_matches('\0').trim()) {
            return Err(fault(&format!("points: {}", KINDS.join(" or ")), &quoted(&kind)));
        }
        Ok(Self { name, root })
    }

    fn fault(&self, expected: &str, found: &str) -> ReadError {
        ReadError::at(&self.name, 1, expected, one_line(found))
    }

    /// Names of groups and of arrays.
    fn members(&self, group: &Group) -> Result<(Vec<String>, Vec<String>), ReadError> {
        let members = group.member_names();
        members.map_err(|error| self.fault(&format!("what is in `{}`", group.name()), &error.to_string()))
    }

    /// A group of a group; none where it has none of that name, which a damaged one is not.
    fn group(&self, of: &Group, name: &str) -> Result<Option<Group>, ReadError> {
        if !self.members(of)?.0.iter().any(|member| member == name) {
            return Ok(None);
        }
        of.group(name).map(Some).map_err(|error| self.fault(&format!("the group `{name}`"), &error.to_string()))
    }

    /// Whether a group has an array of this name.
    fn has(&self, group: &Group, name: &str) -> Result<bool, ReadError> {
        Ok(self.members(group)?.1.iter().any(|member| member == name))
    }

    /// An array: a row an entry, with so many numbers each where it is known.
    fn array(&self, group: &Group, name: &str, components: Option<usize>) -> Result<Array, ReadError> {
        let expected = format!("the array `{name}`");
        let read = || -> Result<(Dataset, Vec<u8>), hdf5_reader::error::Error> {
            let dataset = group.dataset(name)?;
            let bytes = dataset.read_native_bytes()?;
            Ok((dataset, bytes))
        };
        let (dataset, bytes) = read().map_err(|error| self.fault(&expected, &error.to_string()))?;
        let kind = number(dataset.dtype());
        let kind = kind.ok_or_else(|| self.fault(&format!("numbers in `{name}`"), "something else"))?;
        let width = match *dataset.shape() {
            [_] => Some(1),
            [_, width] => usize::try_from(width).ok(),
            _ => None,
        };
        let width = width.filter(|width| *width > 0 && components.is_none_or(|wanted| wanted == *width));
        let width = width.ok_or_else(|| self.fault(&expected, &format!("one of the shape {:?}", dataset.shape())))?;
        let numbers = kind.decode(&bytes, cfg!(target_endian = "big"));
        Ok(Array { name: name.to_owned(), components: width, numbers, digits: kind.digits() })
    }

    /// Whole numbers, zero or more.
    fn whole(&self, group: &Group, name: &str) -> Result<Vec<usize>, ReadError> {
        let is_whole = |number: &f64| *number >= 0.0 && number.fract() == 0.0 && *number <= MOST as f64;
        let numbers = self.array(group, name, Some(1))?.numbers;
        match numbers.iter().find(|number| !is_whole(number)) {
            Some(other) => Err(self.fault(&format!("whole numbers in `{name}`"), &other.to_string())),
            None => Ok(numbers.into_iter().map(|number| number as usize).collect()),
        }
    }

    /// The grains of a moment.
    fn snapshot(
        &self,
        step: u64,
        moment: &Moment,
        positions: &Array,
        arrays: &[Array],
    ) -> Result<DumpSnapshot, ReadError> {
        let cut = |array: &Array, first: usize| -> Result<Array, ReadError> {
            let last = first.checked_add(moment.points).and_then(|last| last.checked_mul(array.components));
            let numbers = last.and_then(|last| array.numbers.get(first.saturating_mul(array.components)..last));
            let numbers = numbers.map(<[f64]>::to_vec).ok_or_else(|| {
                let expected = format!("{} points from {first} on in the array {}", moment.points, quoted(&array.name));
                self.fault(&expected, &format!("{} in all", array.numbers.len() / array.components))
            })?;
            Ok(Array { numbers, name: array.name.clone(), ..*array })
        };
        let told: Result<Vec<Array>, ReadError> =
            arrays.iter().zip(&moment.of).map(|(array, first)| cut(array, *first)).collect();
        let points = Points { time: moment.time, positions: cut(positions, moment.position)?, arrays: told? };
        Ok(DumpSnapshot { step, ..points.snapshot(&self.name)? })
    }
}

/// The kind of a number; none of what is none.
fn number(kind: &Datatype) -> Option<Number> {
    Some(match *kind {
        Datatype::FixedPoint { size: 1, signed: true, .. } => Number::I8,
        Datatype::FixedPoint { size: 1, signed: false, .. } => Number::U8,
        Datatype::FixedPoint { size: 2, signed: true, .. } => Number::I16,
        Datatype::FixedPoint { size: 2, signed: false, .. } => Number::U16,
        Datatype::FixedPoint { size: 4, signed: true, .. } => Number::I32,
        Datatype::FixedPoint { size: 4, signed: false, .. } => Number::U32,
        Datatype::FixedPoint { size: 8, signed: true, .. } => Number::I64,
        Datatype::FixedPoint { size: 8, signed: false, .. } => Number::U64,
        Datatype::FloatingPoint { size: 4, .. } => Number::F32,
        Datatype::FloatingPoint { size: 8, .. } => Number::F64,
        _ => return None,
    })
}
