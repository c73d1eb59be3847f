//! Errors in a mesh, with their position in its STL file.

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

impl Place {
    /// Returns the position as it follows the name of the file in an error message: a line of text, or the number of a
    /// triangle in binary form.
    #[must_use]
    pub fn after_name(self) -> String {
        match self {
            Self::Line(line) => format!(":{line}"),
            Self::Byte(byte) => format!(": triangle {}", byte.saturating_sub(HEAD) / EACH + 1),
        }
    }
}

/// Error in a mesh: expected and found value, position, and suggested correction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// Expected value.
    pub expected: String,
    /// Found value.
    pub found: String,
    /// Position in the file; `None` for the file as a whole.
    pub place: Option<Place>,
    /// Suggested correction, if one is known.
    pub help: Option<String>,
}

impl Flaw {
    pub(super) fn new(expected: &str, found: &str) -> Self {
        Self { expected: expected.to_owned(), found: found.to_owned(), place: None, help: None }
    }

    pub(super) const fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    pub(super) fn help(mut self, help: &str) -> Self {
        self.help = Some(help.to_owned());
        self
    }
}
