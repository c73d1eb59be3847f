//! Points with their arrays from VTK's files: legacy ones (`.vtk`), XML ones (`.vtp`, `.vtu`), as text or binary, and HDF5
//! (`.vtkhdf`).
//!
//! Source: "VTK File Formats" of the VTK documentation, versions to 5.1 of the legacy form and to 2.2 of the XML form.

mod bytes;
mod collection;
mod hdf;
mod legacy;
mod points;
mod xml;

pub(crate) use collection::read_collection;
pub(crate) use hdf::{MARK, has_steps, read_moments};
pub(crate) use points::{component, is_id};

use super::decoding::{Decoded, decoded};
use super::read_error::ReadError;
use super::snapshot::DumpSnapshot;
use bytes::Bytes;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Most bytes of a file, unpacked.
const MOST: u64 = 1 << 30;

/// How a legacy file begins.
const LEGACY: &[u8] = b"# vtk DataFile";

/// What a file is by its first bytes; none where it is none of VTK's.
pub(crate) fn kind(head: &[u8]) -> Option<Kind> {
    if head.starts_with(LEGACY) {
        return Some(Kind::Points);
    }
    let text = String::from_utf8_lossy(head);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let is_xml = text.starts_with("<?xml") || text.starts_with("<VTKFile");
    if !is_xml || !text.contains("<VTKFile") {
        return None;
    }
    let is_collection = text.contains("type=\"Collection\"") || text.contains("type='Collection'");
    Some(if is_collection { Kind::Collection } else { Kind::Points })
}

/// Kinds of VTK's files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Points at one moment.
    Points,
    /// A list of files with their times.
    Collection,
}

/// The points of a file, plain, gzip or zstd, as a snapshot of grains: arrays of one number under their names; vectors as
/// `NAME_x`, `NAME_y`, `NAME_z`, but what is known for a velocity or a spin as `vx` and `omegax`.
///
/// # Errors
/// The file cannot be read, breaks off, or is not such a file.
pub(crate) fn read_points(path: &Path) -> Result<DumpSnapshot, ReadError> {
    parse(&path.to_string_lossy(), &whole(path)?)
}

fn parse(name: &str, bytes: &[u8]) -> Result<DumpSnapshot, ReadError> {
    let bytes = Bytes::new(name, bytes);
    let points = if bytes.all().starts_with(LEGACY) { legacy::read(bytes)? } else { xml::read(bytes)? };
    points.snapshot(name)
}

/// All bytes of a file, unpacked.
fn whole(path: &Path) -> Result<Vec<u8>, ReadError> {
    let name = path.to_string_lossy();
    let file = File::open(path).map_err(|error| ReadError::opening(&name, error))?;
    let reader = match decoded(BufReader::new(file)).map_err(|error| ReadError::reading(&name, 1, error))? {
        Decoded::Text(reader) => reader,
        Decoded::Unreadable(found) => return Err(ReadError::at(&name, 1, "a plain file, gzip or zstd", found)),
    };
    let mut bytes = Vec::new();
    reader.take(MOST + 1).read_to_end(&mut bytes).map_err(|error| ReadError::reading(&name, 1, error))?;
    if bytes.len() as u64 > MOST {
        return Err(ReadError::at(&name, 1, format!("at most {MOST} bytes"), "more"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
