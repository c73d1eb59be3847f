//! Errors of a run: invalid requests, failures of a simulation with their cause, and failures of external programs.

use crate::checkpoint::CheckpointError;
use nalgebra::Vector3;
use std::fmt;
use thiserror::Error;

/// Reason why a simulation broke.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Cause {
    /// A position or velocity is NaN or infinite.
    #[error("its state is not finite")]
    NotFinite,
    /// A grain moved more than its radius in one step.
    #[error("it moved {moved:.3e} m in one step, more than its radius {radius:.3e} m")]
    Runaway {
        /// Displacement in the step (m).
        moved: f64,
        /// Radius (m).
        radius: f64,
    },
    /// A contact became so stiff that the time step exceeds the critical one.
    #[error("one of its contacts became so stiff, {stiffness:.3e} N/m, that the time step is above the critical one")]
    StiffContact {
        /// Stiffness of the contact springs (N/m).
        stiffness: f64,
    },
    /// A grain rotated so far in one step that the direction of friction is lost.
    #[error("it turned by {turned:.3e} rad in one step")]
    Spun {
        /// Rotation in the step (rad).
        turned: f64,
    },
    /// A material point moved more than a cell in one step.
    #[error("it moved {moved:.3e} m in one step, more than a cell of {cell:.3e} m")]
    LeftCell {
        /// Displacement in the step (m).
        moved: f64,
        /// Length of a cell (m).
        cell: f64,
    },
    /// A material point was inverted.
    #[error("it was turned inside out: its volume is {volume_ratio:.3e} of that at the start")]
    Inverted {
        /// Volume relative to the initial volume.
        volume_ratio: f64,
    },
    /// A cell lost all its volume in one step.
    #[error("its cell collapsed: one step changed its volume by a factor {volume_ratio:.3e}")]
    CollapsedCell {
        /// Volume after the step relative to the volume before it.
        volume_ratio: f64,
    },
    /// A material point became so stiff that a wave crosses a cell in less than a time step.
    #[error(
        "it was deformed until the fastest wave crossed a cell in {crossing:.4e} s ({at_start:.4e} s at the start), \
         less than the time step"
    )]
    Stiffened {
        /// Present time in which the fastest wave crosses a cell (s).
        crossing: f64,
        /// Fastest wave's time across a cell at the start (s).
        at_start: f64,
    },
    /// A closed system gained energy without a source.
    #[error(
        "it is the fastest in a run that has gained {gained:.4e} J since the start, which nothing supplied; at most \
         {allowed:.4e} J is allowed"
    )]
    GainedEnergy {
        /// Energy gained since the start (J; J/m for discs).
        gained: f64,
        /// Largest allowed gain (J; J/m for discs).
        allowed: f64,
    },
    /// A surface starts so deep inside another surface that the contact springs would eject it.
    #[error(
        "it starts {depth:.4e} m inside another surface; the springs would expel it in a shock with a strain of \
         {strain:.3}, more than {allowed}"
    )]
    StartsInside {
        /// Overlap (m).
        depth: f64,
        /// Strain p/M of the surface layer, with the pressure p of the contact springs and the longitudinal modulus M
        /// (Pa).
        strain: f64,
        /// Largest allowed strain.
        allowed: f64,
    },
    /// Bodies spread beyond the largest grid.
    #[error("it left the grid, which would need {cells:.3e} cells")]
    LeftGrid {
        /// Number of cells required.
        cells: f64,
    },
    /// A poured grain was inserted at the position of another grain.
    #[error(
        "it was poured into grain {other}, which it overlaps by {ratio:.3} of the smaller radius: a poured grain needs \
         room in its box at its time, and other grains may have piled up there"
    )]
    CameIntoGrain {
        /// Id of the other grain, from 1.
        other: u32,
        /// Overlap relative to the smaller radius.
        ratio: f64,
    },
    /// A poured grain was inserted at the position of a wall.
    #[error(
        "it was poured into wall {wall} of the scene, which it overlaps by {ratio:.3} of its radius: a poured grain \
         needs room in its box at its time"
    )]
    CameIntoWall {
        /// Number of the wall in the order of the file, from 1.
        wall: u16,
        /// Overlap relative to the radius.
        ratio: f64,
    },
}

/// Largest overlap of an inserted grain, relative to the smaller radius. A larger overlap breaks the simulation. The
/// value equals the default limit of initial overlaps.
pub const LARGEST_ENTRY_OVERLAP: f64 = 0.1;

/// Particle at which a simulation broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailedParticle {
    /// Grain, by id from 1.
    Grain(u32),
    /// Material point of a grain, by id of the grain from 1.
    PointOfGrain(u32),
    /// Material point of another body, by number of the body from 1.
    PointOfBody(u32),
}

impl fmt::Display for FailedParticle {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grain(id) => write!(formatter, "grain {id}"),
            Self::PointOfGrain(id) => write!(formatter, "a material point of grain {id}"),
            Self::PointOfBody(place) => write!(formatter, "a material point of body {place}"),
        }
    }
}

/// Failure of a simulation, with time, position, cause, and advice on a stable setting.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "the simulation broke at t = {time:.6e} s (step {step}): {subject} at ({:.4e}, {:.4e}, {:.4e}) m: {cause}; the time step \
     was {time_step:.4e} s{}; {advice}",
    position.x, position.y, position.z, of_critical(*time_step, *critical)
)]
pub struct SimulationFailure {
    /// Time (s).
    pub time: f64,
    /// Step number at the failure.
    pub step: u64,
    /// Particle at which the simulation broke.
    pub subject: FailedParticle,
    /// Last position of the particle (m).
    pub position: Vector3<f64>,
    /// Detected reason of the failure.
    pub cause: Cause,
    /// Time step (s).
    pub time_step: f64,
    /// Critical time step (s).
    pub critical: f64,
    /// Advice on a stable setting.
    pub advice: String,
}

/// Returns the ratio of a time step (s) to the critical one (s) as text; empty if there is no critical time step.
fn of_critical(time_step: f64, critical: f64) -> String {
    if critical.is_finite() {
        format!(", {:.3} of the critical {critical:.4e} s", time_step / critical)
    } else {
        String::new()
    }
}

/// Reason why a solver returned no record.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The solver does not support this scene.
    #[error("{solver} cannot run this scene: {reason}")]
    Unsupported {
        /// Name of the solver.
        solver: String,
        /// Missing feature.
        reason: String,
    },
    /// A sampled quantity became NaN or infinite, although all grain positions are valid.
    #[error("the simulation broke at t = {time:.6e} s (step {step}): `{column}` became {value}")]
    NotFinite {
        /// Time (s).
        time: f64,
        /// Step number of the sample.
        step: u64,
        /// Column of the time series.
        column: String,
        /// Invalid value: NaN or infinity.
        value: f64,
    },
    /// The resolution is not valid for this solver.
    #[error("{solver}: {reason}")]
    Resolution {
        /// Name of the solver.
        solver: String,
        /// Error in the resolution.
        reason: String,
    },
    /// The solver is an external program that is not installed.
    #[error("{solver} is not available: {reason}")]
    NotAvailable {
        /// Name of the solver.
        solver: String,
        /// Reason, such as the locations that were searched.
        reason: String,
    },
    /// The stored record belongs to another scene.
    #[error("{solver}: the stored run is stale: {reason}")]
    Stale {
        /// Name of the solver.
        solver: String,
        /// Reason, and the command that computes the run again.
        reason: String,
    },
    /// The solver is an external program that failed.
    #[error("{solver} {failure}{}", last_words(last_lines))]
    Program {
        /// Name of the solver.
        solver: String,
        /// Kind of failure.
        failure: Failure,
        /// Last lines of its output.
        last_lines: Vec<String>,
    },
    /// The simulation broke.
    #[error(transparent)]
    Broken(#[from] Box<SimulationFailure>),
    /// The observer interrupted the run.
    #[error("the simulation was interrupted at t = {time:.6e} s (step {step})")]
    Interrupted {
        /// Time (s).
        time: f64,
        /// Number of the last complete step.
        step: u64,
    },
    /// A snapshot could not be stored.
    #[error(transparent)]
    NotStored(#[from] StorageError),
    /// The run cannot continue from this checkpoint, or a checkpoint cannot be stored.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Error of an observer that could not store output.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct StorageError(pub String);

/// Failure of an external program.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Failure {
    /// The program could not be started, or its folder could not be created.
    #[error("could not be run: {0}")]
    NotRun(String),
    /// The program or the reading of its output exceeded the time limit.
    #[error("was not done after {0} s")]
    TimeOut(u64),
    /// The program was ended by an interrupt of our process.
    #[error("was ended by an interrupt")]
    Interrupted,
    /// The program ended with an error code.
    #[error("failed: {0}")]
    Crash(String),
    /// The output of the program cannot be used.
    #[error("left output that cannot be used: {0}")]
    Output(String),
}

fn last_words(lines: &[String]) -> String {
    if lines.is_empty() { String::new() } else { format!("; it said last: {}", lines.join(" | ")) }
}
