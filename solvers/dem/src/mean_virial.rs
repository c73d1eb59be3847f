//! Time average of V σ (volume times stress) of every grain between two snapshots. Instantaneous values would be
//! aliased, because a collision is shorter than the time between snapshots.

use grainbench_scene::scene::Grain;
use grainbench_solver::record::{ContactState, GrainState};
use grainbench_solver::virial;
use serde::{Deserialize, Serialize};

/// Sums of V σ (volume times stress) of every grain since the last snapshot.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct MeanVirial {
    /// Number of steps between samples.
    every: u64,
    /// Sum of V σ for each grain of the scene, by its index (J). The components are xx, yy, zz, xy, yz and zx.
    sums: Vec<[f64; 6]>,
    /// Number of samples in the sums. Absent grains contribute nothing to them.
    steps: u64,
}

impl MeanVirial {
    pub(crate) fn new(grains: usize, every: u64) -> Self {
        Self { every, sums: vec![[0.0; 6]; grains], steps: 0 }
    }

    /// Returns true if two sums have the same number of grains and the same sampling interval.
    pub(crate) fn is_of(&self, begun: &Self) -> bool {
        self.every == begun.every && self.sums.len() == begun.sums.len()
    }

    /// Returns true if a step is sampled.
    pub(crate) const fn is_due(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Adds a sample. The order of the contacts does not depend on the number of threads, so the sums do not depend on
    /// the number of threads either.
    pub(crate) fn add<'c>(&mut self, contacts: impl Iterator<Item = &'c ContactState>, grains: &[Grain]) {
        self.steps += 1;
        for contact in contacts {
            for id in virial::touching(contact) {
                let place = id as usize - 1;
                virial::add(&mut self.sums[place], contact, grains[place].radius);
            }
        }
    }

    /// Stores the averages in the grains and clears the sums. Without samples, it does nothing.
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
