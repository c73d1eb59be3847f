//! Keys and kinds of stored files, writing of files and directories completely or not at all, locks of directories, and
//! removal of temporary files of ended processes.

pub mod artifact;
pub mod key;
pub mod lock;
pub mod log;
pub mod machine;
mod manifest;
pub mod results;
mod scratch;
mod staged;
mod write;

pub use artifact::ReadError;
pub use manifest::{refuse_mixed, written_files};
pub use scratch::{is_scratch, remove_leftovers, temporary_in};
pub use staged::{StagedDir, refuse_other_programs};
pub use write::{WriteError, parent_of, write_file};
