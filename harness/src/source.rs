//! Sources of expected values. A cited work is a constant generated from its provenance file when the cases are built,
//! so a work without this file cannot be cited.

/// Source of an expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Derivation: an equation or a law, in words. The case stores the derivation.
    Derived(&'static str),
    /// Statement in a cited work: the work, and the place and the statement in words.
    Printed(&'static Work, &'static str),
    /// Another program, whose run is stored or done now.
    Program,
    /// Another of our runs, in words: the same solver at a finer resolution, or another method with the same initial
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

/// Cited work. Its folder contains its provenance.
#[derive(Debug, PartialEq, Eq)]
pub struct Work {
    /// Kind of the work.
    pub kind: Kind,
    /// Folder in the directory of references, such as `literature/bardenhagen-2000`.
    pub id: &'static str,
    /// Citation in results: author, year, title.
    pub cited: &'static str,
}

/// Number from a cited work, with its place in the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CitedNumber {
    /// Cited work.
    pub work: &'static Work,
    /// Name of the quantity and its place in the work.
    pub what: &'static str,
    /// Value of the number.
    pub value: f64,
    /// Uncertainty that the work states, in the unit of the value; 0 if it states none.
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

    /// Returns the cited work; none for another kind of source.
    #[must_use]
    pub const fn work(self) -> Option<&'static Work> {
        match self {
            Self::Printed(work, _) => Some(work),
            _ => None,
        }
    }
}
