//! Recording of contacts for output, for the energy budget and for the mean stress of grains.

use crate::contact::chain::Energies;
use crate::mean_virial::MeanVirial;
use crate::seen::RecordedContacts;
use crate::share::ThreadPartition;
use grainbench_scene::columns::Chosen;
use grainbench_scene::scene::{Grain, Probe, ProbeTarget, Scene};
use grainbench_solver::record::ContactState;

/// Contacts of the last force evaluation, and the numbers that decide how they are recorded. Contacts between grains are
/// in the partitions of the neighbour list.
pub(crate) struct Recording {
    /// Contacts with walls in the last force evaluation that recorded contacts.
    pub(crate) at_walls: RecordedContacts,
    /// Step at which contacts were last recorded; `None` before the first recording and after `take_contacts` has moved
    /// the contacts out.
    step: Option<u64>,
    /// Largest sum of the numbers of grains and contacts for which individual contacts are recorded.
    most_rows: u64,
    /// True if a probe or the mean stress of grains needs individual contacts at every recorded step.
    needs_contacts: bool,
    /// True if the last recording contains individual contacts, not only their energies.
    pub(crate) one_by_one: bool,
    /// Number of contacts in the last force evaluation.
    pub(crate) contacts: u64,
    /// Sums for the time average of V σ (volume times stress) of each grain; `None` unless snapshots contain this
    /// average.
    pub(crate) mean_virial: Option<Box<MeanVirial>>,
}

impl Recording {
    pub(crate) fn new(scene: &Scene, most_rows: u64) -> Self {
        let averages = scene.columns.has(Chosen::MeanVirial);
        let of_contacts = |probe: &Probe| {
            matches!(probe.target, ProbeTarget::Pair(..) | ProbeTarget::GrainWall(..) | ProbeTarget::Stress)
        };
        let empty_mean_virial = || Box::new(MeanVirial::new(scene.grains.len(), scene.columns.mean_every));
        Self {
            at_walls: RecordedContacts::default(),
            step: None,
            most_rows,
            needs_contacts: averages || scene.probes.iter().any(of_contacts),
            one_by_one: false,
            contacts: 0,
            mean_virial: averages.then(empty_mean_virial),
        }
    }

    /// Starts the recording of the contacts of `grains` grains at a step.
    pub(crate) fn begin(&mut self, step: u64, grains: usize) {
        self.one_by_one = self.needs_contacts || self.rows(grains) <= self.most_rows;
        self.at_walls.begin(self.one_by_one);
        self.step = Some(step);
    }

    /// Returns the number of rows of a snapshot with `grains` grains and the contacts in the last force evaluation.
    pub(crate) fn rows(&self, grains: usize) -> u64 {
        grains as u64 + self.contacts
    }

    /// Returns the energies of the contacts in the last recorded force evaluation.
    pub(crate) fn energies<'a>(&'a self, partitions: &'a [ThreadPartition]) -> impl Iterator<Item = &'a Energies<f64>> {
        let across = partitions.iter().flat_map(|share| &share.across.seen.energies);
        let near = partitions.iter().flat_map(|share| &share.near.seen.energies);
        self.at_walls.energies.iter().chain(across).chain(near)
    }

    /// Returns the number of contacts and the number of slipping contacts in this step; `None` if contacts were not
    /// recorded, or if `take_contacts` has moved them out.
    pub(crate) fn touching(&self, step: u64, partitions: &[ThreadPartition]) -> Option<[usize; 2]> {
        self.step.filter(|&at| at == step)?;
        let lists = partitions.iter().flat_map(|share| [&share.near.seen, &share.across.seen]).chain([&self.at_walls]);
        Some(lists.fold([0, 0], |[count, slipping], seen| [count + seen.energies.len(), slipping + seen.slipping]))
    }

    /// Moves the individual contacts of this step out of the simulation; `None` if they were not recorded or were moved
    /// out before. The contacts are sorted by the id of their first grain. For each grain, contacts with walls come
    /// first, then contacts across periodic faces, then all other contacts.
    pub(crate) fn take_contacts(&mut self, step: u64, partitions: &mut [ThreadPartition]) -> Option<Vec<ContactState>> {
        self.step.take().filter(|&at| at == step && self.one_by_one)?;
        let [mut before, mut contacts] = [std::mem::take(&mut self.at_walls.contacts), Vec::new()];
        for share in &mut *partitions {
            before.append(&mut share.across.seen.contacts);
        }
        // With a single partition, the largest list is moved, not copied.
        for share in partitions {
            let mut others = std::mem::take(&mut share.near.seen.contacts);
            if contacts.is_empty() {
                contacts = others;
            } else {
                contacts.reserve_exact(others.len());
                contacts.append(&mut others);
            }
        }
        let first = before.len();
        contacts.reserve_exact(first);
        contacts.append(&mut before);
        contacts.rotate_right(first);
        contacts.sort_by_cached_key(|contact| contact.grain);
        Some(contacts)
    }

    /// Returns true if the contacts of a step are a sample of the mean of V σ.
    pub(crate) fn is_sampled(&self, step: u64) -> bool {
        self.mean_virial.as_ref().is_some_and(|mean| mean.is_due(step))
    }

    /// Adds the recorded contacts of this step to the sums of V σ, if this step is sampled.
    pub(crate) fn add_virials(&mut self, step: u64, partitions: &[ThreadPartition], grains: &[Grain]) {
        let Self { mean_virial, at_walls, .. } = self;
        if let Some(mean) = mean_virial.as_mut().filter(|mean| mean.is_due(step)) {
            let across = partitions.iter().flat_map(|share| &share.across.seen.contacts);
            let near = partitions.iter().flat_map(|share| &share.near.seen.contacts);
            mean.add(at_walls.contacts.iter().chain(across).chain(near), grains);
        }
    }
}
