//! Where an expected value comes from. Handles of works exist only where files with provenance do: they are made from
//! those files when the cases are built.

/// A source of expected values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Derived: an equation or a law, in words; the derivation stands beside the case.
    Derived(&'static str),
    /// Printed in a work, at a place, with what is printed there.
    Printed(&'static Work, &'static str),
    /// A program, whose run is stored or done now.
    Program,
    /// Another run of ours, in words: the same solver at a finer resolution, or another method from the same start. It shows
    /// that our own results agree, and nothing from outside.
    Ourselves(&'static str),
    /// What the solver gave when the row was written, and nothing else.
    Regression(&'static str),
}

/// What kind of work it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A paper or a book.
    Literature,
    /// A measurement on real grains.
    Experiment,
    /// An independent prototype of a method.
    Prototype,
}

/// A work with a folder of its own, which holds its provenance.
#[derive(Debug, PartialEq, Eq)]
pub struct Work {
    /// Kind.
    pub kind: Kind,
    /// Folder below the references, such as `literature/bardenhagen-2000`.
    pub id: &'static str,
    /// Author, year, title: how it is cited in a row.
    pub cited: &'static str,
}

/// A number that a work gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cited {
    /// The work.
    pub work: &'static Work,
    /// What it is the value of, and where it stands.
    pub what: &'static str,
    /// The number.
    pub value: f64,
    /// How far the work says that it may be off; 0 where it says nothing.
    pub uncertainty: f64,
}

impl Cited {
    /// The source of the number.
    #[must_use]
    pub const fn source(&self) -> Source {
        Source::Printed(self.work, self.what)
    }
}

impl Source {
    /// In words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Derived(words) | Self::Ourselves(words) => words.to_owned(),
            Self::Printed(work, place) => format!("{}: {place}", work.cited),
            Self::Program => "the program, run on the deck of the same scene".to_owned(),
            Self::Regression(words) => format!("what this solver gave before: {words}"),
        }
    }

    /// The folder with its provenance, where it is a work.
    #[must_use]
    pub const fn work(self) -> Option<&'static Work> {
        match self {
            Self::Printed(work, _) => Some(work),
            _ => None,
        }
    }
}
