//! The programs that this crate writes input for, runs and reads, each a module of its own.

use std::fmt;

use grainbench_scene::scene::Scene;

use super::lammps::Lammps;
use super::liggghts::Liggghts;
use super::{Stepping, Written};

/// What a program is here. It is run as `executable -in in.name -log file` in the folder of its deck, and leaves dumps
/// and a log as LAMMPS does.
pub(crate) trait Peer: Sync {
    /// Its name, as that of its solver, in lower case.
    fn name(&self) -> &'static str;
    /// Its name as its authors write it.
    fn title(&self) -> &'static str;
    /// What it is called on `PATH`.
    fn executable(&self) -> &'static str;
    /// The files of its deck, the input script first.
    ///
    /// # Errors
    /// When it cannot express the scene, with the reason.
    fn write(&self, scene: &Scene, stepping: &Stepping) -> Result<Written, String>;
}

/// Whose input a deck is.
#[derive(Clone, Copy)]
pub struct Program(&'static dyn Peer);

impl Program {
    /// LAMMPS, `pair_style gran/hooke/history` and its like.
    pub const LAMMPS: Self = Self(&Lammps);
    /// LIGGGHTS, `model hooke/stiffness tangential history` and its like.
    pub const LIGGGHTS: Self = Self(&Liggghts);
    /// All of them.
    pub const ALL: [Self; 2] = [Self::LAMMPS, Self::LIGGGHTS];

    pub(crate) const fn peer(self) -> &'static dyn Peer {
        self.0
    }

    /// Its name, as that of its solver.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0.name()
    }

    /// The program of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|program| program.name() == name)
    }

    /// What it is called on `PATH`.
    #[must_use]
    pub fn executable(self) -> &'static str {
        self.0.executable()
    }

    /// The variable of the environment that names another executable.
    #[must_use]
    pub fn variable(self) -> String {
        format!("GRAINBENCH_{}", self.name().to_uppercase())
    }

    /// What to type, in the folder of the deck.
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
