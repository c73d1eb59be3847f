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
mod program;
mod schedule;

pub use program::Program;

use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;

use crate::observer::Names;

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

/// Name of the dump with the grains at the samples.
pub const SAMPLES: &str = "dump.grains";
/// Name of the dump at the end of the run. It is written if the last step is not a regular sample.
pub const END: &str = "dump.end";
/// Name of the dump with contacts at the samples. It is written if a probe or the snapshots need contacts between
/// grains.
pub(crate) const CONTACTS: &str = "dump.contacts";
/// Name of the dump with contacts at the end of the run.
pub(crate) const END_CONTACTS: &str = "dump.end-contacts";
/// Columns of the dumps of grains.
const COLUMNS: [&str; 19] = [
    "id", "type", "radius", "mass", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz",
    "tqx", "tqy", "tqz",
];

/// Time steps and samples of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Number of steps between samples.
    pub interval: u64,
}

impl Eq for Stepping {}

impl Stepping {
    /// Returns time step, number of steps and sampling interval of a scene at a resolution.
    ///
    /// # Errors
    /// If the resolution is not a time step that is valid for this scene.
    pub fn new(scene: &Scene, resolution: &Resolution) -> Result<Self, String> {
        Ok(Self::every(resolution.steps(scene)?, scene))
    }

    /// Returns the stepping with a given time step (s) and number of steps. The sampling interval follows from the
    /// scene.
    pub(crate) fn every((time_step, steps): (f64, u64), scene: &Scene) -> Self {
        let interval = Recorder::new(scene, time_step, steps).interval().min(steps.max(1));
        Self { time_step, steps, interval }
    }

    /// Returns the steps at which samples are taken, including the last step.
    pub(crate) fn samples(&self) -> impl Iterator<Item = u64> + use<> {
        let Self { steps, interval, .. } = *self;
        (0..=steps / interval).map(move |sample| sample * interval).chain((!self.ends_on_a_sample()).then_some(steps))
    }

    /// Returns true if the last step is a regular sample.
    #[must_use]
    pub fn ends_on_a_sample(&self) -> bool {
        self.steps.is_multiple_of(self.interval)
    }
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

/// Files of a deck, columns of its log, and names of force columns in its dumps.
pub(crate) struct DeckFiles {
    pub(crate) files: Vec<(String, String)>,
    pub(crate) logged: Vec<logged::LogColumn>,
    pub(crate) names: Names,
}

/// Returns true if a probe requests the force on a wall or at one of its contacts. Walls are counted from 1.
fn asks_for_wall(scene: &Scene, number: usize) -> bool {
    asks_for_contacts_at(scene, number) || asks_for_force(scene, number)
}

/// Returns true if a probe requests the total force on a wall. Walls are counted from 1.
fn asks_for_force(scene: &Scene, number: usize) -> bool {
    scene.probes.iter().any(|probe| probe.target == ProbeTarget::Wall(number - 1))
}

/// Returns true if a probe requests a contact of a grain with a wall. Walls are counted from 1.
fn asks_for_contacts_at(scene: &Scene, number: usize) -> bool {
    let is_at = |target: ProbeTarget| matches!(target, ProbeTarget::GrainWall(_, wall) if wall + 1 == number);
    scene.probes.iter().any(|probe| is_at(probe.target))
}

/// Returns true if a probe requests a contact between grains or snapshots contain contacts.
fn asks_for_pairs(scene: &Scene) -> bool {
    scene.snapshot_contacts || scene.probes.iter().any(|probe| matches!(probe.target, ProbeTarget::Pair(..)))
}

/// Returns the commands that select the output of the log: the quantities `logged` at every sample or, if there are
/// none, only kinetic energy and number of atoms at the end of the run.
fn thermo(commands: &str, logged: &[logged::LogColumn], stepping: &Stepping) -> String {
    if logged.is_empty() {
        return format!("thermo_style custom step time ke atoms\nthermo {}", stepping.steps.max(1));
    }
    let names: Vec<String> = logged.iter().map(|logged| format!(" v_{}", logged.name)).collect();
    format!(
        "{commands}\nthermo_style custom step time ke atoms{}\nthermo_modify norm no format float %.17g\nthermo {}",
        names.concat(),
        stepping.interval
    )
}

/// Returns the title of the scene for a comment in the first line of a script. Characters other than ASCII letters,
/// digits, spaces and `.,:-()` are replaced, because some have a meaning in scripts even within comments.
fn heading(scene: &Scene) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || " .,:-()".contains(letter) { letter } else { '_' };
    scene.title.chars().take(100).map(plain).collect::<String>().trim().to_owned()
}
