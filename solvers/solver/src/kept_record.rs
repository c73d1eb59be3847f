//! Stored records of finished runs, which only this program reads. A file contains the line `grainbench record
//! <format>`, length and hash (see `sealed`), a name, and a [`Record`] in postcard's format, which keeps every bit of a
//! number.

use crate::record::Record;
use grainbench_scene::sealed;

const MAGIC: &[u8] = b"grainbench record ";
/// Format that this program writes. It must be increased whenever the meaning or the position of stored data changes.
const FORMAT: u32 = 1;

/// Returns the bytes of a file with a record and its name.
///
/// # Errors
/// When the record cannot be serialised. Records of solvers always can.
pub fn to_bytes(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    Ok(sealed::seal(MAGIC, FORMAT, &body(name, record)?))
}

/// Returns the bytes of the file without header and hash. Two records of the same name are equal bit for bit if these
/// bytes are equal.
///
/// # Errors
/// When the record cannot be serialised.
pub fn body(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    postcard::to_allocvec(&(name, record)).map_err(|error| error.to_string())
}

/// Reads the record from the bytes of a file; `None` if the bytes are damaged, or have another format or another name.
#[must_use]
pub fn from_bytes(name: &str, bytes: &[u8]) -> Option<Record> {
    let body = sealed::open(MAGIC, FORMAT, bytes).ok()?;
    let (found, record): (String, Record) = postcard::from_bytes(body).ok()?;
    (found == name).then_some(record)
}
