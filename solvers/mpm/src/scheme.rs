//! How a run is computed, from its first step to its last.

use crate::options::{Contact, Setting, StressUpdate};
use grainbench_lanes::Processor;
use grainbench_scene::space::Space;

/// What does not change in a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scheme {
    pub(crate) setting: Setting,
    /// Time step Δt (s).
    pub(crate) time_step: f64,
    pub(crate) processor: Processor,
}

impl Scheme {
    /// Whether all bodies share one velocity field.
    pub(crate) fn has_one_field(&self) -> bool {
        self.setting.contact == Contact::NoSlip
    }

    /// Whether points bring their new velocities to the nodes once more.
    pub(crate) fn is_projected(&self) -> bool {
        self.setting.stress_update == StressUpdate::ModifiedLast
    }

    /// Whether points move with the velocities that they bring to the nodes once more.
    pub(crate) fn moves_with_stress(&self) -> bool {
        self.setting.moves_with_stress && self.is_projected()
    }

    /// Whether stresses follow before nodes take the step.
    pub(crate) fn has_stress_first(&self) -> bool {
        self.setting.stress_update == StressUpdate::First
    }
}

/// What acts on all bodies alike; something else while they settle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings<S: Space> {
    /// Gravity g (m/s²).
    pub(crate) gravity: S::Vector,
    /// Mass-proportional damping α (1/s).
    pub(crate) damping: f64,
}
