//! Readers for files, one per format. A reader returns the content of a file or an error. The error names the file and
//! the position, and states the expected and the actual content.

mod binary;
pub(crate) mod data_file;
pub(crate) mod decoding;
pub(crate) mod digits;
pub(crate) mod format;
pub(crate) mod lines;
pub(crate) mod log;
pub(crate) mod number_table;
pub(crate) mod read_error;
pub(crate) mod snapshot;
pub(crate) mod table;
pub(crate) mod vtk;
