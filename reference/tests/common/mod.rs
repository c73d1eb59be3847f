//! What tests of the readers share.

use std::path::{Path, PathBuf};

/// A stored file.
pub(crate) fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}
