//! Header of a data file: numbers of atoms and atom types, and the box.

use crate::read::fields::Fields;
use crate::read::lines::Line;
use crate::read::read_error::{ReadError, quoted};

/// Keywords of the three bounds.
const BOUNDS: [[&str; 2]; 3] = [["xlo", "xhi"], ["ylo", "yhi"], ["zlo", "zhi"]];

/// Values of the header that have been read so far.
#[derive(Default)]
pub(crate) struct DataHeader {
    atoms: Option<u64>,
    types: Option<u32>,
    bounds: [Option<(f64, f64)>; 3],
}

impl DataHeader {
    /// Reads a line of the header. Returns false for a line that begins with a letter, such as the name of a section,
    /// and is no header line.
    pub(crate) fn take(&mut self, line: Line<'_>, content: &str) -> Result<bool, ReadError> {
        let words: Vec<&str> = content.split_whitespace().collect();
        let mut fields = Fields::between_blanks(line, content);
        match words[..] {
            [.., "xy", "xz", "yz"] => {
                return Err(line
                    .error("a box with right angles", "tilt factors `xy xz yz` (triclinic boxes are not supported)"));
            }
            [.., "atoms"] => {
                let count = fields.whole("a number of atoms, 1 or more, before `atoms`", 1)?;
                expect_words(&words, 2, line, "`N atoms`")?;
                once(&mut self.atoms, count, line, "`N atoms`")?;
            }
            [.., "atom", "types"] => {
                let what = "a number of types, 1 or more, before `atom types`";
                let count = fields.whole(what, 1)?;
                expect_words(&words, 3, line, "`N atom types`")?;
                once(&mut self.types, count, line, "`N atom types`")?;
            }
            [.., low, high] if BOUNDS.contains(&[low, high]) => {
                let label = format!("`LOW HIGH {low} {high}`");
                let bound =
                    (fields.finite(&format!("the number {low}"))?, fields.finite(&format!("the number {high}"))?);
                expect_words(&words, 4, line, &label)?;
                if bound.0 >= bound.1 {
                    let found = format!("{:?} and {:?}", bound.0, bound.1);
                    return Err(line.error(format!("{low} below {high}"), found));
                }
                let axis = BOUNDS.iter().position(|names| *names == [low, high]);
                if let Some(place) = axis.and_then(|axis| self.bounds.get_mut(axis)) {
                    once(place, bound, line, &label)?;
                }
            }
            _ if content.trim_start().starts_with(char::is_alphabetic) => return Ok(false),
            _ => {
                let expected =
                    "a header line `N atoms`, `N atom types`, `… xlo xhi`, `… ylo yhi` or `… zlo zhi`, or a section";
                return Err(line.error(expected, quoted(content.trim())));
            }
        }
        Ok(true)
    }

    /// Checks that the header is complete. `missing` creates the error from the expected and the actual content.
    pub(crate) fn complete(&self, missing: impl Fn(String, String) -> ReadError) -> Result<(), ReadError> {
        let absent = |what: &str| {
            let expected = format!("a header line `{what}` before the sections");
            Err(missing(expected, "none".to_owned()))
        };
        if self.atoms.is_none() {
            return absent("N atoms");
        }
        if self.types.is_none() {
            return absent("N atom types");
        }
        for (bound, [low, high]) in self.bounds.iter().zip(BOUNDS) {
            if bound.is_none() {
                return absent(&format!("LOW HIGH {low} {high}"));
            }
        }
        Ok(())
    }

    /// Returns the declared number of atoms, or 0 if it has not been read.
    pub(crate) fn atom_count(&self) -> u64 {
        self.atoms.unwrap_or_default()
    }

    /// Returns the declared number of atom types, or 0 if it has not been read.
    pub(crate) fn type_count(&self) -> u32 {
        self.types.unwrap_or_default()
    }

    /// Returns the lower and the upper corner of the box.
    pub(crate) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let pairs = self.bounds.map(Option::unwrap_or_default);
        (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1))
    }
}

/// Returns an error unless a header line has `count` words. `form` is the expected form of the line.
fn expect_words(words: &[&str], count: usize, line: Line<'_>, form: &str) -> Result<(), ReadError> {
    if words.len() == count {
        return Ok(());
    }
    Err(line.error(form, quoted(&words.join(" "))))
}

/// Stores a value, or returns an error if it is already stored.
fn once<T>(place: &mut Option<T>, value: T, line: Line<'_>, form: &str) -> Result<(), ReadError> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(line.error(format!("one header line {form}"), "a second line of this form")),
    }
}
