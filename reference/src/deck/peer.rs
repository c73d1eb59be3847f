//! Interface of the programs that run decks.

use super::logged::LogColumn;
use super::stepping::Stepping;
use crate::names::Names;
use grainbench_scene::scene::Scene;

/// Files of a deck, columns of its log, and names of force columns in its dumps.
pub(crate) struct DeckFiles {
    pub(crate) files: Vec<(String, String)>,
    pub(crate) logged: Vec<LogColumn>,
    pub(crate) names: Names,
}

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
