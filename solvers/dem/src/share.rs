//! Thread partition of the neighbour list. It contains the pairs of some rows, and the pairs of other rows with a grain
//! of the partition.
//!
//! A pair between grains of two partitions is in both. Each partition computes its force for its own grain, from the
//! same numbers. The forces on a grain are summed in the order of the whole list, so the result does not depend on the
//! number of partitions.

use crate::contact::chain::Layout;
use crate::forces::{Forces, Terms};
use crate::geometry::Geometry;
use crate::grains::{GrainTables, Sums};
use crate::listed::{BLOCK, Pairs};
use crate::seen::RecordedContacts;
use crate::touching::{ContactList, blocks};
use grainbench_lanes::Processor;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Smallest number of grains in a partition. With fewer grains, threads wait for each other longer than they work.
pub(crate) const FEWEST: usize = 500;

/// Thread partition of the rows.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ThreadPartition {
    /// Own rows, which are the slots of its grains.
    pub(crate) rows: Range<usize>,
    /// Nearby pairs inside the domain.
    pub(crate) near: Pairs,
    /// Nearby pairs across a periodic face.
    pub(crate) across: Pairs,
    /// Working memory.
    #[serde(skip)]
    work: Work,
}

/// Working memory of a partition between force evaluations.
#[derive(Clone, Debug, Default)]
struct Work {
    /// Pairs in contact of a block.
    touching: [ContactList; 2],
    /// Recorded contacts: of pairs across a face, and of other pairs.
    seen: [RecordedContacts; 2],
    /// Index in the history of every pair: across a face, and of other pairs.
    places: [Vec<u32>; 2],
}

/// Parameters of a force evaluation.
pub(crate) struct Evaluation<'a, S: Geometry> {
    /// Loops over contacts.
    pub(crate) forces: &'a dyn Forces<S>,
    /// Instruction set for these loops.
    pub(crate) processor: Processor,
    /// Parameters common to all contacts.
    pub(crate) terms: Terms<'a>,
    /// True if contacts are recorded.
    pub(crate) record: bool,
    /// True if they are recorded individually.
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
        Self { rows, near: Pairs::empty(), across: Pairs::empty(), work: Work::default() }
    }

    /// Selects the pairs in some rows, and the pairs that involve their grains.
    pub(crate) fn reaching(shares: &[Self], rows: Range<usize>) -> Self {
        let lists = |pairs_of: fn(&Self) -> &Pairs| shares.iter().map(pairs_of).collect::<Vec<_>>();
        let chosen = |lists: &[&Pairs]| Pairs::chosen(lists, rows.clone(), |partner| rows.contains(&partner));
        Self {
            near: chosen(&lists(|share| &share.near)),
            across: chosen(&lists(|share| &share.across)),
            ..Self::new(rows.clone())
        }
    }

    /// Returns true if the partition covers all `grains` grains and its lists are valid for this layout.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { near, across, rows, .. } = self;
        let shifted = across.shift.len() == across.partner.len() || across.len() == 0;
        *rows == (0..grains)
            && shifted
            && near.shift.is_empty()
            && near.is_of(grains, layout)
            && across.is_of(grains, layout)
    }

    /// Finds the index in the history of every pair.
    pub(crate) fn find_places(&mut self) {
        self.work.places = [self.across.places(), self.near.places()];
    }

    /// Takes over the contact history of the `old` partitions, for grains sorted in this `order`. The history indices
    /// must be known.
    pub(crate) fn take_over(&mut self, old: &[Self], order: &[u32], layout: &Layout) {
        if old.is_empty() {
            return;
        }
        let found = |a: u32, b: u32| {
            // A grain inserted since then has no row.
            let share = old.get(old.partition_point(|share| share.rows.end <= a as usize))?;
            let mut lists = [&share.near, &share.across].into_iter().zip(share.work.places.iter().rev());
            lists.find_map(|(list, places)| list.find(a, b).map(|from| (list, (from, places[from]))))
        };
        for pairs in [&mut self.near, &mut self.across] {
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

    /// Clears the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.near.forget();
        self.across.forget();
    }

    /// Returns the number of pairs in the partition's own rows.
    pub(crate) fn pairs(&self) -> usize {
        self.near.own().len() + self.across.own().len()
    }

    /// Returns the recorded contacts: of pairs across a face, and of other pairs.
    pub(crate) fn seen(&self) -> &[RecordedContacts; 2] {
        &self.work.seen
    }

    /// Returns mutable access to the recorded contacts, from which they can be taken.
    pub(crate) fn seen_mut(&mut self) -> &mut [RecordedContacts; 2] {
        &mut self.work.seen
    }

    /// Returns the lists in the order of evaluation: pairs across a face, then other pairs.
    pub(crate) fn lists(&mut self) -> [List<'_>; 2] {
        let Self { rows, near, across, work: Work { touching, seen: [seen_across, seen_near], .. } } = self;
        let [touching_across, touching_near] = touching;
        [
            List { rows: rows.clone(), pairs: across, touching: touching_across, seen: seen_across, own: 0 },
            List { rows: rows.clone(), pairs: near, touching: touching_near, seen: seen_near, own: 0 },
        ]
    }

    /// Computes the forces of the partition's pairs. Returns the number of contacts in its own rows.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        evaluation: &Evaluation<'_, S>,
        grains: GrainTables<'_>,
        mut sums: Sums<'_>,
    ) -> u64 {
        let mut contacts = 0;
        for mut list in self.lists() {
            for block in list.blocks(evaluation.one_by_one) {
                list.evaluate(evaluation, grains, sums.lent(), block);
            }
            contacts += list.own();
        }
        contacts
    }
}

/// List under evaluation, block by block.
pub(crate) struct List<'a> {
    rows: Range<usize>,
    pairs: &'a mut Pairs,
    touching: &'a mut ContactList,
    seen: &'a mut RecordedContacts,
    /// Number of contacts in its own rows so far.
    own: u64,
}

impl List<'_> {
    /// Returns the blocks of pairs, to be evaluated in order. With `one_by_one`, contacts are recorded individually.
    pub(crate) fn blocks(&mut self, one_by_one: bool) -> impl Iterator<Item = Range<usize>> + use<> {
        self.seen.begin(one_by_one);
        blocks(self.pairs.len())
    }

    /// Computes the forces of the pairs in a block.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        evaluation: &Evaluation<'_, S>,
        grains: GrainTables<'_>,
        sums: Sums<'_>,
        block: Range<usize>,
    ) {
        let Self { rows, pairs, touching, seen, own } = self;
        let number = block.start / BLOCK;
        let (whole, own_pairs) = (0..pairs.len(), pairs.own());
        touching.find::<S>(evaluation.processor, grains.place, pairs, block);
        *own += if own_pairs == whole {
            touching.count as u64
        } else {
            touching.first[..touching.count].iter().filter(|&&first| rows.contains(&(first as usize))).count() as u64
        };
        if evaluation.record {
            seen.make_room(touching.count);
        }
        let seen = evaluation.record.then_some(&mut **seen);
        evaluation.forces.of_pairs(
            evaluation.processor,
            evaluation.terms,
            (grains, sums),
            (pairs, number),
            touching,
            seen,
        );
        pairs.remember(number, touching.count);
    }

    /// Returns the row of the first pair after a block; `None` after the last block. All pairs of the grains in earlier
    /// rows have been evaluated.
    pub(crate) fn row_after(&self, block: &Range<usize>) -> Option<usize> {
        (block.end < self.pairs.len()).then(|| self.pairs.row[block.end] as usize)
    }

    /// Returns the number of contacts in its own rows.
    pub(crate) fn own(self) -> u64 {
        self.own
    }
}
