//! The fingerprint by which a stored file is recognised.

use std::fs::File;
use std::io;
use std::path::Path;

/// The BLAKE3 hash of the file at `path`, in lower-case hexadecimal.
///
/// # Errors
/// The file cannot be opened or read.
pub fn hash_file(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}
