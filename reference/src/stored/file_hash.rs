//! Hash that identifies a stored file.

use std::fs::File;
use std::io;
use std::path::Path;

/// Returns the BLAKE3 hash of the file at `path` in lower-case hexadecimal.
///
/// # Errors
/// If the file cannot be opened or read.
pub fn hash_file(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}
