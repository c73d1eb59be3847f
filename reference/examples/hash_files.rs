//! Prints `"NAME" = "BLAKE3"` for each file named on the command line, as `provenance.toml` of a stored run lists it.

use std::io;
use std::path::PathBuf;

use grainbench_reference::hash_file;

fn main() -> io::Result<()> {
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let hash =
            hash_file(&path).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        println!("{name:?} = {hash:?}");
    }
    Ok(())
}
