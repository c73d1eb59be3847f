//! Parameters of a run that do not change between steps.

use crate::options::{Contact, Setting, StressUpdate};
use grainbench_lanes::Processor;
use grainbench_solver::space::Space;

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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings<S: Space> {
    /// Gravity g (m/s²).
    pub(crate) gravity: S::Vector,
    /// Mass-proportional damping α (1/s).
    pub(crate) damping: f64,
}
