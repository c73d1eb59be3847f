//! Records of finished runs, kept to be read back by this program: the line `grainbench record <format>`, length and hash (see
//! `sealed`), and the name that it is kept under with the [`Record`] in postcard's format, which keeps every bit of a number.

use crate::record::Record;
use crate::sealed;
use serde::{Deserialize, Serialize};

const MAGIC: &[u8] = b"grainbench record ";
/// To be raised whenever anything that is stored changes its meaning or its place.
const FORMAT: u32 = 1;

#[derive(Serialize)]
struct Written<'a> {
    name: &'a str,
    record: &'a Record,
}

#[derive(Deserialize)]
struct Read {
    name: String,
    record: Record,
}

/// The bytes of a record under a name.
///
/// # Errors
/// When it has no such form, which no record of a solver has.
pub fn to_bytes(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    Ok(sealed::seal(MAGIC, FORMAT, &body(name, record)?))
}

/// The bytes without what tells that they are whole: two records of one name are the same bit by bit where these are.
///
/// # Errors
/// As for [`to_bytes`].
pub fn body(name: &str, record: &Record) -> Result<Vec<u8>, String> {
    postcard::to_allocvec(&Written { name, record }).map_err(|error| error.to_string())
}

/// The record that bytes hold under this name; none where they are damaged, of another format, or hold that of another.
#[must_use]
pub fn from_bytes(name: &str, bytes: &[u8]) -> Option<Record> {
    let body = sealed::open(MAGIC, FORMAT, bytes).ok()?;
    let read: Read = postcard::from_bytes(body).ok()?;
    (read.name == name).then_some(read.record)
}
