//! Parameters of a run that do not change between steps.

use crate::options::{Contact, Setting, StressUpdate};
use grainbench_lanes::Processor;
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Constant parameters of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scheme {
    pub(crate) setting: Setting,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
    pub(crate) processor: Processor,
}

impl Scheme {
    /// Returns true if all bodies share one velocity field.
    pub(crate) fn has_one_field(&self) -> bool {
        self.setting.contact == Contact::NoSlip
    }

    /// Returns true if points scatter their new velocities to the nodes again.
    pub(crate) fn is_projected(&self) -> bool {
        self.setting.stress_update == StressUpdate::ModifiedLast
    }

    /// Returns true if points move with the projected velocities, which they scatter to the nodes again.
    pub(crate) fn moves_with_stress(&self) -> bool {
        self.setting.moves_with_stress && self.is_projected()
    }

    /// Returns true if stresses are updated before nodes are integrated.
    pub(crate) fn has_stress_first(&self) -> bool {
        self.setting.stress_update == StressUpdate::First
    }
}

/// Gravity and damping of all bodies. They have other values during relaxation.
///
/// The trapezoidal rule for dv/dt = a − αv gives v' = keep v + gain a. The damping force −αρv acts on the velocity and
/// spin of every material point, and not only on the part that nodes represent. Otherwise relative motion of neighbouring
/// points, which the grid does not resolve, would never decay.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings<S: Space> {
    /// Gravity g (m/s²).
    pub(crate) gravity: S::Vector,
    /// Damping factor of velocities in a step, (1 − αΔt/2)/(1 + αΔt/2).
    pub(crate) keep: f64,
    /// Damped time step, Δt/(1 + αΔt/2) (s).
    pub(crate) gain: f64,
}

impl<S: Space> Surroundings<S> {
    /// Computes the factors for a mass-proportional damping α (1/s) and a step of length `time_step` (s).
    pub(crate) fn new(gravity: Vector3<f64>, alpha: f64, time_step: f64) -> Self {
        let half = 0.5 * alpha * time_step;
        let (keep, gain) = ((1.0 - half) / (1.0 + half), time_step / (1.0 + half));
        Self { gravity: S::restrict(gravity), keep, gain }
    }
}
