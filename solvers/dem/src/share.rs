//! Thread partition of the neighbour list. A partition contains the pairs of its own rows, and pairs of other rows
//! whose partner is one of its grains.
//!
//! A pair of grains from two partitions is in both partitions. Each partition computes the force of this pair for its own
//! grain, from the same numbers. The forces on a grain are summed in the order of the whole list, so the result does not
//! depend on the number of partitions.

use crate::contact::Terms;
use crate::contact::chain::Layout;
use crate::contact::options::Options;
use crate::forces::Forces;
use crate::geometry::Geometry;
use crate::grains::{GrainTables, Sums};
use crate::laws::Laws;
use crate::listed::{BLOCK, Pairs};
use crate::seen::RecordedContacts;
use crate::touching::{ContactList, blocks};
use grainbench_lanes::{Processor, Team};
use grainbench_scene::scene::Scene;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Smallest number of grains in a partition. With fewer grains, threads wait for each other longer than they work.
pub(crate) const FEWEST: usize = 500;

/// Threads of a run.
pub(crate) struct Threads {
    pub(crate) team: Team,
    /// Smallest number of grains in a partition.
    pub(crate) fewest: usize,
}

impl Threads {
    /// Returns the number of partitions for `grains` grains: one per thread, or fewer for few grains.
    pub(crate) fn partitions(&self, grains: usize) -> usize {
        self.team.members().min(grains / self.fewest).max(1)
    }
}

/// Part of the neighbour list that one thread processes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ThreadPartition {
    /// Own rows of the list. A row has the slot of its grain as index.
    pub(crate) rows: Range<usize>,
    /// Nearby pairs inside the domain.
    pub(crate) near: PairList,
    /// Nearby pairs across a periodic face.
    pub(crate) across: PairList,
}

/// Listed pairs of a partition, which a force evaluation processes block by block. Checkpoints contain only the pairs, and
/// not the working memory of evaluations.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct PairList {
    pub(crate) pairs: Pairs,
    /// Pairs in contact in the present block.
    #[serde(skip)]
    touching: ContactList,
    /// Contacts that the last force evaluation recorded.
    #[serde(skip)]
    pub(crate) seen: RecordedContacts,
    /// Index of the history of each pair in its block, if this is the previous list.
    #[serde(skip)]
    places: Vec<u32>,
}

/// Contact laws of a scene with the options of the convention, and the loops over contacts compiled for them.
pub(crate) struct ContactModel<S: Geometry> {
    laws: Laws,
    options: Options,
    pub(crate) loops: Box<dyn Forces<S>>,
    /// Instruction set of the loops over contacts.
    pub(crate) processor: Processor,
}

impl<S: Geometry> ContactModel<S> {
    pub(crate) fn new(scene: &Scene, loops: Box<dyn Forces<S>>, options: Options) -> Self {
        Self { laws: Laws::new(scene, &options), options, loops, processor: Processor::new() }
    }

    /// Returns the parameters of an evaluation at a time `elapsed` (s) after the last one. With `record`, contacts are
    /// recorded.
    pub(crate) fn terms(&self, elapsed: f64, record: bool) -> Terms<'_> {
        Terms { laws: &self.laws, options: &self.options, elapsed, record }
    }
}

/// Parameters of a force evaluation.
pub(crate) struct Evaluation<'a, S: Geometry> {
    /// Contact laws and the loops over contacts.
    pub(crate) model: &'a ContactModel<S>,
    /// Parameters common to all contacts.
    pub(crate) terms: Terms<'a>,
    /// True if contacts are recorded individually, not only their energies.
    pub(crate) one_by_one: bool,
}

/// Splits rows into partitions of nearly equal size.
pub(crate) fn rows_of(rows: usize, shares: usize) -> Vec<Range<usize>> {
    let shares = shares.clamp(1, rows.max(1));
    (0..shares).map(|share| share * rows / shares..(share + 1) * rows / shares).collect()
}

impl ThreadPartition {
    /// Creates an empty partition of these rows.
    pub(crate) fn new(rows: Range<usize>) -> Self {
        Self { rows, near: PairList::new(Pairs::empty()), across: PairList::new(Pairs::empty()) }
    }

    /// Creates the partition with these rows from the partitions of the whole list. It contains the pairs in `rows`,
    /// and pairs in other rows whose partner is in `rows`.
    pub(crate) fn reaching(shares: &[Self], rows: Range<usize>) -> Self {
        let chosen = |pairs_of: fn(&Self) -> &Pairs| {
            let lists: Vec<&Pairs> = shares.iter().map(pairs_of).collect();
            PairList::new(Pairs::chosen(&lists, rows.clone()))
        };
        let (near, across) = (chosen(|share| &share.near.pairs), chosen(|share| &share.across.pairs));
        Self { rows, near, across }
    }

    /// Returns true if the partition covers all `grains` grains and its lists are valid for this layout of the contact
    /// history.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { near: PairList { pairs: near, .. }, across: PairList { pairs: across, .. }, rows } = self;
        let shifted = across.shift.len() == across.partner.len() || across.len() == 0;
        *rows == (0..grains)
            && shifted
            && near.shift.is_empty()
            && near.is_of(grains, layout)
            && across.is_of(grains, layout)
    }

    /// Computes the history index of every pair, for `take_over`.
    pub(crate) fn find_places(&mut self) {
        for list in [&mut self.near, &mut self.across] {
            list.places = list.pairs.places();
        }
    }

    /// Copies the contact history from the `old` partitions, for which `find_places` must have been called. `order`
    /// holds, for the grain in each slot, its slot in the old partitions.
    pub(crate) fn take_over(&mut self, old: &[Self], order: &[u32], layout: &Layout) {
        if old.is_empty() {
            return;
        }
        let found = |a: u32, b: u32| {
            // An inserted grain has no row in the old partitions.
            let share = old.get(old.partition_point(|share| share.rows.end <= a as usize))?;
            let mut lists = [&share.near, &share.across].into_iter();
            lists.find_map(|PairList { pairs, places, .. }| pairs.find(a, b).map(|from| (pairs, (from, places[from]))))
        };
        for pairs in [&mut self.near.pairs, &mut self.across.pairs] {
            for at in 0..pairs.len() {
                let (a, b) = (order[pairs.row[at] as usize], order[pairs.partner[at] as usize]);
                let (found, exchanged) = match found(a, b) {
                    Some(found) => (Some(found), None),
                    None => (found(b, a), Some(layout)),
                };
                if let Some((list, place)) = found.filter(|&(_, (_, place))| place > 0) {
                    pairs.take(at, list, place, exchanged);
                }
            }
        }
    }

    /// Returns the number of pairs in the partition's own rows.
    pub(crate) fn pairs(&self) -> usize {
        self.near.pairs.own().len() + self.across.pairs.own().len()
    }

    /// Computes the forces of the partition's pairs: first pairs across a periodic face, then all other pairs. Returns the
    /// number of contacts in the own rows of the partition.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        evaluation: &Evaluation<'_, S>,
        grains: GrainTables<'_>,
        mut sums: Sums<'_>,
    ) -> u64 {
        let (Self { rows, near, across }, mut contacts) = (self, 0);
        for list in [across, near] {
            for block in list.blocks(evaluation.one_by_one) {
                contacts += list.evaluate(rows, evaluation, grains, sums.lent(), block);
            }
        }
        contacts
    }
}

impl PairList {
    pub(crate) fn new(pairs: Pairs) -> Self {
        Self { pairs, touching: ContactList::default(), seen: RecordedContacts::default(), places: Vec::new() }
    }

    /// Clears the recorded contacts and returns the blocks of pairs, which must be evaluated in order. With
    /// `one_by_one`, contacts are recorded individually.
    pub(crate) fn blocks(&mut self, one_by_one: bool) -> impl Iterator<Item = Range<usize>> + use<> {
        self.seen.begin(one_by_one);
        blocks(self.pairs.len())
    }

    /// Computes the forces of the pairs in a block. Returns the number of contacts in the own rows of the partition.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        rows: &Range<usize>,
        evaluation: &Evaluation<'_, S>,
        grains: GrainTables<'_>,
        sums: Sums<'_>,
        block: Range<usize>,
    ) -> u64 {
        let (Self { pairs, touching, seen, .. }, model) = (self, evaluation.model);
        let number = block.start / BLOCK;
        let (whole, own_pairs) = (0..pairs.len(), pairs.own());
        touching.find::<S>(model.processor, grains.place, pairs, block);
        let contacts = if own_pairs == whole {
            touching.count
        } else {
            touching.first[..touching.count].iter().filter(|&&first| rows.contains(&(first as usize))).count()
        };
        if evaluation.terms.record {
            seen.make_room(touching.count);
        }
        let seen = evaluation.terms.record.then_some(seen);
        let (terms, grains) = (evaluation.terms, (grains, sums));
        model.loops.of_pairs(model.processor, terms, grains, (pairs, number), touching, seen);
        pairs.remember(number, touching.count);
        contacts as u64
    }

    /// Returns the row of the first pair after a block; `None` for the last block. After the evaluation of the block, the
    /// forces on the grains of all earlier rows are complete.
    pub(crate) fn row_after(&self, block: &Range<usize>) -> Option<usize> {
        (block.end < self.pairs.len()).then(|| self.pairs.row[block.end] as usize)
    }
}
