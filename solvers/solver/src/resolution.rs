//! Resolution of a solver, and the time step and the number of steps that follow from it.

use crate::limits::beyond_run;
use grainbench_scene::scene::{Duration, Scene};
use std::fmt;

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
