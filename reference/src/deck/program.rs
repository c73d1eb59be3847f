//! Programs for which this crate writes decks, and which it runs. Each program is a module.

use std::fmt;

use super::lammps::Lammps;
use super::liggghts::Liggghts;
use super::peer::Peer;

/// Program for which decks are written.
#[derive(Clone, Copy)]
pub struct Program(&'static dyn Peer);

impl Program {
    /// LAMMPS, `pair_style gran/hooke/history` and related styles.
    pub const LAMMPS: Self = Self(&Lammps);
    /// LIGGGHTS, `model hooke/stiffness tangential history` and related models.
    pub const LIGGGHTS: Self = Self(&Liggghts);
    /// All programs for which decks can be written.
    pub const ALL: [Self; 2] = [Self::LAMMPS, Self::LIGGGHTS];

    pub(crate) const fn peer(self) -> &'static dyn Peer {
        self.0
    }

    /// Returns the name in lower case, which is also the solver name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0.name()
    }

    /// Returns the program with this name in lower case, or `None`.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|program| program.name() == name)
    }

    /// Returns the name of the executable on `PATH`.
    #[must_use]
    pub fn executable(self) -> &'static str {
        self.0.executable()
    }

    /// Returns the environment variable that can name another executable.
    #[must_use]
    pub fn variable(self) -> String {
        format!("GRAINBENCH_{}", self.name().to_uppercase())
    }

    /// Returns the shell command that runs a deck in its folder.
    #[must_use]
    pub fn command(self) -> String {
        format!("{} -in in.{}", self.executable(), self.name())
    }
}

impl PartialEq for Program {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Program {}

impl fmt::Debug for Program {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl fmt::Display for Program {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.0.title())
    }
}
