//! Errors in a mesh.

/// Error in a mesh: expected and found value, position, and suggested correction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// Expected value.
    pub expected: String,
    /// Found value, and its position.
    pub found: String,
    /// Suggested correction, if one is known.
    pub help: Option<String>,
}

impl Flaw {
    pub(super) fn new(expected: &str, found: &str) -> Self {
        Self { expected: expected.to_owned(), found: found.to_owned(), help: None }
    }

    pub(super) fn help(mut self, help: &str) -> Self {
        self.help = Some(help.to_owned());
        self
    }
}
