//! A thread's share of the neighbour list: the pairs of some rows, and those of other rows that reach a grain of its own.
//!
//! A pair between grains of two shares is in both, and both find its force, each for its own grain. They do so from the same
//! numbers, and the sums of a grain are taken in the order of the whole list: so the bits do not depend on how many share it.

use crate::contact::chain::Layout;
use crate::forces::{Forces, Terms};
use crate::geometry::Geometry;
use crate::grains::{Read, Sums};
use crate::listed::{BLOCK, Pairs};
use crate::seen::Seen;
use crate::touching::{Touching, blocks};
use grainbench_lanes::Processor;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Fewest grains in a share: with fewer threads wait for one another longer than they work.
pub(crate) const FEWEST: usize = 500;

/// A share of the rows.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Share {
    /// Rows of its own: slots of its grains.
    pub(crate) rows: Range<usize>,
    /// Pairs that are near in the domain itself.
    pub(crate) near: Pairs,
    /// Pairs that are near across a periodic face.
    pub(crate) across: Pairs,
    /// What it works with.
    #[serde(skip)]
    work: Work,
}

/// What a share works with from one force evaluation to the next.
#[derive(Clone, Debug, Default)]
struct Work {
    /// Pairs of a block that touch.
    touching: [Touching; 2],
    /// Contacts that were recorded, of pairs across a face and of the others.
    seen: [Seen; 2],
    /// Place in the memory of every pair across a face and of the others.
    places: [Vec<u32>; 2],
}

/// What forces are found with.
pub(crate) struct Evaluation<'a, S: Geometry> {
    /// The loops over contacts.
    pub(crate) forces: &'a dyn Forces<S>,
    /// The path through them.
    pub(crate) processor: Processor,
    /// What every contact is computed with.
    pub(crate) terms: Terms<'a>,
    /// Whether contacts are recorded.
    pub(crate) record: bool,
    /// Whether they are recorded one by one.
    pub(crate) one_by_one: bool,
}

/// Shares of so many rows, as equal as can be.
pub(crate) fn rows_of(rows: usize, shares: usize) -> Vec<Range<usize>> {
    let shares = shares.clamp(1, rows.max(1));
    (0..shares).map(|share| share * rows / shares..(share + 1) * rows / shares).collect()
}

impl Share {
    /// A share of these rows, with nothing in it yet.
    pub(crate) fn new(rows: Range<usize>) -> Self {
        Self { rows, near: Pairs::empty(), across: Pairs::empty(), work: Work::default() }
    }

    /// What of these shares is in some rows or reaches their grains.
    pub(crate) fn reaching(shares: &[Self], rows: Range<usize>) -> Self {
        let lists = |of: fn(&Self) -> &Pairs| shares.iter().map(of).collect::<Vec<_>>();
        let chosen = |lists: &[&Pairs]| Pairs::chosen(lists, rows.clone(), |partner| rows.contains(&partner));
        Self {
            near: chosen(&lists(|share| &share.near)),
            across: chosen(&lists(|share| &share.across)),
            ..Self::new(rows.clone())
        }
    }

    /// Whether this is the whole list of so many grains.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { near, across, rows, .. } = self;
        let shifted = across.shift.len() == across.partner.len() || across.len() == 0;
        *rows == (0..grains)
            && shifted
            && near.shift.is_empty()
            && near.is_of(grains, layout)
            && across.is_of(grains, layout)
    }

    /// Finds the place in the memory of every pair.
    pub(crate) fn find_places(&mut self) {
        self.work.places = [self.across.places(), self.near.places()];
    }

    /// Remembers what `old` shares do, whose places have been found, of grains that were sorted in this `order`.
    pub(crate) fn take_over(&mut self, old: &[Self], order: &[u32], layout: &Layout) {
        if old.is_empty() {
            return;
        }
        let found = |a: u32, b: u32| {
            // A grain that has come since has no row.
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

    /// Forgets what every contact remembers.
    pub(crate) fn forget(&mut self) {
        self.near.forget();
        self.across.forget();
    }

    /// Number of its pairs.
    pub(crate) fn pairs(&self) -> usize {
        self.near.own().len() + self.across.own().len()
    }

    /// What was recorded of pairs across a face, and of the others.
    pub(crate) fn seen(&self) -> &[Seen; 2] {
        &self.work.seen
    }

    /// The same, to be taken away.
    pub(crate) fn seen_mut(&mut self) -> &mut [Seen; 2] {
        &mut self.work.seen
    }

    /// The lists, in the order in which their forces are found: of pairs across a face, and of the others.
    pub(crate) fn lists(&mut self) -> [List<'_>; 2] {
        let Self { rows, near, across, work: Work { touching, seen: [seen_across, seen_near], .. } } = self;
        let [touching_across, touching_near] = touching;
        [
            List { rows: rows.clone(), pairs: across, touching: touching_across, seen: seen_across, own: 0 },
            List { rows: rows.clone(), pairs: near, touching: touching_near, seen: seen_near, own: 0 },
        ]
    }

    /// Finds the forces of its pairs. Gives the number of contacts of its own.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        evaluation: &Evaluation<'_, S>,
        grains: Read<'_>,
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

/// A list whose forces are being found, block by block.
pub(crate) struct List<'a> {
    rows: Range<usize>,
    pairs: &'a mut Pairs,
    touching: &'a mut Touching,
    seen: &'a mut Seen,
    /// Contacts in rows of its own, so far.
    own: u64,
}

impl List<'_> {
    /// Blocks of pairs, to be taken one after the other; contacts that are recorded are so `one_by_one`.
    pub(crate) fn blocks(&mut self, one_by_one: bool) -> impl Iterator<Item = Range<usize>> + use<> {
        self.seen.begin(one_by_one);
        blocks(self.pairs.len())
    }

    /// Finds the forces of the pairs in a block.
    pub(crate) fn evaluate<S: Geometry>(
        &mut self,
        evaluation: &Evaluation<'_, S>,
        grains: Read<'_>,
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

    /// The row of the pair that comes after a block, where one does: all pairs of the grains in the rows before have been
    /// looked at.
    pub(crate) fn row_after(&self, block: &Range<usize>) -> Option<usize> {
        (block.end < self.pairs.len()).then(|| self.pairs.row[block.end] as usize)
    }

    /// Number of contacts in rows of its own.
    pub(crate) fn own(self) -> u64 {
        self.own
    }
}
