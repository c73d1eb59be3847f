//! The stored series of what a program prints while it runs.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::fields::Fields;
use crate::line_reader::LineReader;
use crate::read_error::{ReadError, quoted};

/// The first line of a stored series.
const HEADER: &str = "step,time,kinetic_energy,mean_contacts";

/// What a program printed about one step, in the units of its run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermoRow {
    /// The step, counted from 0.
    pub step: u64,
    /// The time of this step.
    pub time: f64,
    /// Translational kinetic energy ½ Σ m v², of the velocities at this step (not half a step earlier).
    pub kinetic_energy: f64,
    /// Contacts with other grains, averaged over the grains; those with walls are not counted.
    pub mean_contacts: f64,
}

/// Reads the series at `path`; see [`parse_thermo`].
///
/// # Errors
/// The file cannot be read, or is not such a series.
pub fn read_thermo(path: &Path) -> Result<Vec<ThermoRow>, ReadError> {
    let name = path.to_string_lossy();
    let file = File::open(path).map_err(|error| ReadError::opening(&name, error))?;
    parse_thermo(BufReader::new(file), &name)
}

/// Reads a series: the line `step,time,kinetic_energy,mean_contacts`, then a line a row; `name` is what errors call it.
///
/// # Errors
/// The input cannot be read, has another header, has no row, or has a row whose fields are missing, not finite or
/// negative, or whose step or time does not follow the one in front of it.
pub fn parse_thermo(reader: impl BufRead, name: &str) -> Result<Vec<ThermoRow>, ReadError> {
    let mut lines = LineReader::new(reader, name)?;
    let expected = format!("the header `{HEADER}`");
    match lines.next_line()? {
        Some(line) if line.text.trim_end() == HEADER => {}
        Some(line) => return Err(line.error(expected, quoted(line.text))),
        None => return Err(lines.error_at_end(expected, "an empty file")),
    }
    let mut rows: Vec<ThermoRow> = Vec::new();
    while let Some(line) = lines.next_line()? {
        let mut fields = Fields::between_commas(line);
        let row = ThermoRow {
            step: fields.whole("a step, a whole number", 0)?,
            time: fields.not_negative("a time, a finite number from 0 on")?,
            kinetic_energy: fields.not_negative("a kinetic energy, a finite number from 0 on")?,
            mean_contacts: fields.not_negative("a number of contacts, a finite number from 0 on")?,
        };
        fields.end(HEADER)?;
        if let Some(last) = rows.last()
            && (row.step <= last.step || row.time <= last.time)
        {
            let expected = format!("a step and a time after {} and {:?}", last.step, last.time);
            return Err(line.error(expected, format!("{} and {:?}", row.step, row.time)));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(lines.error_at_end("at least one row below the header", "none"));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> String {
        match parse_thermo(text.as_bytes(), "t.csv") {
            Ok(rows) => format!("{} rows", rows.len()),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn reads_rows() {
        let text = format!("{HEADER}\n0,0,0.5,4\n100,0.01,79.25,4.5\n");
        let rows = parse_thermo(text.as_bytes(), "t.csv").unwrap();
        assert_eq!(rows.last(), Some(&ThermoRow { step: 100, time: 0.01, kinetic_energy: 79.25, mean_contacts: 4.5 }));
    }

    #[test]
    fn names_the_place_of_a_fault() {
        assert_eq!(fault(""), format!("t.csv:1: expected the header `{HEADER}`, found an empty file"));
        assert_eq!(fault("a,b\n"), format!("t.csv:1: expected the header `{HEADER}`, found `a,b`"));
        assert_eq!(fault(&format!("{HEADER}\n")), "t.csv:1: expected at least one row below the header, found none");
        assert_eq!(
            fault(&format!("{HEADER}\n0,0,nan,4\n")),
            "t.csv:2:5: expected a kinetic energy, a finite number from 0 on, found `nan`"
        );
        assert_eq!(
            fault(&format!("{HEADER}\n0,0,1\n")),
            "t.csv:2:6: expected a number of contacts, a finite number from 0 on, found the end of the line"
        );
        assert_eq!(
            fault(&format!("{HEADER}\n0,0,1,4,9\n")),
            format!("t.csv:2:9: expected {HEADER}, found one more field, `9`")
        );
        assert_eq!(
            fault(&format!("{HEADER}\n5,1,1,4\n5,2,1,4\n")),
            "t.csv:3: expected a step and a time after 5 and 1.0, found 5 and 2.0"
        );
    }
}
