//! Programs for which this crate writes decks, and which it runs. Each program is a module.

use std::fmt;

use grainbench_scene::scene::Scene;

use super::lammps::Lammps;
use super::liggghts::Liggghts;
use super::{DeckFiles, Stepping};

/// Interface of a program that runs decks. The command `executable -in in.name -log file` runs a deck in its folder.
/// The program writes dumps and a log in the format of LAMMPS.
pub(crate) trait Peer: Sync {
    /// Returns the name in lower case, which is also the solver name.
    fn name(&self) -> &'static str;
    /// Returns the name in the spelling of its authors.
    fn title(&self) -> &'static str;
    /// Returns the name of the executable on `PATH`.
    fn executable(&self) -> &'static str;
    /// Returns the files of the deck. The first file is the input script.
    ///
    /// # Errors
    /// If the program cannot express the scene, with the reason.
    fn write(&self, scene: &Scene, stepping: &Stepping) -> Result<DeckFiles, String>;
}

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
