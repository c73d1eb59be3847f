//! Which table is what: told by its columns.

use super::impact::Impact;
use crate::read::read_error::{ReadError, quoted};
use crate::read::table::{Table, read_table};
use std::path::Path;

/// Counts in the zones of the drum over time: zone 2 is x < 0, z < 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Drum {
    /// Times (s).
    pub times: Vec<f64>,
    /// Grains of M1 and of M2 in zone 1, and in zone 2.
    pub zones: [Vec<f64>; 4],
}

/// Grains left in the silo over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Silo {
    /// Times (s).
    pub times: Vec<f64>,
    /// How many are left.
    pub left: Vec<f64>,
}

/// What a table holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Courses of the ball, `t` and `CODE_ICn`, or `t,z` of one run.
    Impact(Impact),
    /// Zones of the drum, `t,z1_m1,z1_m2,z2_m1,z2_m2`.
    Drum(Drum),
    /// Grains left in the silo, `t,count`.
    Silo(Silo),
}

/// A table of the published data, as the user has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// Name of the file without its ending.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
}

/// Columns of the zones of the drum.
const ZONES: [&str; 4] = ["z1_m1", "z1_m2", "z2_m1", "z2_m2"];

/// Reads a table of the round robin; none where it is a table of something else: its first column is not `t`, or the second is of
/// no known name.
///
/// # Errors
/// The file cannot be read, or is not what its columns say.
pub fn read(path: &Path) -> Result<Option<Published>, ReadError> {
    let file = path.to_string_lossy();
    let table = read_table(path)?;
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let kind = match names[..] {
        ["t", "z"] => Kind::Impact(Impact::of(&of_one(table, path), &file)?),
        ["t", first, ..] if first.contains("_IC") => Kind::Impact(Impact::of(&table, &file)?),
        ["t", first, ..] if ZONES.contains(&first) => Kind::Drum(drum(&table, &names, &file)?),
        ["t", "count"] => {
            let times = rising(&table, &file)?;
            Kind::Silo(Silo { times, left: table.values(1).collect() })
        }
        _ => return Ok(None),
    };
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Some(Published { name, kind }))
}

/// One run, by the name of its file.
fn of_one(mut table: Table, path: &Path) -> Table {
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    table.columns[1].name = format!("{name}_IC1");
    table
}

fn drum(table: &Table, names: &[&str], file: &str) -> Result<Drum, ReadError> {
    let mut zones: [Vec<f64>; 4] = Default::default();
    for (zone, name) in zones.iter_mut().zip(ZONES) {
        let place = table.column(name).ok_or_else(|| {
            ReadError::at(file, 1, format!("columns {} of grains in zones", ZONES.join(", ")), quoted(&names.join(",")))
        })?;
        zone.extend(table.values(place));
    }
    Ok(Drum { times: rising(table, file)?, zones })
}

/// Times, which rise.
fn rising(table: &Table, file: &str) -> Result<Vec<f64>, ReadError> {
    let times: Vec<f64> = table.values(0).collect();
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(row) => {
            let expected = format!("times that rise, in row {} below the names", row + 2);
            Err(ReadError::at(file, row as u64 + 3, expected, format!("{}", times[row + 1])))
        }
        None => Ok(times),
    }
}

impl Drum {
    /// M1 in zone 2 at a time; none where it is no sample.
    #[must_use]
    pub fn in_zone_2(&self, time: f64) -> Option<f64> {
        self.times.iter().position(|at| (at - time).abs() < 1e-6).map(|at| self.zones[2][at])
    }
}

impl Silo {
    /// Grains left at a time, between samples in proportion; none beyond them.
    #[must_use]
    pub fn at(&self, time: f64) -> Option<f64> {
        let after = self.times.iter().position(|&sampled| sampled >= time - 1e-9)?;
        let (next, left) = (self.times[after], self.left[after]);
        if (next - time).abs() < 1e-9 || after == 0 {
            return Some(left);
        }
        let part = (time - self.times[after - 1]) / (next - self.times[after - 1]);
        Some(self.left[after - 1] + part * (left - self.left[after - 1]))
    }

    /// Grains that leave in a second, between two times.
    #[must_use]
    pub fn rate(&self, [from, to]: [f64; 2]) -> Option<f64> {
        Some((self.at(from)? - self.at(to)?) / (to - from))
    }
}
