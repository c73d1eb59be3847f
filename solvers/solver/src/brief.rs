//! Summary of a snapshot, for runs that do not need the rows of grains and contacts.

use crate::record::{GrainState, Snapshot, StepState};
use serde::{Deserialize, Serialize};

/// Summary of a snapshot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Brief {
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Number of grains.
    pub grains: usize,
    /// Number of contacts; absent if the solver does not report contacts.
    pub contacts: Option<usize>,
    /// Number of slipping contacts; absent if the solver does not report contacts.
    pub slipping_contacts: Option<usize>,
    /// Sum of ½mv² over the grains (J).
    pub kinetic_energy: f64,
    /// Largest speed of a grain (m/s).
    pub fastest: f64,
}

impl Brief {
    /// Returns the summary of grains at a step and its time (s). `touching` is the number of contacts and the number of
    /// slipping contacts, if known.
    #[must_use]
    pub fn of_grains(
        (step, time): (u64, f64),
        grains: impl Iterator<Item = GrainState>,
        touching: Option<[usize; 2]>,
    ) -> Self {
        let [contacts, slipping_contacts] = [0, 1].map(|at| touching.map(|counts| counts[at]));
        let start = Self { step, time, grains: 0, contacts, slipping_contacts, kinetic_energy: 0.0, fastest: 0.0 };
        grains.fold(start, |sum, grain| Self {
            grains: sum.grains + 1,
            kinetic_energy: sum.kinetic_energy + 0.5 * grain.mass * grain.velocity.norm_squared(),
            fastest: sum.fastest.max(grain.velocity.norm()),
            ..sum
        })
    }

    /// Returns the summary of the state of a simulation at one step.
    #[must_use]
    pub fn of_look(look: &StepState) -> Self {
        let Snapshot { step, time, grains, .. } = &look.snapshot;
        Self::of_grains((*step, *time), grains.iter().cloned(), look.touching)
    }

    /// Returns the summary of a snapshot.
    #[must_use]
    pub fn from_snapshot(snapshot: &Snapshot) -> Self {
        let Snapshot { step, time, grains, .. } = snapshot;
        Self::of_grains((*step, *time), grains.iter().cloned(), snapshot.touching())
    }
}
