//! Identification of tables by their columns.

use super::impact::Impact;
use crate::read::read_error::{ReadError, quoted};
use crate::read::table::{Table, read_table};
use std::path::Path;

/// Numbers of grains in the zones of the drum over time. Zone 2 is x < 0, z < 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Drum {
    /// Times (s).
    pub times: Vec<f64>,
    /// Numbers of grains M1 and M2 in zone 1, followed by those in zone 2.
    pub zones: [Vec<f64>; 4],
}

/// Numbers of grains left in the silo over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Silo {
    /// Times (s).
    pub times: Vec<f64>,
    /// Numbers of grains left.
    pub left: Vec<f64>,
}

/// Content of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Time series of the ball with the columns `t` and `CODE_ICn`, or `t,z` for one run.
    Impact(Impact),
    /// Zones of the drum, `t,z1_m1,z1_m2,z2_m1,z2_m2`.
    Drum(Drum),
    /// Grains left in the silo, `t,count`.
    Silo(Silo),
}

/// Table of the published data on the user's machine.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedTable {
    /// Name of the file without its extension.
    pub name: String,
    /// Content of the table.
    pub kind: Kind,
}

/// Columns of the zones of the drum.
const ZONES: [&str; 4] = ["z1_m1", "z1_m2", "z2_m1", "z2_m2"];

/// Reads a table of the round robin. Returns `None` for any other table: if the first column is not `t` or the second
/// column has an unknown name.
///
/// # Errors
/// If the file cannot be read or does not match its columns.
pub fn read(path: &Path) -> Result<Option<PublishedTable>, ReadError> {
    let file = path.to_string_lossy();
    let table = read_table(path)?;
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let kind = match names[..] {
        ["t", "z"] => Kind::Impact(Impact::from_table(&of_one(table, path), &file)?),
        ["t", first, ..] if first.contains("_IC") => Kind::Impact(Impact::from_table(&table, &file)?),
        ["t", first, ..] if ZONES.contains(&first) => Kind::Drum(drum(&table, &names, &file)?),
        ["t", "count"] => {
            let times = rising(&table, &file)?;
            Kind::Silo(Silo { times, left: table.values(1).collect() })
        }
        _ => return Ok(None),
    };
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Some(PublishedTable { name, kind }))
}

/// Names the column of a single run after its file.
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

/// Returns the times. They must increase.
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
    /// Returns the number of grains M1 in zone 2 at a time, or `None` if there is no sample at this time.
    #[must_use]
    pub fn in_zone_2(&self, time: f64) -> Option<f64> {
        self.times.iter().position(|at| (at - time).abs() < 1e-6).map(|at| self.zones[2][at])
    }
}

impl Silo {
    /// Returns the number of grains left at a time, interpolated linearly between samples. Returns `None` after the
    /// samples.
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

    /// Returns the number of grains that leave per second between two times.
    #[must_use]
    pub fn rate(&self, [from, to]: [f64; 2]) -> Option<f64> {
        Some((self.at(from)? - self.at(to)?) / (to - from))
    }
}
