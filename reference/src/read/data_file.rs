//! Data files, which `write_data` writes and `read_data` of LAMMPS and LIGGGHTS reads.

use std::io::BufRead;
use std::path::Path;

use crate::read::atom::Atom;
use crate::read::data_parser::DataParser;
use crate::read::lines::{Lines, opened};
use crate::read::read_error::ReadError;

/// LAMMPS data file with `atom_style sphere`, or LIGGGHTS data file with `atom_style granular`.
#[derive(Debug, Clone, PartialEq)]
pub struct DataFile {
    /// First line, which the programs ignore.
    pub title: String,
    /// Lower and upper corner of the box, in the units of the file.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Grains in the order of the file.
    pub atoms: Vec<Atom>,
}

/// Reads the data file at `path`, plain or compressed by gzip or zstd.
///
/// # Errors
/// If the file cannot be read or is not a data file. See [`parse_data`].
pub fn read_data_file(path: &Path) -> Result<DataFile, ReadError> {
    parse_data(opened(path)?, &path.to_string_lossy())
}

/// Reads a data file from `reader`, plain or compressed by gzip or zstd. `name` is the name of the file in error
/// messages.
///
/// The header contains the number of atoms, the number of atom types and the three bounds of the box, in any order.
/// `Atoms` has lines `id type diameter density x y z`, optionally with three image counts at the end. `Velocities`
/// has lines `id vx vy vz wx wy wz`.
///
/// `Masses`, `Pair Coeffs` and `PairIJ Coeffs` are skipped. A position may be outside the box. Comments begin with `#`.
///
/// # Errors
/// If the input is truncated, is not text, or has content other than described above. Other content is never skipped,
/// because it could change the meaning of the file.
pub fn parse_data(reader: impl BufRead, name: &str) -> Result<DataFile, ReadError> {
    let mut lines = Lines::new(reader, name)?;
    let Some(title) = lines.next_text()?.map(|line| line.text.trim().to_owned()) else {
        return Err(lines.error("a data file that begins with a title", "an empty file"));
    };
    let mut parser = DataParser::new();
    while let Some(line) = lines.next_text()? {
        parser.take(line)?;
    }
    let missing = |expected, found| lines.error(expected, found);
    let (bounds, atoms) = parser.finish(missing)?;
    Ok(DataFile { title, bounds, atoms })
}
