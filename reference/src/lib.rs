//! What other programs left behind: readers for the files of LAMMPS and LIGGGHTS, and the stored reference runs.
//!
//! Everything a file can hold is either read or refused with an error that names the file, the place, what was
//! expected there and what was found. Nothing here panics on an input, however damaged.

/// The folder of this crate: literature, prototypes, stored runs and estimated uncertainties lie in it.
pub const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

mod clock;
pub mod comparison;
mod deadline;
pub mod deck;
pub mod grain_dump;
pub mod live;
pub mod observer;
pub mod outputs;
pub mod outside;
mod pair_forces;
mod process;
mod read;
pub mod round_robin;
mod run_files;
pub mod stored;

pub use read::atom::Atom;
pub use read::data_file::{DataFile, parse_data, read_data_file};
pub use read::digits::Digits;
pub use read::dump::DumpReader;
pub use read::log::{Log, LoggedRun, LoopTime, parse_log, read_log};
pub use read::numbers::{NotFinite, NumberColumn};
pub use read::read_error::ReadError;
pub use read::snapshot::{Coordinate, DumpKind, DumpSnapshot, Numbering};
pub use read::table::{Table, parse_table, read_table};
