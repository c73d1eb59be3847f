//! Points with their data from any of the formats, and their conversion to a snapshot of grains.

use crate::read::digits::Digits;
use crate::read::numbers::NumberColumn;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::DumpSnapshot;

/// Numbers of all points, one point after the other, with the components of each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) numbers: Vec<f64>,
    pub(super) digits: Digits,
}

/// Points with their data.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Points {
    /// Time, if the file contains it.
    pub(super) time: Option<f64>,
    /// Positions of the points.
    pub(super) positions: Array,
    /// Data of the points.
    pub(super) arrays: Vec<Array>,
}

/// Names of a velocity in programs.
const VELOCITY: [&str; 7] =
    ["v", "velocity", "vel", "velocity_lin", "linvelocity", "linear_velocity", "linear velocity"];
/// Names of a spin in programs.
const SPIN: [&str; 8] =
    ["omega", "spin", "angvel", "velocity_ang", "angvelocity", "angular_velocity", "angular velocity", "w"];
/// Names of the id of a grain in programs.
const ID: [&str; 4] = ["id", "particle_id", "particleid", "particle id"];

const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns true if the name is that of the id of a grain.
pub(crate) fn is_id(name: &str) -> bool {
    ID.contains(&name.to_lowercase().as_str())
}

/// Returns the name in dumps for a component of a vector.
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
    /// Returns the names of the columns.
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
    /// Returns a snapshot of grains. Its step is not set.
    pub(super) fn snapshot(self, file: &str) -> Result<DumpSnapshot, ReadError> {
        let points = self.positions.numbers.len() / 3;
        let mut columns: Vec<NumberColumn> = Vec::new();
        let mut parts: Vec<(&Array, usize)> = Vec::new();
        for array in [&self.positions].into_iter().chain(&self.arrays) {
            let names = if std::ptr::eq(array, &raw const self.positions) {
                AXES.map(str::to_owned).to_vec()
            } else {
                array.columns()
            };
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
        Ok(DumpSnapshot { time: self.time, columns, first_line: 1, values, ..DumpSnapshot::default() })
    }
}
