//! Data files as `read_data` of LAMMPS and LIGGGHTS takes them and `write_data` leaves them.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::read::atom::Atom;
use crate::read::data_parser::DataParser;
use crate::read::line_reader::LineReader;
use crate::read::read_error::ReadError;

/// A LAMMPS data file of `atom_style sphere`, or a LIGGGHTS one of `atom_style granular`.
#[derive(Debug, Clone, PartialEq)]
pub struct DataFile {
    /// The first line, which the programs ignore.
    pub title: String,
    /// The lower and the upper corner of the box.
    pub bounds: ([f64; 3], [f64; 3]),
    /// The grains, in the order of the file.
    pub atoms: Vec<Atom>,
}

/// Reads the data file at `path`, plain or gzip.
///
/// # Errors
/// The file cannot be read, or is not such a data file; see [`parse_data`].
pub fn read_data_file(path: &Path) -> Result<DataFile, ReadError> {
    let name = path.to_string_lossy();
    let file = File::open(path).map_err(|error| ReadError::opening(&name, error))?;
    parse_data(BufReader::new(file), &name)
}

/// Reads a data file, plain or gzip, from `reader`; `name` is what errors call it.
///
/// The header gives the number of atoms and of atom types and the three bounds of the box, in any order; `Atoms` has
/// lines `id type diameter density x y z` with or without three image counts behind, `Velocities` lines
/// `id vx vy vz wx wy wz`. `Masses`, `Pair Coeffs` and `PairIJ Coeffs` are passed over. A position may lie outside of
/// the box. Comments begin with `#`.
///
/// # Errors
/// The input breaks off, holds something else than text, or says something that is not understood: whatever is not
/// listed above is refused and not passed over, for it could change what the file means.
pub fn parse_data(reader: impl BufRead, name: &str) -> Result<DataFile, ReadError> {
    let mut lines = LineReader::new(reader, name)?;
    let Some(title) = lines.next_line()?.map(|line| line.text.trim().to_owned()) else {
        return Err(lines.error_at_end("a data file, its title first", "an empty file"));
    };
    let mut parser = DataParser::new();
    while let Some(line) = lines.next_line()? {
        parser.take(line)?;
    }
    let missing = |expected, found| lines.error_at_end(expected, found);
    let (bounds, atoms) = parser.finish(missing)?;
    Ok(DataFile { title, bounds, atoms })
}
