//! A whole record as JSON.

use std::io::{self, Write};

use grainbench_scene::record::Record;

/// Writes the record, indented; numbers read back to the same bits.
///
/// # Errors
/// When `out` refuses.
pub fn write(record: &Record, mut out: impl Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut out, record)?;
    out.write_all(b"\n")
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
    }
}
