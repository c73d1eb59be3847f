//! Points with their data from files of VTK and NumPy, and their conversion to snapshots of grains.

use crate::read::digits::Digits;
use crate::read::number_table::{NumberColumn, Table};
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::DumpSnapshot;

/// Array with the components of all points, point by point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub(crate) name: String,
    pub(crate) components: usize,
    pub(crate) numbers: Vec<f64>,
    pub(crate) digits: Digits,
}

/// Points with their data.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Points {
    /// Time; `None` if the file does not contain it.
    pub(crate) time: Option<f64>,
    pub(crate) positions: Array,
    pub(crate) arrays: Vec<Array>,
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

impl Points {
    /// Returns a snapshot of the points as grains. The step is 0 and must be set by the caller.
    pub(crate) fn snapshot(self, file: &str) -> Result<DumpSnapshot, ReadError> {
        let points = self.positions.numbers.len() / 3;
        let mut columns: Vec<NumberColumn> = Vec::new();
        let mut parts: Vec<(&Array, usize)> = Vec::new();
        let positions = (&self.positions, AXES.map(str::to_owned).to_vec());
        let others = self.arrays.iter().map(|array| (array, array.columns()));
        for (array, names) in [positions].into_iter().chain(others) {
            if array.numbers.len() != points * array.components {
                let expected = format!("{points} of {} numbers in the array {}", array.components, quoted(&array.name));
                return Err(ReadError::at(file, 1, expected, array.numbers.len().to_string()));
            }
            if let Some(at) = array.numbers.iter().position(|number| !number.is_finite()) {
                let expected = format!("finite numbers in the array {}", quoted(&array.name));
                let found = format!("{} at point {}", array.numbers[at], at / array.components.max(1) + 1);
                return Err(ReadError::at(file, 1, expected, found));
            }
            for (component, name) in names.into_iter().enumerate() {
                // If two arrays have the same meaning, the first one is used.
                if columns.iter().all(|column| column.name != name) {
                    columns.push(NumberColumn { digits: array.digits, ..NumberColumn::new(&name) });
                    parts.push((array, component));
                }
            }
        }
        let row = |point: usize| {
            let parts = &parts;
            parts.iter().map(move |(array, component)| array.numbers[point * array.components + component])
        };
        let values = (0..points).flat_map(row).collect();
        let table = Table::new(columns, values);
        Ok(DumpSnapshot { time: self.time, table, first_line: 1, ..DumpSnapshot::default() })
    }
}

/// Points with their data at one or several moments, which may share arrays.
#[derive(Debug)]
pub(crate) struct Moments {
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
    pub(crate) position: usize,
    pub(crate) of: Vec<usize>,
}

impl Moments {
    /// Returns the largest number of grains at any moment.
    pub(crate) fn grains(&self) -> usize {
        self.moments.iter().map(|moment| moment.points).max().unwrap_or(0)
    }

    /// Returns the grains at a moment, whose index is used as the step. Returns `None` after the last moment.
    ///
    /// # Errors
    /// If an array is too short or has a number that is not finite.
    pub(crate) fn snapshot(&self, at: usize) -> Result<Option<DumpSnapshot>, ReadError> {
        let Some(moment) = self.moments.get(at) else { return Ok(None) };
        let cut = |array: &Array, first: usize| -> Result<Array, ReadError> {
            let last = first.checked_add(moment.points).and_then(|last| last.checked_mul(array.components));
            let numbers = last.and_then(|last| array.numbers.get(first.saturating_mul(array.components)..last));
            let numbers = numbers.map(<[f64]>::to_vec).ok_or_else(|| {
                let expected = format!("{} points from {first} on in the array {}", moment.points, quoted(&array.name));
                ReadError::at(&self.name, 1, expected, format!("{} in all", array.numbers.len() / array.components))
            })?;
            Ok(Array { numbers, name: array.name.clone(), ..*array })
        };
        let cut_arrays: Result<Vec<Array>, ReadError> =
            self.arrays.iter().zip(&moment.of).map(|(array, first)| cut(array, *first)).collect();
        let points =
            Points { time: moment.time, positions: cut(&self.positions, moment.position)?, arrays: cut_arrays? };
        Ok(Some(DumpSnapshot { step: at as u64, ..points.snapshot(&self.name)? }))
    }
}
