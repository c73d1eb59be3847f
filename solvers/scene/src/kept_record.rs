//! Stored records of finished runs, which only this program reads. A file holds the line `grainbench record <format>`,
//! length and hash (see `sealed`), a name, and a [`Record`] in postcard's format. This format keeps every bit of a
//! number.

use crate::record::Record;
use crate::sealed;
use serde::{Deserialize, Serialize};

const MAGIC: &[u8] = b"grainbench record ";
/// Format that this program writes. It must be raised whenever stored data change their meaning or their position.
const FORMAT: u32 = 1;

#[derive(Serialize)]
struct BorrowedRecord<'a> {
    name: &'a str,
    record: &'a Record,
}

#[derive(Deserialize)]
struct OwnedRecord {
    name: String,
    record: Record,
}

/// Returns the bytes of a record with its name.
///
/// # Errors
/// When the record cannot be serialised. Records of solvers always can.
pub fn to_bytes(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    Ok(sealed::seal(MAGIC, FORMAT, &body(name, record)?))
}

/// Returns the bytes without header and hash. Two records of one name are equal bit for bit if these bytes are.
///
/// # Errors
/// When the record cannot be serialised.
pub fn body(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    postcard::to_allocvec(&BorrowedRecord { name, record }).map_err(|error| error.to_string())
}

/// Reads the record stored under this name; `None` if the bytes are damaged, of another format or of another name.
#[must_use]
pub fn from_bytes(name: &str, bytes: &[u8]) -> Option<Record> {
    let body = sealed::open(MAGIC, FORMAT, bytes).ok()?;
    let read: OwnedRecord = postcard::from_bytes(body).ok()?;
    (read.name == name).then_some(read.record)
}
