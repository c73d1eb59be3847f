//! Dumps of LAMMPS and LIGGGHTS.

use crate::read::dump::DumpReader;
use crate::read::format::{FileContent, Format};
use crate::read::lines::Lines;
use crate::read::snapshot::{DumpSnapshot, Numbering};
use std::path::Path;

pub(crate) static FORMAT: Format = Format {
    words: "a dump",
    is_it: |beginning| beginning.line.starts_with("ITEM:"),
    numbering: Numbering::Steps,
    holds: |path| Ok(FileContent::Course(first_step(path))),
    open: |path, most_rows| {
        let mut reader = DumpReader::open(path)?.at_most(most_rows);
        Ok(Box::new(move |snapshot: &mut DumpSnapshot| reader.read(snapshot)))
    },
};

/// Returns the first step, or `None` if it cannot be read. The reader of the dump then reports the error.
fn first_step(path: &Path) -> Option<u64> {
    /// Maximum number of lines up to and including the step. Units and time may precede it.
    const MOST_LINES: usize = 8;
    let mut lines = Lines::open(path).ok()?;
    let mut is_next = false;
    for _ in 0..MOST_LINES {
        let line = lines.next_text().ok()??;
        if is_next {
            return line.text.trim().parse().ok();
        }
        is_next = line.text.trim() == "ITEM: TIMESTEP";
    }
    None
}
