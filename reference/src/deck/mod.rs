//! Input decks for LAMMPS and LIGGGHTS, written from the same scene that our own solvers run.
//!
//! Decks use only models that the program implements. If a program cannot express a scene, the error states the reason;
//! scenes are never approximated.

mod dashpots;
mod data;
mod driven;
mod lammps;
mod liggghts;
pub(crate) mod logged;
mod outline;
mod peer;
mod program;
mod schedule;
mod script;
mod stepping;

pub(crate) use peer::DeckFiles;
pub use program::Program;
pub(crate) use script::{CONTACTS, END_CONTACTS};
pub use script::{END, SAMPLES};
pub use stepping::Stepping;

use grainbench_scene::scene::Scene;
use grainbench_solver::resolution::Resolution;

use crate::names::Names;

/// Error of writing a deck.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeckError {
    /// The program cannot express the scene.
    #[error("{program} cannot express this scene: {reason}")]
    Unsupported {
        /// Program that the deck was requested for.
        program: Program,
        /// Reason, such as a missing feature of the program.
        reason: String,
    },
    /// The resolution is not a time step that is valid for the scene.
    #[error("{0}")]
    Resolution(String),
}

/// Files of a deck and the names of its outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// Name and text of each file. The first file is the input script.
    pub files: Vec<(String, String)>,
    /// Time steps and samples of the run.
    pub stepping: Stepping,
    /// Quantities that are read from the log.
    pub(crate) logged: Vec<logged::LogColumn>,
    /// Names of force columns in the dumps.
    pub(crate) names: Names,
}

/// Writes the deck of a scene for a program.
///
/// # Errors
/// If the program cannot express the scene, or if the resolution is not a time step that is valid for it.
pub fn write_deck(scene: &Scene, resolution: &Resolution, program: Program) -> Result<Deck, DeckError> {
    let stepping = Stepping::new(scene, resolution).map_err(DeckError::Resolution)?;
    let unsupported = |reason: String| DeckError::Unsupported { program, reason };
    outline::refuse_what_neither_has(scene).map_err(unsupported)?;
    let DeckFiles { files, logged, names } = program.peer().write(scene, &stepping).map_err(unsupported)?;
    Ok(Deck { files, stepping, logged, names })
}
