//! Legacy VTK files. Three header lines are followed by sections that begin with keywords. Binary numbers are
//! big-endian.

use super::{Array, Bytes, Points};
use crate::read::binary::Number;
use crate::read::digits::Digits;
use crate::read::read_error::{ReadError, quoted};

/// Reads points and their data.
pub(super) fn read(bytes: Bytes<'_>) -> Result<Points, ReadError> {
    let mut reader = Reader { bytes, is_binary: false };
    reader.header()?;
    reader.body()
}

/// Entities to which the arrays of a section belong.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ArrayEntities {
    /// Whole data set.
    All,
    Points,
    Cells,
}

struct Reader<'b> {
    bytes: Bytes<'b>,
    is_binary: bool,
}

impl<'b> Reader<'b> {
    /// Reads the lines with version and title, and the line with the encoding of numbers.
    fn header(&mut self) -> Result<(), ReadError> {
        let _ = (self.bytes.line(), self.bytes.line());
        self.is_binary = match self.bytes.next_words().as_deref() {
            Some(["ASCII"]) => false,
            Some(["BINARY"]) => true,
            _ => return Err(self.bytes.error("`ASCII` or `BINARY`")),
        };
        self.words();
        Ok(())
    }

    /// Reads the words of the next line that is not blank.
    fn words(&mut self) -> Option<Vec<&'b str>> {
        let words = self.bytes.next_words()?;
        while self.bytes.line()?.iter().all(u8::is_ascii_whitespace) {}
        Some(words)
    }

    fn body(&mut self) -> Result<Points, ReadError> {
        let (mut positions, mut arrays, mut time) = (None, Vec::new(), None);
        let (mut entities_of, mut cells) = (ArrayEntities::All, 0);
        let mut points = 0;
        while let Some(words) = self.bytes.next_words() {
            let here = self.bytes;
            self.words();
            let wrong = |expected: &str| here.error(expected);
            let entities = if entities_of == ArrayEntities::Cells { cells } else { points };
            let color = if self.is_binary { "unsigned_char" } else { "float" };
            // Name, number type and number of components of an array with one row per point or cell.
            let array = match words[..] {
                ["SCALARS", name, kind, ref rest @ ..] => {
                    let components = rest.first().map_or(Ok(1), |count| number(count, &here))?;
                    if matches!(self.bytes.next_words().as_deref(), Some(["LOOKUP_TABLE", _])) {
                        self.words();
                    }
                    Some((name, kind, components))
                }
                ["COLOR_SCALARS", name, components] => Some((name, color, number(components, &here)?)),
                ["VECTORS" | "NORMALS", name, kind] => Some((name, kind, 3)),
                ["TENSORS", name, kind] => Some((name, kind, 9)),
                ["TENSORS6", name, kind] => Some((name, kind, 6)),
                ["TEXTURE_COORDINATES", name, components, kind] => Some((name, kind, number(components, &here)?)),
                _ => None,
            };
            if let Some((name, kind, components)) = array {
                keep(&mut arrays, entities_of, self.array(name, kind, components, entities, &here)?);
                continue;
            }
            match words[..] {
                ["DATASET", "POLYDATA" | "UNSTRUCTURED_GRID"] => {}
                ["DATASET", ..] => return Err(wrong("`DATASET POLYDATA` or `DATASET UNSTRUCTURED_GRID`")),
                ["METADATA"] => while self.bytes.line().is_some_and(|line| !line.trim_ascii().is_empty()) {},
                ["POINTS", count, kind] => {
                    points = number(count, &here)?;
                    positions = Some(self.array("points", kind, 3, points, &here)?);
                }
                ["VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS", count, size] => {
                    cells += self.connectivity(number(count, &here)?, number(size, &here)?, &here)?;
                }
                ["CELL_TYPES", count] => {
                    self.array("types", "int", 1, number(count, &here)?, &here)?;
                }
                ["POINT_DATA", count] => {
                    entities_of = ArrayEntities::Points;
                    if number(count, &here)? != points {
                        return Err(wrong(&format!("`POINT_DATA {points}`, which is the number of points")));
                    }
                }
                ["CELL_DATA", count] => (entities_of, cells) = (ArrayEntities::Cells, number(count, &here)?),
                ["LOOKUP_TABLE", _, count] => {
                    self.array("table", color, 4, number(count, &here)?, &here)?;
                }
                ["FIELD", _, count] => {
                    for _ in 0..number(count, &here)? {
                        let Some(&[name, components, tuples, kind]) = self.bytes.next_words().as_deref() else {
                            return Err(self.bytes.error("the name, components, tuples and type of an array"));
                        };
                        let here = self.bytes;
                        self.words();
                        let (components, tuples) = (number(components, &here)?, number(tuples, &here)?);
                        let array = self.array(name, kind, components, tuples, &here)?;
                        if entities_of == ArrayEntities::All
                            && ["time", "timevalue"].contains(&name.to_lowercase().as_str())
                        {
                            time = array.numbers.first().copied();
                        }
                        keep(&mut arrays, entities_of, array);
                    }
                }
                _ => return Err(wrong("a section of points or of point data")),
            }
        }
        let positions = positions.ok_or_else(|| self.bytes.error("`POINTS`"))?;
        Ok(Points::of_moment(self.bytes.file(), time, positions, arrays))
    }

    /// Skips the connectivity of the cells and returns the number of cells.
    fn connectivity(&mut self, count: usize, size: usize, here: &Bytes<'b>) -> Result<usize, ReadError> {
        let Some(&["OFFSETS", kind]) = self.bytes.next_words().as_deref() else {
            self.array("cells", "int", 1, size, here)?;
            return Ok(count);
        };
        self.words();
        self.array("offsets", kind, 1, count, here)?;
        let Some(&["CONNECTIVITY", kind]) = self.bytes.next_words().as_deref() else {
            return Err(self.bytes.error("`CONNECTIVITY`"));
        };
        self.words();
        self.array("connectivity", kind, 1, size, here)?;
        Ok(count.saturating_sub(1))
    }

    /// Reads the numbers of an array with `tuples` rows. `here` is the position for errors.
    fn array(
        &mut self,
        name: &str,
        kind: &str,
        components: usize,
        tuples: usize,
        here: &Bytes<'b>,
    ) -> Result<Array, ReadError> {
        let kind =
            Number::of_legacy(kind).ok_or_else(|| here.error(format!("a type of numbers, found {}", quoted(kind))))?;
        let count = components.checked_mul(tuples).ok_or_else(|| here.error("a smaller number of values"))?;
        let (numbers, digits) = if self.is_binary {
            let size = count.checked_mul(kind.size()).ok_or_else(|| here.error("a smaller number of values"))?;
            (kind.decode(self.bytes.take(size)?, true), kind.digits(Digits::exact()))
        } else {
            let mut digits = Digits::default();
            let numbers = self.bytes.printed(count, &mut digits)?;
            (numbers, kind.digits(digits))
        };
        Ok(Array { name: name.to_owned(), components, numbers, digits })
    }
}

/// Stores an array if it belongs to points; arrays of cells and of the data set are dropped.
fn keep(arrays: &mut Vec<Array>, entities_of: ArrayEntities, array: Array) {
    if entities_of == ArrayEntities::Points {
        arrays.push(array);
    }
}

fn number(word: &str, here: &Bytes<'_>) -> Result<usize, ReadError> {
    word.parse().map_err(|_| here.error(format!("a whole number for {}", quoted(word))))
}
