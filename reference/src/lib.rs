//! Readers for files of LAMMPS, LIGGGHTS and other programs, input decks for these programs, and stored reference runs.
//!
//! Content of a file is either read or refused. The error names the file and the position, and states the expected and
//! the actual content. No input causes a panic, even if it is damaged.

mod clock;
pub mod comparison;
mod contacts;
pub mod data;
pub mod deck;
mod execution;
pub mod grain_dump;
pub mod live;
pub mod names;
pub mod observer;
pub mod outputs;
pub mod outside;
mod read;
pub mod round_robin;
pub mod stored;

pub use execution::process::{end_programs_at, has_ended_programs};
pub use outputs::read_start;
pub use read::data_file::{Atom, DataFile, parse_data, read_data_file};
pub use read::digits::Digits;
pub use read::format::dump::DumpReader;
pub use read::log::{Log, LoggedRun, LoopTime, parse_log};
pub use read::number_table::{NumberColumn, Table, parse_table};
pub use read::read_error::ReadError;
pub use read::snapshot::{Coordinate, DumpKind, DumpSnapshot, Numbering};
pub use read::table::read_table;
