//! What a solver is: something that takes a scene and a resolution and leaves a record.

use crate::brief::Brief;
use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::end_state::EndState;
use crate::record::{Record, Remains, Snapshot};
use crate::scene::{Duration, Scene};
use nalgebra::Vector3;
use std::fmt;
use thiserror::Error;

/// How finely a solver works: a resolution level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Time step as a fraction of the critical one, `2√(m_min/k_max)`. Where the scene lasts a number of seconds the
    /// step is shortened so that a whole number of steps fits.
    CriticalFraction(f64),
    /// Time step (s), taken as it is.
    TimeStep(f64),
    /// Of engines for rigid bodies, whose contacts have no critical step. The step is shortened so that a whole number
    /// of steps fits.
    Rigid {
        /// Step (s) that is divided into substeps.
        step: f64,
        /// Time steps in it.
        substeps: u32,
        /// Iterations of the constraint solver in each time step.
        iterations: u32,
    },
    /// Of methods with a grid. The step is shortened so that a whole number of steps fits.
    Grid {
        /// Cells per reference length of the scene: of a grain's radius, where there are grains.
        cells: f64,
        /// Material points per cell and axis.
        points: u32,
        /// Courant number: step over the time that a longitudinal wave takes through a cell, c Δt/h.
        courant: f64,
    },
}

impl Resolution {
    /// Step of an engine for rigid bodies (s), unless another one is asked for: sixty a second, as pictures are drawn.
    pub const RIGID_STEP: f64 = 1.0 / 60.0;
    /// Iterations of its constraint solver, unless others are asked for.
    pub const RIGID_ITERATIONS: u32 = 4;

    /// Courant number of a method with a grid, unless another one is asked for.
    pub const COURANT: f64 = 0.4;

    /// Part of the critical step that a command line takes where none is said.
    pub const FRACTION: f64 = 0.1;

    /// Cells per reference length that it takes.
    pub const CELLS: f64 = 8.0;

    /// Material points per cell and axis that it takes.
    pub const POINTS: u32 = 3;

    /// Substeps of a step of rigid bodies that it takes.
    pub const SUBSTEPS: u32 = 8;

    /// Cells per reference length and points per cell and axis of a method with a grid, all else as usual.
    #[must_use]
    pub const fn grid(cells: f64, points: u32) -> Self {
        Self::Grid { cells, points, courant: Self::COURANT }
    }

    /// Substeps of an engine for rigid bodies, all else as usual.
    #[must_use]
    pub const fn substeps(substeps: u32) -> Self {
        Self::Rigid { step: Self::RIGID_STEP, substeps, iterations: Self::RIGID_ITERATIONS }
    }

    /// The resolution with steps or cells this many times as long; none of substeps that would be less than one.
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

    /// Time step (s) and number of steps of a scene, for solvers that take time steps.
    ///
    /// # Errors
    /// Says what is wrong: the resolution is no time step, or the scene has no critical one to take a fraction of.
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
        if let Some(refusal) = beyond_steps(asked) {
            return Err(refusal);
        }
        Ok(match (scene.duration, self) {
            (Duration::Cycles(cycles), _) => (wanted, cycles),
            (Duration::Seconds(time), Self::TimeStep(_)) => (wanted, ((time / wanted).round() as u64).max(1)),
            (Duration::Seconds(time), _) => whole_steps(time, wanted),
        })
    }

    /// Time step (s) and number of steps of a scene on a grid: the Courant number times [`Scene::crossing_time`], shortened so
    /// that a whole number of steps fits.
    ///
    /// # Errors
    /// Says what is wrong: the resolution is no grid, nothing in the scene deforms, or it lasts a number of cycles.
    pub fn steps_on_grid(&self, scene: &Scene) -> Result<(f64, u64), String> {
        let Self::Grid { cells, courant, .. } = *self else {
            return Err(format!("expected cells of a grid, found {self}"));
        };
        let Duration::Seconds(time) = scene.duration else {
            return Err("expected a duration in seconds, found cycles".to_owned());
        };
        let wanted = courant * scene.crossing_time(scene.reference_length / cells);
        if !(wanted.is_finite() && wanted > 0.0) {
            return Err(format!("expected a material that deforms and positive numbers, found none at {self}"));
        }
        beyond_steps(time / wanted).map_or_else(|| Ok(whole_steps(time, wanted)), Err)
    }
}

/// A whole number of steps of at most a length (s) in a time (s), and how long they are then. The slack keeps a ratio that is
/// whole but for rounding from gaining one.
fn whole_steps(time: f64, wanted: f64) -> (f64, u64) {
    let steps = (time / wanted * (1.0 - 1e-12)).ceil().max(1.0);
    (time / steps, steps as u64)
}

/// Most steps that any solver takes: at a million a second they would take thirty years.
const MOST_STEPS: f64 = 1e15;

/// What is wrong with so many steps; none where they can be taken.
#[must_use]
pub fn beyond_steps(steps: f64) -> Option<String> {
    (steps.is_nan() || steps >= MOST_STEPS)
        .then(|| format!("expected fewer than {MOST_STEPS:e} steps, found {steps:.3e}"))
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

/// A number to four significant digits, without zeros that say nothing.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A kind of solver, by what its resolution is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Grains on springs: a time step.
    Dem,
    /// Rigid grains: substeps and iterations.
    Rigid,
    /// Deformable grains on a grid: cells and points.
    Grid,
}

impl Method {
    /// The kind of a solver of ours, by name.
    #[must_use]
    pub fn of(solver: &str) -> Option<Self> {
        match solver.split([':', '+']).next() {
            Some("dem") => Some(Self::Dem),
            Some("rigid") => Some(Self::Rigid),
            Some("mpm") => Some(Self::Grid),
            _ => None,
        }
    }

    /// What is left of an error when the resolution is as fine as one likes.
    #[must_use]
    pub const fn floor(self) -> &'static str {
        match self {
            Self::Dem => "compliance of the contact",
            Self::Rigid => "the engine's own overlap and order of contacts",
            Self::Grid => "deformability, and contact as soft as a cell",
        }
    }
}

/// A defect that a solver has built in on purpose, for negative controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    /// Every contact forgets its history after every step.
    ForgetsHistory,
}

/// Why a simulation broke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A position or velocity is not a number or infinite.
    NotFinite,
    /// A grain moved farther than its radius in one step.
    Runaway {
        /// Distance moved in the step (m).
        moved: f64,
        /// Its radius (m).
        radius: f64,
    },
    /// A contact became so stiff that the time step is above the critical one.
    StiffContact {
        /// Stiffness of its springs (N/m).
        stiffness: f64,
    },
    /// A grain turned so far in one step that the direction of friction is lost.
    Spun {
        /// Angle turned in the step (rad).
        turned: f64,
    },
    /// A material point moved farther than a cell in one step.
    LeftCell {
        /// Distance moved in the step (m).
        moved: f64,
        /// Length of a cell (m).
        cell: f64,
    },
    /// A material point was turned inside out.
    Inverted {
        /// Its volume over that at the start.
        volume_ratio: f64,
    },
    /// A cell lost all its volume in one step.
    CollapsedCell {
        /// Volume after the step over volume before.
        volume_ratio: f64,
    },
    /// A material point has become so stiff that a wave takes less than a time step through a cell.
    Stiffened {
        /// Time that the fastest wave takes through a cell now (s).
        crossing: f64,
        /// The same at the start (s).
        at_start: f64,
    },
    /// A closed run has gained energy that nothing supplied.
    GainedEnergy {
        /// Energy gained since the start (J; J/m of discs).
        gained: f64,
        /// Largest gain that passes (J; J/m of discs).
        allowed: f64,
    },
    /// A surface starts so deep in another one that it is thrown out.
    StartsInside {
        /// Overlap (m).
        depth: f64,
        /// Strain of the surface layer that bears the springs of the overlap.
        strain: f64,
        /// Largest strain that passes.
        allowed: f64,
    },
    /// Bodies have spread farther than a grid can follow.
    LeftGrid {
        /// Cells that would be needed.
        cells: f64,
    },
    /// A grain that is poured came where another one was.
    CameIntoGrain {
        /// The other one, by id from 1.
        other: u32,
        /// Overlap over the smaller radius.
        ratio: f64,
    },
    /// A grain that is poured came where a wall was.
    CameIntoWall {
        /// The wall, from 1 in the order of the file.
        wall: u16,
        /// Overlap over its radius.
        ratio: f64,
    },
}

/// Overlap over the smaller radius at which a grain that comes has no room: as much as a scene may begin with.
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
                    "a contact of it became so stiff, {stiffness:.3e} N/m, that the time step is above the critical one"
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
                "it was deformed until the fastest wave took {crossing:.4e} s through a cell, {at_start:.4e} s at the start, and \
                 less than the time step"
            ),
            Self::GainedEnergy { gained, allowed } => write!(
                formatter,
                "it moves fastest in a run that has gained {gained:.4e} J since the start, which nothing supplied, more than \
                 {allowed:.4e} J"
            ),
            Self::StartsInside { depth, strain, allowed } => write!(
                formatter,
                "it starts {depth:.4e} m inside another surface, which springs push out with a strain of {strain:.3} in a shock, \
                 more than {allowed}"
            ),
            Self::LeftGrid { cells } => write!(formatter, "it left the grid, which would need {cells:.3e} cells"),
            Self::CameIntoGrain { other, ratio } => write!(
                formatter,
                "it was poured into grain {other}, which it overlaps by {ratio:.3} of the smaller radius: what is poured needs \
                 room in its box when it comes, whatever stands or falls there by then"
            ),
            Self::CameIntoWall { wall, ratio } => write!(
                formatter,
                "it was poured into wall {wall} of the scene, which it overlaps by {ratio:.3} of its radius: what is poured \
                 needs room in its box when it comes"
            ),
        }
    }
}

/// What broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A grain, by id from 1.
    Grain(u32),
    /// A material point of a grain, by id of the grain from 1.
    PointOfGrain(u32),
    /// A material point of a body that is no grain, by place of the body from 1.
    PointOfBody(u32),
}

impl fmt::Display for Subject {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grain(id) => write!(formatter, "grain {id}"),
            Self::PointOfGrain(id) => write!(formatter, "a material point of grain {id}"),
            Self::PointOfBody(place) => write!(formatter, "a material point of body {place}"),
        }
    }
}

/// A simulation that broke: when, where and why, and what would have been stable.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "the simulation broke at t = {time:.6e} s (step {step}): {subject} at ({:.4e}, {:.4e}, {:.4e}) m: {cause}; the time step \
     was {time_step:.4e} s{}; {advice}",
    position.x, position.y, position.z, of_critical(*time_step, *critical)
)]
pub struct Broken {
    /// Time (s).
    pub time: f64,
    /// Step.
    pub step: u64,
    /// What broke.
    pub subject: Subject,
    /// Where it was last (m).
    pub position: Vector3<f64>,
    /// Why.
    pub cause: Cause,
    /// Time step (s).
    pub time_step: f64,
    /// Critical time step (s).
    pub critical: f64,
    /// What would have been stable.
    pub advice: String,
}

/// A time step (s) beside the critical one (s), where there is one.
fn of_critical(time_step: f64, critical: f64) -> String {
    if critical.is_finite() {
        format!(", {:.3} of the critical {critical:.4e} s", time_step / critical)
    } else {
        String::new()
    }
}

/// Why a solver left no record.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The solver cannot express this scene.
    #[error("{solver} cannot run this scene: {reason}")]
    Unsupported {
        /// Which solver.
        solver: String,
        /// What it lacks.
        reason: String,
    },
    /// A quantity is no finite number any more, though every grain is where it can be.
    #[error("the simulation broke at t = {time:.6e} s (step {step}): `{column}` became {value}")]
    NotFinite {
        /// Time (s).
        time: f64,
        /// Step.
        step: u64,
        /// The column of the series.
        column: String,
        /// What it became.
        value: f64,
    },
    /// The resolution makes no sense for this solver.
    #[error("{solver}: {reason}")]
    Resolution {
        /// Which solver.
        solver: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The solver is a program that is not here.
    #[error("{solver} is not available: {reason}")]
    NotAvailable {
        /// Which solver.
        solver: String,
        /// Where it was looked for.
        reason: String,
    },
    /// The record would have been a stored one, and that is of another scene.
    #[error("{solver}: the stored run is stale: {reason}")]
    Stale {
        /// Which solver.
        solver: String,
        /// What is to be done.
        reason: String,
    },
    /// The solver is a program that failed.
    #[error("{solver} {failure}{}", last_words(last_lines))]
    Program {
        /// Which solver.
        solver: String,
        /// How it failed.
        failure: Failure,
        /// The last lines that it printed.
        last_lines: Vec<String>,
    },
    /// The simulation broke.
    #[error(transparent)]
    Broken(#[from] Box<Broken>),
    /// Who watches wanted it to end.
    #[error("the simulation was interrupted at t = {time:.6e} s (step {step})")]
    Interrupted {
        /// Time (s).
        time: f64,
        /// Step.
        step: u64,
    },
    /// A snapshot could not be stored.
    #[error(transparent)]
    NotStored(#[from] NotStored),
    /// It cannot be continued from this checkpoint, or its own checkpoint cannot be left.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// What a watcher could not store, and why.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct NotStored(pub String);

/// How another program failed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Failure {
    /// It could not be started, or its folder not be made.
    #[error("could not be run: {0}")]
    NotRun(String),
    /// It took too long and was ended, or what it left took too long to read.
    #[error("was not done after {0} s")]
    TimeOut(u64),
    /// It ended with another code than success.
    #[error("failed: {0}")]
    Crash(String),
    /// What it left cannot be used.
    #[error("left output that cannot be used: {0}")]
    Output(String),
}

fn last_words(lines: &[String]) -> String {
    if lines.is_empty() { String::new() } else { format!("; it said last: {}", lines.join(" | ")) }
}

/// What lies ahead of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Grains, or material points, that take each of them.
    pub particles: u64,
}

/// Someone who wants to know how far a run is.
pub trait Watch {
    /// Called once, before the first step.
    fn begin(&mut self, _ahead: Ahead) {}
    /// Threads that the run may take, of solvers that share their work among threads; asked for once. The record does not
    /// depend on it in any bit.
    fn threads(&self) -> usize {
        1
    }
    /// Called now and then with the number of steps done and to do.
    fn progress(&mut self, done: u64, total: u64);
    /// Steps from one checkpoint to the next; asked for once, after [`Watch::begin`]. None when no checkpoint is
    /// wanted.
    fn checkpoint_interval(&self) -> Option<u64> {
        None
    }
    /// Called with every snapshot, in order of time. What is handed back stays in the record of the run and in its
    /// checkpoints; what the watcher takes is in neither, and memory then holds one snapshot at a time.
    ///
    /// # Errors
    /// When it cannot be stored: the run ends with this error.
    fn snapshot(&mut self, snapshot: Snapshot) -> Result<Option<Snapshot>, NotStored> {
        Ok(Some(snapshot))
    }
    /// Rows of grains, contacts and points up to which a snapshot is wanted; asked for before the first step. Of one with more
    /// [`Watch::in_short`] is called, and what it would take in memory is not taken.
    fn most_rows(&self) -> u64 {
        u64::MAX
    }
    /// Called in place of [`Watch::snapshot`] with one that is not wanted, and the rows it would have.
    fn in_short(&mut self, _brief: Brief, _rows: u64) {}
    /// Whether a run goes on where its time step is above the critical one.
    fn allows_unstable(&self) -> bool {
        false
    }
    /// Whether every snapshot stays in the record.
    fn keeps_snapshots(&self) -> bool {
        true
    }
    /// Whether the state at the end is wanted, for another scene to begin with.
    fn wants_end_state(&self) -> bool {
        false
    }
    /// Called with the state at the end, of solvers that tell it.
    fn end_state(&mut self, _state: EndState) {}
    /// Whether the run is to end early; asked whenever progress is told.
    fn is_over(&self) -> bool {
        false
    }
    /// Called when the simulation broke or was ended, with what there is of it.
    fn broke(&mut self, _remains: Remains) {}
    /// Called with every checkpoint.
    ///
    /// # Errors
    /// When it cannot be stored: the run ends with this error.
    fn checkpoint(&mut self, _checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        Ok(())
    }
}

/// Nobody watches.
impl Watch for () {
    fn progress(&mut self, _done: u64, _total: u64) {}
}

/// Nobody watches, and the run may take so many threads.
pub struct Threads(pub usize);

impl Watch for Threads {
    fn threads(&self) -> usize {
        self.0
    }
    fn progress(&mut self, _done: u64, _total: u64) {}
}

/// A run that goes on where its time step is above the critical one.
pub struct Unstable;

impl Watch for Unstable {
    fn progress(&mut self, _done: u64, _total: u64) {}
    fn allows_unstable(&self) -> bool {
        true
    }
}

/// A solver, ours or anyone's.
pub trait Solver: Send + Sync {
    /// Name and convention, such as `dem:lammps`.
    fn name(&self) -> String;

    /// Whether it can be run on this machine. Solvers of ours always can.
    ///
    /// # Errors
    /// When it is a program that is not here: [`RunError::NotAvailable`].
    fn available(&self) -> Result<(), RunError> {
        Ok(())
    }

    /// Whether its contacts have the springs and dashpots of a scene. Of one with rigid contacts rows are not asked that look
    /// at those.
    fn has_springs(&self) -> bool {
        true
    }

    /// Whether its bodies deform: rows that look inside bodies, or at what deformation makes of a motion, are asked of such a
    /// solver alone.
    fn deforms(&self) -> bool {
        false
    }

    /// Runs a scene.
    ///
    /// # Errors
    /// When the scene cannot be expressed, the resolution makes no sense, or the simulation breaks.
    fn run(&self, scene: &Scene, resolution: &Resolution, watch: &mut dyn Watch) -> Result<Record, RunError>;

    /// Continues a run of the same scene at the same resolution from a checkpoint that it left. The record is that of
    /// the whole run, in every bit but its times.
    ///
    /// # Errors
    /// As for [`Solver::run`], and when the checkpoint belongs to another run. A solver that leaves no checkpoints
    /// refuses.
    fn restart(
        &self,
        _scene: &Scene,
        _resolution: &Resolution,
        _from: &Checkpoint,
        _watch: &mut dyn Watch,
    ) -> Result<Record, RunError> {
        let reason = "it leaves no checkpoints to continue from".to_owned();
        Err(RunError::Unsupported { solver: self.name(), reason })
    }
}
