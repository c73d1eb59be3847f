//! V σ of every grain, its mean over the steps between two snapshots: what is seen at an instant is aliased, for a collision is
//! shorter than the time between them.

use grainbench_scene::record::{ContactState, GrainState};
use grainbench_scene::scene::Grain;
use grainbench_scene::virial;
use serde::{Deserialize, Serialize};

/// The sums since the last snapshot.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct MeanVirial {
    /// Steps between those that are looked at.
    every: u64,
    /// Of every grain of the scene, in their order (J).
    sums: Vec<[f64; 6]>,
    /// Steps that they are the sums over. A grain that was not there had none.
    steps: u64,
}

impl MeanVirial {
    pub(crate) fn new(grains: usize, every: u64) -> Self {
        Self { every, sums: vec![[0.0; 6]; grains], steps: 0 }
    }

    /// Whether this is of so many grains, looked at so often.
    pub(crate) fn is_of(&self, begun: &Self) -> bool {
        self.every == begun.every && self.sums.len() == begun.sums.len()
    }

    /// Whether a step is looked at.
    pub(crate) const fn is_due(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Adds a step. The contacts come in an order that does not depend on who found them.
    pub(crate) fn add<'c>(&mut self, contacts: impl Iterator<Item = &'c ContactState>, grains: &[Grain]) {
        self.steps += 1;
        for contact in contacts {
            for id in virial::touching(contact) {
                let place = id as usize - 1;
                virial::add(&mut self.sums[place], contact, grains[place].radius);
            }
        }
    }

    /// Tells grains their means, and begins anew; of no step there is none.
    pub(crate) fn tell(&mut self, grains: &mut [GrainState]) {
        if self.steps == 0 {
            return;
        }
        let share = 1.0 / self.steps as f64;
        for grain in grains {
            grain.mean_virial = Some(Box::new(self.sums[grain.id as usize - 1].map(|sum| sum * share)));
        }
        self.sums.fill([0.0; 6]);
        self.steps = 0;
    }
}
