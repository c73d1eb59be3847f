//! Sources of expected values. A cited work exists only if its file with provenance exists, because the constants are
//! generated from these files when the cases are built.

/// Source of an expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Derived: an equation or a law, in words. The derivation is stored with the case.
    Derived(&'static str),
    /// Printed in a cited work: the place in the work and the printed statement.
    Printed(&'static Work, &'static str),
    /// Another program, whose run is stored or done now.
    Program,
    /// Another of our runs, in words: the same solver at a finer resolution, or another method from the same initial
    /// state. It shows only that our own results agree.
    Ourselves(&'static str),
    /// The value of the same solver when the claim was written.
    Regression(&'static str),
}

/// Kind of cited work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A paper or a book.
    Literature,
    /// A measurement on real grains.
    Experiment,
    /// An independent prototype of a method.
    Prototype,
}

/// A cited work. Its folder holds its provenance.
#[derive(Debug, PartialEq, Eq)]
pub struct Work {
    /// Paper, measurement or prototype.
    pub kind: Kind,
    /// Folder in the directory of references, such as `literature/bardenhagen-2000`.
    pub id: &'static str,
    /// Citation in results: author, year, title.
    pub cited: &'static str,
}

/// Number from a cited work, with its place in the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CitedNumber {
    /// The work.
    pub work: &'static Work,
    /// Quantity and its place in the work.
    pub what: &'static str,
    /// Value of the number.
    pub value: f64,
    /// Uncertainty that the work states; 0 if it states none.
    pub uncertainty: f64,
}

impl CitedNumber {
    /// Returns the source of the number.
    #[must_use]
    pub const fn source(&self) -> Source {
        Source::Printed(self.work, self.what)
    }
}

impl Source {
    /// Returns the source in words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Derived(words) | Self::Ourselves(words) => words.to_owned(),
            Self::Printed(work, place) => format!("{}: {place}", work.cited),
            Self::Program => "the program, run on the deck of the same scene".to_owned(),
            Self::Regression(words) => format!("an earlier result of this solver: {words}"),
        }
    }

    /// Returns the cited work, if the source is one.
    #[must_use]
    pub const fn work(self) -> Option<&'static Work> {
        match self {
            Self::Printed(work, _) => Some(work),
            _ => None,
        }
    }
}
