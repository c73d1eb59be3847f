//! Errors in a mesh.

use super::place::Place;

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
