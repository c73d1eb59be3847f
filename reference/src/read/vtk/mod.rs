//! Points with their data from VTK files. Legacy files (`.vtk`) and XML files (`.vtp`, `.vtu`) may be text or binary.
//! HDF5 files have the ending `.vtkhdf`.
//!
//! Source: "VTK File Formats" of the VTK documentation, up to version 5.1 of the legacy format and version 2.2 of the
//! XML format.

pub(crate) mod bytes;
mod legacy;
pub(crate) mod points;
mod xml;

use super::decoding::decoded;
use super::lines::opened;
use super::read_error::ReadError;
use super::snapshot::DumpSnapshot;
use bytes::Bytes;
use std::io::Read;
use std::path::Path;

/// Maximum size of a file after decompression (B).
const MOST: u64 = 1 << 30;

/// First bytes of a legacy file.
const LEGACY: &[u8] = b"# vtk DataFile";

/// Returns true if the first bytes belong to a collection of VTK files with their times, false for a VTK file with points
/// at one moment, or `None` for another file.
pub(crate) fn is_collection(head: &[u8]) -> Option<bool> {
    if head.starts_with(LEGACY) {
        return Some(false);
    }
    let text = String::from_utf8_lossy(head);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let is_xml = text.starts_with("<?xml") || text.starts_with("<VTKFile");
    if !is_xml || !text.contains("<VTKFile") {
        return None;
    }
    Some(text.contains("type=\"Collection\"") || text.contains("type='Collection'"))
}

/// Reads the points of a file as a snapshot of grains. The file may be plain, gzip or zstd.
///
/// Arrays with one number per point keep their names. Vectors become columns `NAME_x`, `NAME_y` and `NAME_z`.
/// Velocities and spins with known names become columns such as `vx` and `omegax`.
///
/// # Errors
/// If the file cannot be read, is truncated or is not a VTK file with points.
pub(crate) fn read_points(path: &Path) -> Result<DumpSnapshot, ReadError> {
    parse(&path.to_string_lossy(), &whole(path)?)
}

fn parse(name: &str, bytes: &[u8]) -> Result<DumpSnapshot, ReadError> {
    let bytes = Bytes::new(name, bytes);
    let points = if bytes.all().starts_with(LEGACY) { legacy::read(bytes)? } else { xml::read(bytes)? };
    points.snapshot(name)
}

/// Reads all bytes of a file and decompresses them.
pub(crate) fn whole(path: &Path) -> Result<Vec<u8>, ReadError> {
    let name = path.to_string_lossy();
    let reader = decoded(opened(path)?).map_err(|error| ReadError::reading(&name, 1, error))?;
    let reader = reader.map_err(|found| ReadError::at(&name, 1, "a plain file, gzip or zstd", found))?;
    let mut bytes = Vec::new();
    reader.take(MOST + 1).read_to_end(&mut bytes).map_err(|error| ReadError::reading(&name, 1, error))?;
    if bytes.len() as u64 > MOST {
        return Err(ReadError::at(&name, 1, format!("at most {MOST} bytes"), "more"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
