//! The last snapshot of a run in short: what is told of it without having it read back.

use grainbench_scene::record::Snapshot;
use serde::{Deserialize, Serialize};

/// A snapshot in short.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct End {
    /// Step.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Number of grains.
    pub grains: usize,
    /// Number of contacts; absent where nobody told them.
    pub contacts: Option<usize>,
    /// How many of them slip.
    pub slipping_contacts: Option<usize>,
    /// Sum of ½mv² over the grains (J).
    pub kinetic_energy: f64,
    /// Largest speed of a grain (m/s).
    pub fastest: f64,
}

impl End {
    /// Of a snapshot.
    pub(super) fn of(snapshot: &Snapshot) -> Self {
        let (grains, contacts) = (&snapshot.grains, snapshot.contacts.as_ref());
        Self {
            step: snapshot.step,
            time: snapshot.time,
            grains: grains.len(),
            contacts: contacts.map(Vec::len),
            slipping_contacts: contacts.map(|all| all.iter().filter(|contact| contact.slipping).count()),
            kinetic_energy: grains.iter().map(|grain| 0.5 * grain.mass * grain.velocity.norm_squared()).sum(),
            fastest: grains.iter().map(|grain| grain.velocity.norm()).fold(0.0, f64::max),
        }
    }
}
