//! What other programs left behind: readers for the files of LAMMPS and LIGGGHTS, and the stored reference runs.
//!
//! Everything a file can hold is either read or refused with an error that names the file, the place, what was
//! expected there and what was found. Nothing here panics on an input, however damaged.

mod atom;
mod blocks;
pub mod comparison;
mod contacts;
mod data_file;
mod data_header;
mod data_parser;
pub mod deck;
mod decoding;
mod digits;
mod dump;
mod dump_header;
mod fields;
mod line_reader;
pub mod live;
mod log;
mod numbers;
pub mod observer;
pub mod outputs;
mod pair_forces;
mod read_error;
mod snapshot;
pub mod stored;
mod table;

pub use atom::Atom;
pub use data_file::{DataFile, parse_data, read_data_file};
pub use digits::Digits;
pub use dump::DumpReader;
pub use log::{Log, LoggedRun, LoopTime, parse_log, read_log};
pub use numbers::{NotFinite, NumberColumn};
pub use read_error::ReadError;
pub use snapshot::{Coordinate, DumpKind, DumpSnapshot};
pub use table::{Table, parse_table, read_table};
