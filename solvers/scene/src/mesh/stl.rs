//! Reader of STL files in text or binary form. It stores the position of each triangle in the file for error messages.

use crate::error::SceneError;
use nalgebra::Vector3;

/// Number of bytes before the first triangle in the binary form.
const HEAD: usize = 84;
/// Number of bytes of a triangle in the binary form.
const EACH: usize = 50;

/// Position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of text, from 1.
    Line(usize),
    /// Byte offset, from 0.
    Byte(usize),
}

impl std::fmt::Display for Place {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(formatter, "line {line}"),
            Self::Byte(byte) => write!(formatter, "byte {byte}"),
        }
    }
}

/// Returns an error in a mesh. Its place follows the name of the file in a message: a line of text, or the number of a
/// triangle in binary form. It is empty for the file as a whole.
pub(super) fn flaw(place: Option<Place>, expected: &str, found: &str) -> SceneError {
    let place = match place {
        Some(Place::Line(line)) => format!(":{line}"),
        Some(Place::Byte(byte)) => format!(": triangle {}", byte.saturating_sub(HEAD) / EACH + 1),
        None => String::new(),
    };
    SceneError::of_file(place, expected, found.to_owned())
}

/// Triangle as stored in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Corners, in the unit of the file.
    pub corners: [Vector3<f64>; 3],
    /// Normal as stored in the file; it may be zero.
    pub normal: Vector3<f64>,
    /// Start of the facet: line number from 1 in text form, byte offset from 0 in binary form.
    pub place: Place,
}

/// Reads the triangles of a file. A file that begins with `solid` may have text or binary form. It is binary if its
/// length agrees with its stored number of triangles, or if it contains a zero byte. Text contains no zero bytes.
///
/// # Errors
/// When the file is empty, is truncated, has additional data, or contains an invalid or infinite number.
pub fn read(bytes: &[u8]) -> Result<Vec<Facet>, SceneError> {
    if bytes.is_empty() {
        return Err(flaw(None, "triangles as STL", "an empty file"));
    }
    let count = bytes.get(80..HEAD).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    let is_whole = count.is_some_and(|count| bytes.len() == HEAD + EACH * count);
    let first = bytes.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(0);
    let says_solid = bytes[first..].get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let facets = if !is_whole && says_solid && !bytes.contains(&0) { ascii(bytes)? } else { binary(bytes, count)? };
    if facets.is_empty() {
        return Err(flaw(None, "at least one triangle", "none"));
    }
    Ok(facets)
}

fn binary(bytes: &[u8], count: Option<usize>) -> Result<Vec<Facet>, SceneError> {
    let Some(count) = count else {
        let found = format!("{} bytes, less than the {HEAD} before the first triangle", bytes.len());
        return Err(flaw(None, "an STL file, binary or as text that begins with `solid`", &found));
    };
    let triangles = bytes.len() - HEAD;
    let whole = triangles / EACH;
    if triangles != EACH * count {
        let rest = match triangles % EACH {
            0 => String::new(),
            rest => format!(" and {rest} bytes of another triangle"),
        };
        let expected = format!("{count} triangles, as byte 80 states, {} bytes in total", HEAD + EACH * count);
        let found = format!("{} bytes, {whole} triangles{rest}", bytes.len());
        let help = if whole < count { "the file is truncated" } else { "the file is longer than it states" };
        return Err(flaw(None, &expected, &found).help(help));
    }
    let number = |at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
    let vector = |at: usize| Vector3::new(number(at), number(at + 4), number(at + 8));
    (0..count)
        .map(|facet| {
            let at = HEAD + EACH * facet;
            let corners = [at + 12, at + 24, at + 36].map(vector);
            let facet_is = Facet { corners, normal: vector(at), place: Place::Byte(at) };
            match corners.iter().flatten().find(|number| !number.is_finite()) {
                Some(number) => Err(flaw(Some(facet_is.place), "finite coordinates", &number.to_string())),
                None => Ok(facet_is),
            }
        })
        .collect()
}

/// Reader of the words of a text, with the unread rest of the text and the present line number.
struct Words<'a> {
    text: &'a str,
    line: usize,
}

impl<'a> Words<'a> {
    /// Returns the next word and its line.
    fn next(&mut self) -> Option<(&'a str, usize)> {
        let start = self.text.find(|letter: char| !letter.is_whitespace());
        let before = &self.text[..start.unwrap_or(self.text.len())];
        self.line += before.matches('\n').count();
        let rest = &self.text[start?..];
        let (word, after) = rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len()));
        self.text = after;
        Some((word, self.line))
    }

    /// Skips the rest of the line, because names of solids may contain any text.
    fn skip_line(&mut self) {
        self.text = &self.text[self.text.find('\n').unwrap_or(self.text.len())..];
    }

    fn flaw(&self, expected: &str, found: Option<(&str, usize)>) -> SceneError {
        match found {
            Some((word, line)) => {
                let word: String = word.chars().take(40).collect();
                flaw(Some(Place::Line(line)), expected, &format!("`{word}`"))
            }
            None => flaw(Some(Place::Line(self.line)), expected, "the end of the file").help("the file is truncated"),
        }
    }

    /// Reads the next word, which must be one of the expected words.
    fn take(&mut self, expected: &[&str]) -> Result<(&'a str, usize), SceneError> {
        let found = self.next();
        found.filter(|(word, _)| expected.iter().any(|expected| word.eq_ignore_ascii_case(expected))).ok_or_else(|| {
            let names: Vec<String> = expected.iter().map(|word| format!("`{word}`")).collect();
            self.flaw(&names.join(" or "), found)
        })
    }

    fn vector(&mut self) -> Result<Vector3<f64>, SceneError> {
        let mut numbers = [0.0; 3];
        for number in &mut numbers {
            let found = self.next();
            let parsed = found.and_then(|(word, _)| word.parse::<f64>().ok()).filter(|number| number.is_finite());
            *number = parsed.ok_or_else(|| self.flaw("a finite number", found))?;
        }
        Ok(numbers.into())
    }
}

fn ascii(bytes: &[u8]) -> Result<Vec<Facet>, SceneError> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| flaw(None, "text", &format!("other bytes after byte {}", error.valid_up_to())))?;
    let mut words = Words { text, line: 1 };
    let mut facets = Vec::new();
    words.take(&["solid"])?;
    loop {
        words.skip_line();
        loop {
            let (word, line) = words.take(&["facet", "endsolid"])?;
            if word.eq_ignore_ascii_case("endsolid") {
                break;
            }
            words.take(&["normal"])?;
            // Stored normals are often inaccurate. Here they only have to be finite numbers.
            let normal = words.vector()?;
            words.take(&["outer"])?;
            words.take(&["loop"])?;
            let mut corners = [Vector3::zeros(); 3];
            for corner in &mut corners {
                words.take(&["vertex"])?;
                *corner = words.vector()?;
            }
            words.take(&["endloop"])?;
            words.take(&["endfacet"])?;
            facets.push(Facet { corners, normal, place: Place::Line(line) });
        }
        words.skip_line();
        // A file may contain several solids.
        match words.next() {
            None => return Ok(facets),
            Some((word, _)) if word.eq_ignore_ascii_case("solid") => {}
            found => return Err(words.flaw("`solid` or the end of the file", found)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 .5e0\nendloop\n\
                       endfacet\nendsolid a b\n";

    fn binary_of(facets: &[Facet]) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes[..5].copy_from_slice(b"solid");
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            for vector in [&facet.normal].into_iter().chain(&facet.corners) {
                vector.iter().for_each(|number| bytes.extend((*number as f32).to_le_bytes()));
            }
            bytes.extend([0, 0]);
        }
        bytes
    }

    #[test]
    fn both_forms_hold_the_same() {
        let text = read(ONE.as_bytes()).unwrap();
        assert_eq!(text[0].corners[2], Vector3::new(0.0, 1.0, 0.5));
        assert_eq!(text[0].place, Place::Line(2));
        let binary = read(&binary_of(&text)).unwrap();
        assert_eq!(binary[0].corners, text[0].corners);
        assert_eq!(binary[0].place, Place::Byte(84));
    }

    /// A file truncated at any length is rejected, so that a part of a mesh is never read as the whole mesh.
    #[test]
    fn what_is_cut_off_is_refused() {
        let end = ONE.find("endsolid").unwrap() + "endsolid".len();
        for length in 0..end {
            assert!(read(&ONE.as_bytes()[..length]).is_err(), "{length}");
        }
        let whole = binary_of(&read(ONE.as_bytes()).unwrap().repeat(3));
        for length in 0..whole.len() {
            assert!(read(&whole[..length]).is_err(), "{length}");
        }
        assert!(read(&[whole, vec![0]].concat()).is_err());
        assert!(read(&[ONE.as_bytes(), b"facet"].concat()).is_err());
    }
}
