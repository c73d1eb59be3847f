//! Input decks for LAMMPS and LIGGGHTS, written from the scene that our own solvers run.
//!
//! Each deck is in a convention that the program truly has. What a program cannot express is refused with the reason,
//! never approximated.

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

use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_scene::solver::Resolution;

use crate::observer::Names;

/// Why a program has no deck for a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeckError {
    /// The program cannot express the scene.
    #[error("{program} cannot express this scene: {reason}")]
    Unsupported {
        /// Which program.
        program: Program,
        /// What it lacks.
        reason: String,
    },
    /// The resolution makes no sense.
    #[error("{0}")]
    Resolution(String),
}

/// The files of a deck, and what its run leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// Name and text of each file; the input script is the first.
    pub files: Vec<(String, String)>,
    /// How it is run.
    pub stepping: Stepping,
    /// What its log tells.
    pub(crate) logged: Vec<logged::Logged>,
    /// What its dumps call forces.
    pub(crate) names: Names,
}

/// The dump of the samples that a deck's run leaves.
pub const SAMPLES: &str = "dump.grains";
/// The dump of the end, where that is no sample.
pub const END: &str = "dump.end";
/// The dump of contacts at the samples, where probes ask for some between grains.
pub(crate) const CONTACTS: &str = "dump.contacts";
/// The same of the end.
pub(crate) const END_CONTACTS: &str = "dump.end-contacts";
/// The columns of both dumps of grains.
const COLUMNS: [&str; 19] = [
    "id", "type", "radius", "mass", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz",
    "tqx", "tqy", "tqz",
];

/// The steps of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// Time step (s).
    pub time_step: f64,
    /// How many steps.
    pub steps: u64,
    /// Steps between samples.
    pub interval: u64,
}

impl Eq for Stepping {}

impl Stepping {
    /// Of a scene at a resolution.
    ///
    /// # Errors
    /// When the resolution is no time step for this scene.
    pub fn of(scene: &Scene, resolution: &Resolution) -> Result<Self, String> {
        Ok(Self::every(resolution.steps(scene)?, scene))
    }

    /// So many steps of a length (s), and the samples of a scene.
    pub(crate) fn every((time_step, steps): (f64, u64), scene: &Scene) -> Self {
        let interval = Recorder::new(scene, time_step, steps).interval().min(steps.max(1));
        Self { time_step, steps, interval }
    }

    /// The steps at which there is a sample.
    pub(crate) fn samples(&self) -> impl Iterator<Item = u64> + use<> {
        let Self { steps, interval, .. } = *self;
        (0..=steps / interval).map(move |sample| sample * interval).chain((!self.ends_on_a_sample()).then_some(steps))
    }

    /// Whether the last step is a sample anyway.
    #[must_use]
    pub fn ends_on_a_sample(&self) -> bool {
        self.steps.is_multiple_of(self.interval)
    }
}

/// Writes the deck of a scene for a program.
///
/// # Errors
/// When the program cannot express the scene, with the reason, or the resolution is no time step.
pub fn write_deck(scene: &Scene, resolution: &Resolution, program: Program) -> Result<Deck, DeckError> {
    let stepping = Stepping::of(scene, resolution).map_err(DeckError::Resolution)?;
    let unsupported = |reason: String| DeckError::Unsupported { program, reason };
    outline::refuse_what_neither_has(scene).map_err(unsupported)?;
    let Written { files, logged, names } = program.peer().write(scene, &stepping).map_err(unsupported)?;
    Ok(Deck { files, stepping, logged, names })
}

/// Files of a deck, what its log is asked for, and what its dumps call forces.
pub(crate) struct Written {
    pub(crate) files: Vec<(String, String)>,
    pub(crate) logged: Vec<logged::Logged>,
    pub(crate) names: Names,
}

/// Whether a probe asks for the force on a wall, or at one of its contacts; walls are counted from 1.
fn asks_for_wall(scene: &Scene, number: usize) -> bool {
    asks_for_contacts_at(scene, number) || asks_for_force(scene, number)
}

/// Whether a probe asks for the force on a wall.
fn asks_for_force(scene: &Scene, number: usize) -> bool {
    scene.probes.iter().any(|probe| probe.target == ProbeTarget::Wall(number - 1))
}

/// Whether a probe asks for a contact of a wall.
fn asks_for_contacts_at(scene: &Scene, number: usize) -> bool {
    let is_at = |target: ProbeTarget| matches!(target, ProbeTarget::GrainWall(_, wall) if wall + 1 == number);
    scene.probes.iter().any(|probe| is_at(probe.target))
}

/// Whether a probe asks for a contact between grains, or snapshots are to hold them.
fn asks_for_pairs(scene: &Scene) -> bool {
    scene.snapshot_contacts || scene.probes.iter().any(|probe| matches!(probe.target, ProbeTarget::Pair(..)))
}

/// The lines that say what is printed: nothing but the end of the run, or sums at every sample.
fn thermo(commands: &str, logged: &[logged::Logged], stepping: &Stepping) -> String {
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

/// A comment on the first line: what the deck is of. Only letters, digits and some marks, for scripts give others a
/// meaning even in comments.
fn heading(scene: &Scene) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() || " .,:-()".contains(letter) { letter } else { '_' };
    scene.title.chars().take(100).map(plain).collect::<String>().trim().to_owned()
}
