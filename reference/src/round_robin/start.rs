//! Shared initial state of the drum. An `xyz` file of grains is converted to LAMMPS data files whose origin is the
//! centre of the drum.

use super::atoms::{DENSITY_M1, atoms, coordinates};
use crate::read::lines::Lines;
use crate::read::read_error::{ReadError, quoted};
use std::path::{Path, PathBuf};

/// Centre of the drum in the coordinates of the file (m).
const MIDDLE: [f64; 3] = [0.102, 0.032, 0.102];
/// Maximum number of grains in a file.
const MOST: usize = 1_000_000;

/// Centres of grains relative to the centre of the drum (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Centres of grains of material M2 (type 0) and M1 (type 1).
    pub kinds: [Vec<[f64; 3]>; 2],
}

/// Returns the file of the shared initial state in a folder: the first file in alphabetical order whose name ends in
/// `.xyz`, or `None` if there is none.
///
/// # Errors
/// If the folder cannot be read.
pub fn start_in(folder: &Path) -> std::io::Result<Option<PathBuf>> {
    let entries: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    Ok(entries.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "xyz")).min())
}

/// Reads the initial state. The first line is the number of grains, and the second line is the box. Each further line
/// has the type of a grain, 0 or 1, and its coordinates (m).
///
/// # Errors
/// If the file cannot be read or a line is not valid.
pub fn read_start(path: &Path) -> Result<Start, ReadError> {
    let file = path.to_string_lossy();
    let mut lines = Lines::open(path)?;
    let first = lines.next_text()?.map_or("", |line| line.text.trim()).to_owned();
    let count = first.parse().ok().filter(|count| (1..=MOST).contains(count));
    let count =
        count.ok_or_else(|| ReadError::at(&file, 1, format!("a number of grains up to {MOST}"), quoted(&first)))?;
    lines.next_text()?;
    let mut start = Start::default();
    for row in 0..count {
        let expected = || format!("type (0 or 1), x, y and z, for grain {} of {count}", row + 1);
        let place = row as u64 + 3;
        let line = lines.next_text()?.ok_or_else(|| ReadError::at(&file, place, expected(), "the end of the file"))?;
        let mut fields = line.text.split_whitespace();
        let kind = fields.next().and_then(|kind| ["0", "1"].iter().position(|known| *known == kind));
        let numbers = coordinates(fields);
        match (kind, numbers.as_deref()) {
            (Some(kind), Some(&[x, y, z])) => {
                start.kinds[kind].push([x - MIDDLE[0], y - MIDDLE[1], z - MIDDLE[2]].map(rounded));
            }
            _ => return Err(line.error(expected(), quoted(line.text.trim()))),
        }
    }
    Ok(start)
}

/// Rounds a coordinate to 1e-9 m, which is finer than the file, to remove the rounding error of the subtraction.
fn rounded(at: f64) -> f64 {
    (at * 1e9).round() / 1e9
}

impl Start {
    /// Returns the data files of both types of grains for the scene of the drum, by name and text.
    #[must_use]
    pub fn files(&self) -> [(&'static str, String); 2] {
        let kind_atoms = |kind: usize, diameter, density| atoms(&self.kinds[kind], diameter, density);
        [("drum-m2.data", kind_atoms(0, 0.004, 2000.0)), ("drum-m1.data", kind_atoms(1, 0.002, DENSITY_M1))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Start, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("start.xyz");
        std::fs::write(&path, text).unwrap();
        read_start(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn reads_both_kinds() {
        let start = read("2\nbox\n0 0.102 0.032 0.002\n1 0.202 0.032 0.102\n").unwrap();
        assert_eq!(start.kinds[0].len(), 1);
        assert!((start.kinds[1][0][0] - 0.1).abs() < 1e-12);
        let [_, (_, text)] = start.files();
        assert!(text.contains("\n1 1 0.002 2500 0.1 0 0\n"), "{text}");
    }

    #[test]
    fn refuses_what_is_no_start() {
        for (text, place) in [
            ("", "start.xyz:1:"),
            ("-3\n", "start.xyz:1:"),
            ("99999999999\n", "start.xyz:1:"),
            ("1\nbox\n", "start.xyz:3:"),
            ("1\nbox\n2 0 0 0\n", "start.xyz:3:"),
            ("1\nbox\n1 0 0\n", "start.xyz:3:"),
            ("1\nbox\n1 0 nan 0\n", "start.xyz:3:"),
            ("2\nbox\n1 0 0 0\n1 0 1e9 0\n", "start.xyz:4:"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(place), "{error}");
        }
    }
}
