//! A whole record as JSON.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use grainbench_scene::record::Record;

use crate::store::{LoadError, parse};

/// Name of the file.
pub const RECORD_FILE: &str = "record.json";

/// Writes the record on one line, for it may hold millions of numbers; they read back to the same bits.
///
/// # Errors
/// When `out` refuses.
pub fn write(record: &Record, mut out: impl Write) -> io::Result<()> {
    serde_json::to_writer(&mut out, record)?;
    out.write_all(b"\n")
}

/// Reads the record that a simulation left in `dir`.
///
/// # Errors
/// When the file is missing or damaged; the message names the place.
pub fn load(dir: &Path) -> Result<Record, LoadError> {
    let path = dir.join(RECORD_FILE);
    match fs::read_to_string(&path) {
        Ok(text) => parse(&path, &text),
        Err(source) => Err(LoadError::Read { path, source }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn reads_back_the_same() {
        let record = sample::record();
        let mut out = Vec::new();
        write(&record, &mut out).unwrap();
        assert_eq!(serde_json::from_slice::<Record>(&out).unwrap(), record);
        assert_eq!(out.iter().filter(|&&letter| letter == b'\n').count(), 1);
    }
}
