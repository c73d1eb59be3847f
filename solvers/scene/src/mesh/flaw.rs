//! Errors in a mesh, with their position in its STL file.

use crate::error::SceneError;

/// Number of bytes before the first triangle in the binary form.
pub(super) const HEAD: usize = 84;
/// Number of bytes of a triangle in the binary form.
pub(super) const EACH: usize = 50;

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
