//! What other programs left behind: readers for the files of LAMMPS and LIGGGHTS, and the stored reference runs.
//!
//! Everything a file can hold is either read or refused with an error that names the file, the place, what was
//! expected there and what was found. Nothing here panics on an input, however damaged.

mod atom;
mod data_file;
mod data_header;
mod data_parser;
mod decoding;
mod fields;
mod file_hash;
mod line_reader;
mod provenance;
mod read_error;
mod stored;
mod stored_error;
mod thermo;

pub use atom::Atom;
pub use data_file::{DataFile, parse_data, read_data_file};
pub use file_hash::hash_file;
pub use provenance::Provenance;
pub use read_error::ReadError;
pub use stored::StoredRun;
pub use stored_error::StoredError;
pub use thermo::{ThermoRow, parse_thermo, read_thermo};
