//! Header of a snapshot in a dump.

use crate::read::fields::Fields;
use crate::read::lines::{Line, Lines};
use crate::read::number_table::NumberColumn;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot};

/// Maximum number of rows in a snapshot. More rows would not fit in memory, and the limit prevents an overflow of line
/// numbers.
const MOST_ROWS: u64 = u32::MAX as u64;

/// Header of one snapshot.
#[derive(Default)]
pub(crate) struct DumpHeader {
    /// Snapshot without rows.
    pub(crate) snapshot: DumpSnapshot,
    /// Line number of the step; 0 before the step has been read.
    pub(crate) step_line: u64,
    /// Line number of the unit system.
    pub(crate) units_line: u64,
    pub(crate) rows: u64,
    /// Word for a row, such as `ATOMS`; empty before the number of rows has been read.
    row_word: String,
    has_bounds: bool,
}

impl DumpHeader {
    /// Reads the items of a header up to the item with the column names. Returns `None` at the end of the file.
    pub(crate) fn read(lines: &mut Lines<'_>) -> Result<Option<Self>, ReadError> {
        let mut header = Self::default();
        let mut any = false;
        loop {
            let Some(line) = lines.next_text()? else {
                return if any { Err(missing(lines, "the rest of the header")) } else { Ok(None) };
            };
            let text = line.text.trim_end();
            if text.is_empty() && !any {
                continue;
            }
            any = true;
            let Some(item) = text.strip_prefix("ITEM: ") else {
                return Err(not_an_item(line, text));
            };
            match item.split_whitespace().collect::<Vec<_>>()[..] {
                ["TIMESTEP"] => {
                    let what = "a step, a whole number";
                    header.snapshot.step = one(lines, what, |fields| fields.whole(what, 0..))?;
                    header.step_line = lines.number();
                }
                ["TIME"] => {
                    let time = one(lines, "the time", |fields| fields.finite("a time, a finite number"))?;
                    header.snapshot.time = Some(time);
                }
                ["UNITS"] => header.read_units(lines)?,
                ["NUMBER", "OF", word] => {
                    header.row_word = word.to_owned();
                    let what = format!("a number of rows of at most {MOST_ROWS}");
                    header.rows = one(lines, &what, |fields| fields.whole(&what, 0..=MOST_ROWS))?;
                }
                ["BOX", "BOUNDS", ref words @ ..] => {
                    let (periodic, is_tilted) = boundaries(line, words)?;
                    header.snapshot.periodic = periodic;
                    header.read_bounds(lines, is_tilted)?;
                }
                [word, ref columns @ ..] if word == header.row_word => {
                    header.finish(line, word, columns)?;
                    return Ok(Some(header));
                }
                _ => return Err(header.unknown(line, item)),
            }
        }
    }

    fn read_units(&mut self, lines: &mut Lines<'_>) -> Result<(), ReadError> {
        let Some(line) = lines.next_text()? else { return Err(missing(lines, "the name of a unit system")) };
        let word = line.text.trim();
        if word.is_empty() || word.contains(char::is_whitespace) {
            return Err(line.error("the name of a unit system", quoted(word)));
        }
        (self.snapshot.units, self.units_line) = (Some(word.to_owned()), line.number);
        Ok(())
    }

    fn read_bounds(&mut self, lines: &mut Lines<'_>, is_tilted: bool) -> Result<(), ReadError> {
        let DumpSnapshot { bounds: (low, high), tilt, .. } = &mut self.snapshot;
        for axis in 0..3 {
            let numbers = if is_tilted { "two numbers and a tilt" } else { "two numbers" };
            let what = format!("the bounds of the box along {}, {numbers}", ["x", "y", "z"][axis]);
            [low[axis], high[axis], tilt[axis]] = one(lines, &what, |fields| {
                let tilt = |fields: &mut Fields<'_>| if is_tilted { fields.finite(&what) } else { Ok(0.0) };
                Ok([fields.finite(&what)?, fields.finite(&what)?, tilt(fields)?])
            })?;
            if low[axis] > high[axis] {
                let expected = "a lower bound that is not above the upper bound";
                return Err(lines.error(expected, format!("{:?}", low[axis])));
            }
        }
        self.has_bounds = true;
        Ok(())
    }

    /// Checks that the header is complete, and adds the columns.
    fn finish(&mut self, line: Line<'_>, word: &str, columns: &[&str]) -> Result<(), ReadError> {
        let items = [(self.step_line > 0, "TIMESTEP"), (self.has_bounds, "BOX BOUNDS")];
        if let Some((_, what)) = items.into_iter().find(|(is_there, _)| !is_there) {
            return Err(line.error(format!("`ITEM: {what}` before the columns"), "none"));
        }
        if columns.is_empty() {
            return Err(line.error(format!("names of columns after `ITEM: {word}`"), "none"));
        }
        for (place, name) in columns.iter().enumerate() {
            if columns[..place].contains(name) {
                return Err(
                    line.error("columns with different names", format!("two columns with the name {}", quoted(name)))
                );
            }
        }
        self.snapshot.kind = if word == "ATOMS" { DumpKind::Atoms } else { DumpKind::Entries };
        self.snapshot.table.columns = columns.iter().map(|name| NumberColumn::new(name)).collect();
        Ok(())
    }

    fn unknown(&self, line: Line<'_>, item: &str) -> ReadError {
        let word = &self.row_word;
        let columns = if word.is_empty() { String::new() } else { format!(" or `{word} COLUMN…`") };
        let expected = format!(
            "`ITEM: ` with `TIMESTEP`, `TIME`, `UNITS`, `NUMBER OF ATOMS`, `NUMBER OF ENTRIES`, `BOX BOUNDS …`{columns}"
        );
        line.error(expected, quoted(&format!("ITEM: {item}")))
    }
}

/// Returns the error of a line that is not an item. If the first line of a file is a single number, the error reports
/// an .xyz file.
fn not_an_item(line: Line<'_>, text: &str) -> ReadError {
    if line.number == 1 && text.trim().parse::<u64>().is_ok() {
        let expected = "a dump with ids and times, such as `dump … custom … id type x y z vx vy vz` writes";
        return line.error(expected, "an .xyz file, which has neither ids nor times");
    }
    line.error("a line `ITEM: …`", quoted(text))
}

/// Returns the periodic axes from the words after `BOX BOUNDS`, and true if the box is tilted. Without words for
/// boundaries, as in old files, no axis is periodic.
fn boundaries(line: Line<'_>, words: &[&str]) -> Result<([bool; 3], bool), ReadError> {
    let known = |word: &&str| word.len() == 2 && word.bytes().all(|byte| b"pfsm".contains(&byte));
    match *words {
        [] => Ok(([false; 3], false)),
        ["xy", "xz", "yz"] => Ok(([false; 3], true)),
        ["xy", "xz", "yz", x, y, z] if [x, y, z].iter().all(known) => Ok(([x, y, z].map(|word| word == "pp"), true)),
        [x, y, z] if [x, y, z].iter().all(known) => Ok(([x, y, z].map(|word| word == "pp"), false)),
        ["abc", "origin", ..] => {
            let found = format!("{}, a general triclinic box", quoted(&words.join(" ")));
            Err(line.error("a box with right angles, or a box with the tilts `xy xz yz`", found))
        }
        _ => Err(line.error("three boundaries such as `pp ff ff` after `BOX BOUNDS`", quoted(&words.join(" ")))),
    }
}

/// Reads the value of an item that consists of one line.
fn one<T>(
    lines: &mut Lines<'_>,
    what: &str,
    read: impl FnOnce(&mut Fields<'_>) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let Some(line) = lines.next_text()? else { return Err(missing(lines, what)) };
    let mut fields = Fields::new(line, line.text);
    let value = read(&mut fields)?;
    fields.end(what)?;
    Ok(value)
}

fn missing(lines: &Lines<'_>, what: &str) -> ReadError {
    lines.error(what, "the end of the file").cut()
}
