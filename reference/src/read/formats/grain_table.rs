//! Tables of grains from ParaView, pandas or any other program. Each row is one grain at one moment. Rows with the same
//! step or time form a snapshot. Columns have the names used in dumps or in ParaView.

use crate::read::format::{FileContent, Format, check_grains, indexed};
use crate::read::read_error::ReadError;
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::{Table, header, read_table};
use crate::read::vtk::points::{component, is_id};
use std::path::Path;

pub(crate) static FORMAT: Format = Format {
    words: "a table of grains",
    is_it: |beginning| is_of_grains(&header(beginning.line).1),
    numbering: Numbering::Frames,
    holds: |path| {
        let moments = read_moments(path)?;
        let begins = moments.first().map(|first| first.snapshot.step);
        Ok(if moments.iter().all(|moment| moment.is_keyed) { FileContent::Course(begins) } else { FileContent::Moment })
    },
    open: |path, most_rows| {
        let moments = read_moments(path)?;
        let most = moments.iter().map(|moment| moment.snapshot.rows()).max().unwrap_or_default();
        check_grains(&path.to_string_lossy(), most, most_rows)?;
        Ok(indexed(path, move |place| Ok(moments.get(place).map(|moment| moment.snapshot.clone()))))
    },
};

/// Suffixes of ParaView for the components of a vector, in a table of one moment and in a table of all moments.
const COMPONENTS: [[&str; 3]; 2] = [[":0", ":1", ":2"], ["_X", "_Y", "_Z"]];

/// Name of the vector of positions in ParaView.
const POINTS: &str = "points";

/// Returns true if columns of these names belong to grains: they include ids and coordinates x and y.
fn is_of_grains(names: &[&str]) -> bool {
    let names: Vec<String> = names.iter().map(|name| column_name(name)).collect();
    let has = |name: &str| names.iter().any(|other| other == name);
    let is_of_points = names.iter().any(|name| name.eq_ignore_ascii_case("point id"));
    has("x") && has("y") && (has("id") || is_of_points)
}

/// Returns the name that a column of a table has in a dump.
fn column_name(name: &str) -> String {
    for suffixes in COMPONENTS {
        let Some((vector, axis)) =
            (0..3).find_map(|axis| Some((name.strip_suffix(suffixes[axis]).filter(|name| !name.is_empty())?, axis)))
        else {
            continue;
        };
        if vector.eq_ignore_ascii_case(POINTS) {
            return ["x", "y", "z"][axis].to_owned();
        }
        return component(vector, axis);
    }
    if is_id(name) { "id".to_owned() } else { name.to_owned() }
}

/// Snapshot of the grains at one moment.
struct Moment {
    /// True if the table has columns with steps, frame numbers or times.
    is_keyed: bool,
    snapshot: DumpSnapshot,
}

/// Indices of the columns with steps, frames and times.
struct Keys {
    step: Option<usize>,
    frame: Option<usize>,
    time: Option<usize>,
}

impl Keys {
    fn from_table(table: &Table) -> Self {
        let column = |names: &[&str]| names.iter().find_map(|name| table.column(name));
        Self { step: column(&["step"]), frame: column(&["TimeStep"]), time: column(&["Time", "time", "t", "time (s)"]) }
    }

    /// Returns the step or frame number and the time of a row. Rows of one moment have equal results.
    fn of_row(&self, row: &[f64]) -> [Option<f64>; 2] {
        [self.step.or(self.frame), self.time].map(|at| at.map(|at| row[at]))
    }
}

/// Reads the moments of the table at a path.
///
/// # Errors
/// If the file cannot be read, has two columns of the same meaning, or if a step, frame number or time decreases.
fn read_moments(path: &Path) -> Result<Vec<Moment>, ReadError> {
    let name = path.to_string_lossy();
    let mut table = read_table(path)?;
    let keys = Keys::from_table(&table);
    rename_columns(&name, &mut table)?;
    let mut moments: Vec<Moment> = Vec::new();
    let mut row = 0;
    while row < table.rows() {
        let key = keys.of_row(table.row(row));
        let rows = (row..table.rows()).take_while(|&other| keys.of_row(table.row(other)) == key).count();
        let line = row as u64 + 2;
        let before = row.checked_sub(1).map(|last| keys.of_row(table.row(last)));
        if let Some([number, time]) = before.filter(|before| goes_back(*before, key)) {
            let expected = format!("a time after {:?}", time.or(number).unwrap_or_default());
            return Err(ReadError::at(&name, line, expected, format!("{:?}", key[1].or(key[0]).unwrap_or_default())));
        }
        let step = match key[0] {
            Some(step) if step >= 0.0 && step.fract() == 0.0 => step as u64,
            Some(step) => {
                return Err(ReadError::at(&name, line, "a step, a whole number of 0 or more", step.to_string()));
            }
            None => moments.len() as u64,
        };
        moments.push(Moment {
            is_keyed: key != [None; 2],
            snapshot: DumpSnapshot {
                step,
                numbering: if keys.step.is_some() { Numbering::Steps } else { Numbering::Frames },
                time: key[1],
                table: table.part(row, rows),
                first_line: line,
                ..DumpSnapshot::default()
            },
        });
        row += rows;
    }
    Ok(moments)
}

fn goes_back(before: [Option<f64>; 2], key: [Option<f64>; 2]) -> bool {
    before.into_iter().zip(key).any(|pair| matches!(pair, (Some(before), Some(now)) if now < before))
}

/// Renames the columns of a table as in dumps.
fn rename_columns(file: &str, table: &mut Table) -> Result<(), ReadError> {
    for at in 0..table.columns.len() {
        let name = column_name(&table.columns[at].name);
        if table.columns[..at].iter().any(|other| other.name == name) {
            let expected = format!("one column for `{name}`");
            return Err(ReadError::at(file, 1, expected, format!("`{}` as a second column", table.columns[at].name)));
        }
        table.columns[at].name = name;
    }
    Ok(())
}
