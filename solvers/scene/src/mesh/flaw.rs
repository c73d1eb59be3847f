//! What is wrong with a mesh.

/// What was expected of a mesh, what was found and where, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// What was expected.
    pub expected: String,
    /// What stood there, and where.
    pub found: String,
    /// How to mend it, where that is known.
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
