//! Interface of solvers. A solver receives a scene and a resolution, and returns a record.

use crate::brief::Brief;
use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::end_state::EndState;
use crate::record::{PartialOutput, Record, Snapshot};
use crate::recorder;
use crate::scene::{Duration, Scene};
use nalgebra::Vector3;
use std::fmt;
use thiserror::Error;

/// Resolution of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Time step as a fraction of the critical time step `2√(m_min/k_max)`. If the duration is given in seconds, the
    /// step is shortened so that a whole number of steps fits.
    CriticalFraction(f64),
    /// Time step (s), used unchanged.
    TimeStep(f64),
    /// Resolution of rigid-body engines, whose contacts have no critical time step. The step is shortened so that a
    /// whole number of steps fits.
    Rigid {
        /// Step that is divided into substeps (s).
        step: f64,
        /// Number of time steps in `step`.
        substeps: u32,
        /// Iterations of the constraint solver in each time step.
        iterations: u32,
    },
    /// Resolution of methods with a grid. The step is shortened so that a whole number of steps fits.
    Grid {
        /// Cells per reference length of the scene, which is the radius of a grain if there are grains.
        cells: f64,
        /// Material points per cell and axis.
        points: u32,
        /// Courant number c Δt/h: time step over the time in which a longitudinal wave crosses a cell.
        courant: f64,
    },
}

impl Resolution {
    /// Default step of a rigid-body engine (s): sixty per second, a usual frame rate.
    pub const RIGID_STEP: f64 = 1.0 / 60.0;
    /// Default number of iterations of the constraint solver of a rigid-body engine.
    pub const RIGID_ITERATIONS: u32 = 4;

    /// Default Courant number of a method with a grid.
    pub const COURANT: f64 = 0.4;

    /// Fraction of the critical time step that command lines use by default.
    pub const FRACTION: f64 = 0.1;

    /// Cells per reference length that command lines use by default.
    pub const CELLS: f64 = 8.0;

    /// Material points per cell and axis that command lines use by default.
    pub const POINTS: u32 = 3;

    /// Substeps per step of rigid bodies that command lines use by default.
    pub const SUBSTEPS: u32 = 8;

    /// Returns a grid resolution with the default Courant number.
    #[must_use]
    pub const fn grid(cells: f64, points: u32) -> Self {
        Self::Grid { cells, points, courant: Self::COURANT }
    }

    /// Returns a rigid-body resolution with the default step and iterations.
    #[must_use]
    pub const fn substeps(substeps: u32) -> Self {
        Self::Rigid { step: Self::RIGID_STEP, substeps, iterations: Self::RIGID_ITERATIONS }
    }

    /// Returns the resolution with the time step or the cell size multiplied by a factor; `None` if the number of
    /// substeps would not be a whole number of at least 1.
    #[must_use]
    pub fn coarser(&self, factor: f64) -> Option<Self> {
        Some(match *self {
            Self::CriticalFraction(fraction) => Self::CriticalFraction(fraction * factor),
            Self::TimeStep(step) => Self::TimeStep(step * factor),
            Self::Rigid { step, substeps, iterations } => {
                let fewer = f64::from(substeps) / factor;
                if fewer < 1.0 || fewer.fract() != 0.0 {
                    return None;
                }
                Self::Rigid { step, substeps: fewer as u32, iterations }
            }
            Self::Grid { cells, points, courant } => Self::Grid { cells: cells / factor, points, courant },
        })
    }

    /// Returns the time step (s) and the number of steps of a scene, for solvers with a time step.
    ///
    /// # Errors
    /// When the resolution is not a positive time step, the scene has no critical time step, or there are too many
    /// steps.
    pub fn steps(&self, scene: &Scene) -> Result<(f64, u64), String> {
        let critical = scene.critical_time_step();
        let wanted = match *self {
            Self::CriticalFraction(fraction) => fraction * critical,
            Self::TimeStep(step) => step,
            Self::Rigid { .. } | Self::Grid { .. } => return Err(format!("expected a time step, found {self}")),
        };
        if !(wanted.is_finite() && wanted > 0.0) {
            return Err(if critical.is_finite() {
                format!("expected a positive time step, found {self}")
            } else {
                "the scene has no contact, so no critical time step; expected a time step in seconds".to_owned()
            });
        }
        let asked = match scene.duration {
            Duration::Cycles(cycles) => cycles as f64,
            Duration::Seconds(time) => time / wanted,
        };
        if let Some(refusal) = beyond_run(scene, wanted, asked) {
            return Err(refusal);
        }
        Ok(match (scene.duration, self) {
            (Duration::Cycles(cycles), _) => (wanted, cycles),
            (Duration::Seconds(time), Self::TimeStep(_)) => (wanted, ((time / wanted).round() as u64).max(1)),
            (Duration::Seconds(time), _) => whole_steps(time, wanted),
        })
    }

    /// Returns the time step (s) and the number of steps of a scene on a grid. The time step is the Courant number
    /// times [`Scene::crossing_time`], shortened so that a whole number of steps fits.
    ///
    /// # Errors
    /// When the resolution is not a grid, nothing in the scene deforms, the duration is given in cycles, or there are
    /// too many steps.
    pub fn steps_on_grid(&self, scene: &Scene) -> Result<(f64, u64), String> {
        let Self::Grid { cells, courant, .. } = *self else {
            return Err(format!("expected cells of a grid, found {self}"));
        };
        let Duration::Seconds(time) = scene.duration else {
            return Err("expected a duration in seconds, found cycles".to_owned());
        };
        let wanted = courant * scene.crossing_time(scene.reference_length / cells);
        if !(wanted.is_finite() && wanted > 0.0) {
            return Err(format!("expected a deformable material and positive numbers, found none at {self}"));
        }
        beyond_run(scene, wanted, time / wanted).map_or_else(|| Ok(whole_steps(time, wanted)), Err)
    }
}

/// Returns the longest time step (s) of at most `wanted` (s) that divides a time (s) into a whole number of steps, and
/// this number. A small tolerance prevents an extra step due to rounding.
fn whole_steps(time: f64, wanted: f64) -> (f64, u64) {
    let steps = (time / wanted * (1.0 - 1e-12)).ceil().max(1.0);
    (time / steps, steps as u64)
}

/// Limit of the number of steps of any solver. A run with this number of steps takes thirty years at a million steps
/// per second.
const MOST_STEPS: f64 = 1e15;

/// Returns an error message for a number of steps that is too large; `None` for other numbers.
#[must_use]
pub fn beyond_steps(steps: f64) -> Option<String> {
    (steps.is_nan() || steps >= MOST_STEPS)
        .then(|| format!("expected fewer than {MOST_STEPS:e} steps, found {steps:.3e}"))
}

/// Returns an error message for a run with steps of `time_step` (s) that has too many steps, or whose record does not
/// fit into memory; `None` for other runs.
#[must_use]
pub fn beyond_run(scene: &Scene, time_step: f64, steps: f64) -> Option<String> {
    beyond_steps(steps).or_else(|| recorder::beyond_memory(scene, time_step, steps))
}

impl fmt::Display for Resolution {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CriticalFraction(fraction) => write!(formatter, "dt={}", rounded(*fraction)),
            Self::TimeStep(step) => write!(formatter, "dt={} s", rounded(*step)),
            Self::Rigid { step, substeps, iterations } => {
                write!(formatter, "substeps={substeps}")?;
                if *iterations != Self::RIGID_ITERATIONS {
                    write!(formatter, " iterations={iterations}")?;
                }
                if *step != Self::RIGID_STEP {
                    write!(formatter, " step={step} s")?;
                }
                Ok(())
            }
            Self::Grid { cells, points, courant } => {
                write!(formatter, "cells={} points={points} courant={}", rounded(*cells), rounded(*courant))
            }
        }
    }
}

/// Rounds a number to four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Numerical method of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Discrete element method. The resolution is a time step.
    Dem,
    /// Rigid grains. The resolution consists of substeps and iterations.
    Rigid,
    /// Deformable grains on a grid. The resolution consists of cells and points.
    Grid,
}

impl Method {
    /// Returns the method of one of our solvers, by name.
    #[must_use]
    pub fn from_name(solver: &str) -> Option<Self> {
        match solver.split([':', '+']).next() {
            Some("dem") => Some(Self::Dem),
            Some("rigid") => Some(Self::Rigid),
            Some("mpm") => Some(Self::Grid),
            _ => None,
        }
    }

    /// Returns the cause of the error that remains at the finest resolution.
    #[must_use]
    pub const fn floor(self) -> &'static str {
        match self {
            Self::Dem => "compliance of the contact",
            Self::Rigid => "the engine's own overlap and order of contacts",
            Self::Grid => "deformability, and contact as soft as a cell",
        }
    }
}

/// Deliberate defect of a solver, for a negative control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    /// All contacts lose their history after every step.
    ForgetsHistory,
}

/// Reason why a simulation broke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A position or velocity is NaN or infinite.
    NotFinite,
    /// A grain moved more than its radius in one step.
    Runaway {
        /// Displacement in the step (m).
        moved: f64,
        /// Radius (m).
        radius: f64,
    },
    /// A contact became so stiff that the time step exceeds the critical one.
    StiffContact {
        /// Stiffness of the contact springs (N/m).
        stiffness: f64,
    },
    /// A grain rotated so far in one step that the direction of friction is lost.
    Spun {
        /// Rotation in the step (rad).
        turned: f64,
    },
    /// A material point moved more than a cell in one step.
    LeftCell {
        /// Displacement in the step (m).
        moved: f64,
        /// Length of a cell (m).
        cell: f64,
    },
    /// A material point was inverted.
    Inverted {
        /// Volume relative to the initial volume.
        volume_ratio: f64,
    },
    /// A cell lost all its volume in one step.
    CollapsedCell {
        /// Volume after the step relative to the volume before it.
        volume_ratio: f64,
    },
    /// A material point became so stiff that a wave crosses a cell in less than a time step.
    Stiffened {
        /// Present time in which the fastest wave crosses a cell (s).
        crossing: f64,
        /// Fastest wave's time across a cell at the start (s).
        at_start: f64,
    },
    /// A closed system gained energy without a source.
    GainedEnergy {
        /// Energy gained since the start (J; J/m for discs).
        gained: f64,
        /// Largest allowed gain (J; J/m for discs).
        allowed: f64,
    },
    /// A surface starts so deep inside another surface that the contact springs would eject it.
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
    LeftGrid {
        /// Number of cells required.
        cells: f64,
    },
    /// A poured grain was inserted at the position of another grain.
    CameIntoGrain {
        /// Id of the other grain, from 1.
        other: u32,
        /// Overlap relative to the smaller radius.
        ratio: f64,
    },
    /// A poured grain was inserted at the position of a wall.
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

impl fmt::Display for Cause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(formatter, "its state is not finite"),
            Self::Runaway { moved, radius } => {
                write!(formatter, "it moved {moved:.3e} m in one step, more than its radius {radius:.3e} m")
            }
            Self::StiffContact { stiffness } => {
                write!(
                    formatter,
                    "one of its contacts became so stiff, {stiffness:.3e} N/m, that the time step is above the \
                     critical one"
                )
            }
            Self::Spun { turned } => write!(formatter, "it turned by {turned:.3e} rad in one step"),
            Self::LeftCell { moved, cell } => {
                write!(formatter, "it moved {moved:.3e} m in one step, more than a cell of {cell:.3e} m")
            }
            Self::Inverted { volume_ratio } => {
                write!(formatter, "it was turned inside out: its volume is {volume_ratio:.3e} of that at the start")
            }
            Self::CollapsedCell { volume_ratio } => {
                write!(formatter, "its cell collapsed: one step changed its volume by a factor {volume_ratio:.3e}")
            }
            Self::Stiffened { crossing, at_start } => write!(
                formatter,
                "it was deformed until the fastest wave crossed a cell in {crossing:.4e} s ({at_start:.4e} s at the \
                 start), less than the time step"
            ),
            Self::GainedEnergy { gained, allowed } => write!(
                formatter,
                "it is the fastest in a run that has gained {gained:.4e} J since the start, which nothing supplied; at \
                 most {allowed:.4e} J is allowed"
            ),
            Self::StartsInside { depth, strain, allowed } => write!(
                formatter,
                "it starts {depth:.4e} m inside another surface; the springs would expel it in a shock with a strain \
                 of {strain:.3}, more than {allowed}"
            ),
            Self::LeftGrid { cells } => write!(formatter, "it left the grid, which would need {cells:.3e} cells"),
            Self::CameIntoGrain { other, ratio } => write!(
                formatter,
                "it was poured into grain {other}, which it overlaps by {ratio:.3} of the smaller radius: a poured \
                 grain needs room in its box at its time, and other grains may have piled up there"
            ),
            Self::CameIntoWall { wall, ratio } => write!(
                formatter,
                "it was poured into wall {wall} of the scene, which it overlaps by {ratio:.3} of its radius: a poured \
                 grain needs room in its box at its time"
            ),
        }
    }
}

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

/// Size of a run, which is known before the first step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunOutline {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Number of grains or material points in each step.
    pub particles: u64,
}

/// Options of a run, fixed before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// Number of threads, for solvers that can use several. The record is the same for any number, bit for bit.
    pub threads: usize,
    /// Number of steps between checkpoints; `None` for no checkpoints.
    pub checkpoint_interval: Option<u64>,
    /// Largest number of rows (grains, contacts and material points) of a snapshot. A snapshot with more rows is not
    /// created. Instead, [`Observer::in_short`] receives a summary.
    pub most_rows: u64,
    /// True if a run may have a time step at or above the critical one.
    pub allow_unstable: bool,
    /// True if the record contains every snapshot.
    pub keep_snapshots: bool,
    /// True if the observer requests the final state, from which another scene can start.
    pub end_state: bool,
}

impl RunOptions {
    /// One thread, no checkpoints, all snapshots in the record.
    pub const DEFAULT: Self = Self {
        threads: 1,
        checkpoint_interval: None,
        most_rows: u64::MAX,
        allow_unstable: false,
        keep_snapshots: true,
        end_state: false,
    };

    /// Returns the default options, except that time steps at or above the critical one are allowed.
    #[must_use]
    pub const fn unstable() -> Self {
        Self { allow_unstable: true, ..Self::DEFAULT }
    }
}

impl Default for RunOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Receiver of samples, snapshots and checkpoints during a run.
pub trait Observer {
    /// Returns the options of the run.
    fn options(&self) -> RunOptions {
        RunOptions::DEFAULT
    }
    /// Receives the size of the run, once before the first step.
    fn begin(&mut self, _ahead: RunOutline) {}
    /// Receives the number of completed steps and the total number, repeatedly during the run.
    fn progress(&mut self, _done: u64, _total: u64) {}
    /// Receives every snapshot, in order of time. If the snapshot is returned, the record and the checkpoints of the
    /// run contain it. If `None` is returned, they do not, and memory holds one snapshot at a time.
    ///
    /// # Errors
    /// When the snapshot cannot be stored. The run ends with this error.
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        Ok(Some(snapshot))
    }
    /// Receives the summary and the number of rows of a snapshot that has more than [`RunOptions::most_rows`] rows.
    /// [`Observer::snapshot`] is not called for this snapshot.
    fn in_short(&mut self, _brief: Brief, _rows: u64) {}
    /// Receives the final state from solvers that provide it.
    fn end_state(&mut self, _state: EndState) {}
    /// Returns true if the run must end early. The main loop calls this function before each progress report.
    fn is_over(&self) -> bool {
        false
    }
    /// Receives the partial output of a run that broke or was interrupted.
    fn broke(&mut self, _remains: PartialOutput) {}
    /// Receives every checkpoint.
    ///
    /// # Errors
    /// When the checkpoint cannot be stored. The run ends with this error.
    fn checkpoint(&mut self, _checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        Ok(())
    }
}

/// Observer that does nothing.
impl Observer for () {}

/// Observer that only has options.
impl Observer for RunOptions {
    fn options(&self) -> RunOptions {
        *self
    }
}

/// Solver, internal or external.
pub trait Solver: Send + Sync {
    /// Returns the name and the convention, such as `dem:lammps`.
    fn name(&self) -> String;

    /// Checks that the solver can run on this machine. Our own solvers always can.
    ///
    /// # Errors
    /// When the solver is an external program that is not installed: [`RunError::NotAvailable`].
    fn available(&self) -> Result<(), RunError> {
        Ok(())
    }

    /// Returns true if contacts of the solver have the springs and dashpots of the scene. Claims about springs and
    /// dashpots are not evaluated for solvers with rigid contacts.
    fn has_springs(&self) -> bool {
        true
    }

    /// Returns true if bodies deform in the solver. Claims about the interior of bodies, or about the effect of
    /// deformation on motion, are evaluated only for solvers with deformable bodies.
    fn deforms(&self) -> bool {
        false
    }

    /// Runs a scene.
    ///
    /// # Errors
    /// When the scene is not supported, the resolution is not valid, or the simulation breaks.
    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError>;

    /// Continues a run of the same scene at the same resolution from one of its checkpoints. The record equals that of
    /// an uninterrupted run in every bit except for wall-clock times.
    ///
    /// # Errors
    /// When [`Solver::run`] fails, the checkpoint belongs to another run, or the solver writes no checkpoints.
    fn restart(
        &self,
        _scene: &Scene,
        _resolution: &Resolution,
        _from: &Checkpoint,
        _observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        let reason = "it writes no checkpoints".to_owned();
        Err(RunError::Unsupported { solver: self.name(), reason })
    }
}
