//! Tables of grains from ParaView, pandas or any other program, as text or Parquet. Each row is one grain at one moment.
//! Rows with the same step or time form a snapshot. Columns have the names used in dumps or in ParaView.

use crate::read::format::{FileContent, Format, check_grains, indexed};
use crate::read::number_table::{Table, header};
use crate::read::read_error::ReadError;
use crate::read::snapshot::{DumpSnapshot, Numbering};
use crate::read::table::{MARK, parquet_names, read_table};
use crate::read::vtk::{component, is_id};
use std::path::Path;

pub(crate) static FORMAT: Format = Format {
    words: "a table of grains",
    is_it: |beginning| {
        if !beginning.bytes.starts_with(MARK) {
            return is_of_grains(&header(beginning.line).1);
        }
        let names = parquet_names(beginning.path);
        is_of_grains(&names.iter().map(String::as_str).collect::<Vec<_>>())
    },
    numbering: Numbering::Frames,
    holds: |path| {
        let (snapshots, is_keyed) = read_snapshots(path)?;
        let begins = snapshots.first().map(|first| first.step);
        Ok(if is_keyed { FileContent::Course(begins) } else { FileContent::Moment })
    },
    open: |path, most_rows| {
        let (snapshots, _) = read_snapshots(path)?;
        let most = snapshots.iter().map(|snapshot| snapshot.rows()).max().unwrap_or_default();
        check_grains(&path.to_string_lossy(), most, most_rows)?;
        Ok(indexed(path, move |place| Ok(snapshots.get(place).cloned())))
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

/// Reads the snapshots of the table at a path. Also returns true if the table has columns with steps, frame numbers or
/// times.
///
/// # Errors
/// If the file cannot be read, has two columns of the same meaning, or if a step, frame number or time decreases.
fn read_snapshots(path: &Path) -> Result<(Vec<DumpSnapshot>, bool), ReadError> {
    let name = path.to_string_lossy();
    let mut table = read_table(path)?;
    let column = |names: &[&str]| names.iter().find_map(|name| table.column(name));
    let (steps, frames) = (column(&["step"]), column(&["TimeStep"]));
    let times = column(&["Time", "time", "t", "time (s)"]);
    rename_columns(&name, &mut table)?;
    // Step or frame number, and time of a row. Rows of one moment have equal keys.
    let key_of = |row: usize| [steps.or(frames), times].map(|at| at.map(|at| table.row(row)[at]));
    let mut snapshots = Vec::new();
    let mut row = 0;
    while row < table.rows() {
        let key = key_of(row);
        let rows = (row..table.rows()).take_while(|&other| key_of(other) == key).count();
        let line = row as u64 + 2;
        let before = row.checked_sub(1).map(key_of);
        let goes_back = |pair: (Option<f64>, Option<f64>)| matches!(pair, (Some(before), Some(now)) if now < before);
        if let Some([number, time]) = before.filter(|before| before.iter().copied().zip(key).any(goes_back)) {
            let expected = format!("a time after {:?}", time.or(number).unwrap_or_default());
            return Err(ReadError::at(&name, line, expected, format!("{:?}", key[1].or(key[0]).unwrap_or_default())));
        }
        let step = match key[0] {
            Some(step) if step >= 0.0 && step.fract() == 0.0 => step as u64,
            Some(step) => {
                return Err(ReadError::at(&name, line, "a step, a whole number of 0 or more", step.to_string()));
            }
            None => snapshots.len() as u64,
        };
        snapshots.push(DumpSnapshot {
            step,
            numbering: if steps.is_some() { Numbering::Steps } else { Numbering::Frames },
            time: key[1],
            table: table.part(row, rows),
            first_line: line,
            ..DumpSnapshot::default()
        });
        row += rows;
    }
    Ok((snapshots, steps.or(frames).or(times).is_some()))
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
