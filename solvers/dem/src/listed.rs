//! Listed pairs, in rows, with the contact history in the order of the pairs in contact.

use crate::contact::chain::Layout;
use crate::contact::{MEMORY, Memory};
use grainbench_lanes::{Quad, WIDEST};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Number of listed pairs in a block. The contacts of a block are found before their forces are computed. Blocks are
/// small enough for the data of their grains to stay in the cache. They are large enough that the incomplete register at
/// the end of a block costs little. The number is a multiple of eight.
pub(crate) const BLOCK: usize = 2048;

/// Contact history of a block of pairs, with one list for each history value. Each list contains zero as its first
/// entry, and then one value for each contact of the last evaluation, in order. Lists of unused values are empty.
pub(crate) type BlockHistory = [Vec<f64>; MEMORY];

/// Pairs of grains in rows. Each row holds the partners of one grain. Rows, partners and shifts are padded after the last
/// pair, so that the last register can be filled.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Pairs {
    /// First own row of the partition. The own rows are consecutive; pairs of other rows come before and after them.
    #[serde(skip)]
    first_row: usize,
    /// Index of the first pair of every own row, and the end of the last row.
    start: Vec<u32>,
    /// Slot of the first grain of each pair: its row.
    pub(crate) row: Vec<u32>,
    /// Slot of the partner of each pair.
    pub(crate) partner: Vec<u32>,
    /// Shift of each pair across a periodic face (m), which is added to the position of the first grain. Empty if no
    /// pair crosses a periodic face.
    pub(crate) shift: Vec<Quad>,
    /// One bit per pair, set if the pair was in contact at the last evaluation. Each byte holds eight pairs; the first
    /// pair is the lowest bit. Empty without contact history.
    pub(crate) touches: Vec<u8>,
    /// Contact history, by blocks of pairs. Empty without contact history.
    pub(crate) memory: Vec<BlockHistory>,
}

impl Pairs {
    pub(crate) fn empty() -> Self {
        Self {
            first_row: 0,
            start: vec![0],
            row: vec![0; WIDEST],
            partner: vec![0; WIDEST],
            shift: Vec::new(),
            touches: Vec::new(),
            memory: Vec::new(),
        }
    }

    /// Returns the number of pairs.
    pub(crate) fn len(&self) -> usize {
        self.partner.len() - WIDEST
    }

    /// Lists pairs with empty contact history. For each row, `partners` appends the partners, and their shifts if pairs
    /// cross a periodic face.
    pub(crate) fn list(
        rows: Range<usize>,
        layout: Layout,
        mut partners: impl FnMut(usize, &mut Vec<u32>, &mut Vec<Quad>),
    ) -> Self {
        let mut pairs = Self { first_row: rows.start, partner: Vec::new(), row: Vec::new(), ..Self::empty() };
        for row in rows {
            partners(row, &mut pairs.partner, &mut pairs.shift);
            pairs.row.resize(pairs.partner.len(), row as u32);
            pairs.start.push(pairs.partner.len() as u32);
        }
        if layout.numbers > 0 {
            let count = pairs.partner.len();
            pairs.touches = vec![0; count.div_ceil(WIDEST)];
            let nothing: BlockHistory = std::array::from_fn(|number| vec![0.0; usize::from(number < layout.numbers)]);
            pairs.memory = vec![nothing; count.div_ceil(BLOCK)];
        }
        pairs.fill_up();
        pairs
    }

    /// Creates a list of `rows` rows with the given pairs, all in contact, and their history.
    pub(crate) fn remembering(rows: usize, layout: Layout, springs: &[(u32, u32, Memory<f64>)]) -> Self {
        let mut sorted: Vec<&(u32, u32, Memory<f64>)> = springs.iter().collect();
        sorted.sort_by_key(|(row, ..)| *row);
        let mut next = sorted.iter().peekable();
        let mut pairs = Self::list(0..rows, layout, |row, partners, _| {
            while let Some((_, partner, _)) = next.next_if(|(first, ..)| *first as usize == row) {
                partners.push(*partner);
            }
        });
        for (at, (.., memory)) in sorted.iter().enumerate() {
            pairs.touches[at / WIDEST] |= 1 << (at % WIDEST);
            for (number, values) in
                pairs.memory[at / BLOCK].iter_mut().enumerate().filter(|(_, values)| !values.is_empty())
            {
                values.push(memory[number]);
            }
        }
        pairs
    }

    /// Returns row, partner and history of each pair in the partition's own rows that was in contact at the last evaluation.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = (u32, u32, Memory<f64>)> {
        let own = self.own();
        self.places().into_iter().enumerate().filter_map(move |(at, place)| {
            let number = |number: usize| self.memory[at / BLOCK][number].get(place as usize).copied().unwrap_or(0.0);
            let is_remembered = place > 0 && own.contains(&at);
            is_remembered.then(|| (self.row[at], self.partner[at], std::array::from_fn(number)))
        })
    }

    /// Adds padding after the last pair, so that the last register can be filled.
    fn fill_up(&mut self) {
        for places in [&mut self.row, &mut self.partner] {
            places.resize(places.len() + WIDEST, 0);
        }
        if !self.shift.is_empty() {
            self.shift.resize(self.shift.len() + WIDEST, Quad::default());
        }
    }

    /// Selects pairs from the lists of consecutive partitions: all pairs of `rows`, and pairs of other rows whose partner
    /// is in `rows`. The order and the contact history of the pairs do not change. The own rows of the result are `rows`.
    pub(crate) fn chosen(lists: &[&Self], rows: Range<usize>) -> Self {
        if lists.iter().all(|list| list.start == [0]) {
            return Self::empty();
        }
        let mut chosen = Self { partner: Vec::new(), row: Vec::new(), start: Vec::new(), ..Self::empty() };
        chosen.first_row = rows.start;
        let nothing = lists
            .iter()
            .find_map(|list| list.memory.first())
            .map(|values| values.each_ref().map(|values| values[..values.len().min(1)].to_vec()));
        for list in lists {
            let own = list.own();
            for (at, place) in list.places().into_iter().enumerate().take(own.end) {
                let (row, partner) = (list.row[at] as usize, list.partner[at] as usize);
                if at < own.start || !(rows.contains(&row) || rows.contains(&partner)) {
                    continue;
                }
                let number = chosen.row.len();
                chosen.row.push(list.row[at]);
                chosen.partner.push(list.partner[at]);
                chosen.shift.extend(list.shift.get(at));
                if let Some(nothing) = &nothing {
                    if number.is_multiple_of(WIDEST) {
                        chosen.touches.push(0);
                    }
                    if number.is_multiple_of(BLOCK) {
                        chosen.memory.push(nothing.clone());
                    }
                }
                if place > 0 {
                    chosen.take(number, list, (at, place), None);
                }
            }
        }
        let mut at = chosen.row.partition_point(|&row| (row as usize) < rows.start);
        for row in rows {
            chosen.start.push(at as u32);
            at += chosen.row[at..].iter().take_while(|&&other| other as usize == row).count();
        }
        chosen.start.push(at as u32);
        chosen.fill_up();
        chosen
    }

    /// Returns the index range of the pairs in the partition's own rows.
    pub(crate) fn own(&self) -> Range<usize> {
        let end = |end_index: Option<&u32>| end_index.map_or(0, |&end| end as usize);
        end(self.start.first())..end(self.start.last())
    }

    /// Returns true if a pair was in contact at the last evaluation; false without contact history.
    fn touches_at(&self, pair: usize) -> bool {
        self.touches.get(pair / WIDEST).is_some_and(|bits| bits >> (pair % WIDEST) & 1 == 1)
    }

    /// Returns true if the list is valid for a number of grains and this layout of the contact history: rows are
    /// consecutive, and each pair has its data.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { start, row, partner, shift, touches, memory, first_row: _ } = self;
        let Some(count) = partner.len().checked_sub(WIDEST) else { return false };
        let rows = start.len() == grains + 1 || start == &[0];
        let in_order = start.first() == Some(&0) && start.is_sorted();
        let remembers = |count: usize| if layout.numbers > 0 && *start != [0] { count } else { 0 };
        let is_consistent = |(bits, history): (&[u8], &BlockHistory)| {
            let touched = bits.iter().map(|bits| bits.count_ones() as usize).sum::<usize>();
            history
                .iter()
                .enumerate()
                .all(|(number, numbers)| numbers.len() == if number < layout.numbers { 1 + touched } else { 0 })
        };
        rows && in_order
            && start.last().is_some_and(|&last| last as usize == count)
            && row.len() == partner.len()
            && start
                .windows(2)
                .zip(0..)
                .all(|(ends, number)| row[ends[0] as usize..ends[1] as usize].iter().all(|&row| row == number))
            && (shift.is_empty() || shift.len() == partner.len())
            && touches.len() == remembers(count.div_ceil(WIDEST))
            && memory.len() == remembers(count.div_ceil(BLOCK))
            && touches.chunks(BLOCK / WIDEST).zip(memory).all(is_consistent)
            // The padding after the last pair holds slot 0, even if there are no grains.
            && row.iter().chain(partner).all(|&slot| (slot as usize) < grains.max(1))
    }

    /// Returns the index of the pair of `row` and `partner`; `None` if the own rows of the partition do not contain it.
    pub(crate) fn find(&self, row: u32, partner: u32) -> Option<usize> {
        let row = (row as usize).checked_sub(self.first_row)?;
        let range = *self.start.get(row)? as usize..*self.start.get(row + 1)? as usize;
        let at = self.partner[range.clone()].iter().position(|&other| other == partner)?;
        Some(range.start + at)
    }

    /// Returns, for every pair, the index of its history in the history of its block; zero if the pair was not in
    /// contact at the last evaluation.
    pub(crate) fn places(&self) -> Vec<u32> {
        let mut touched = 0;
        let place = |pair: usize| {
            if pair.is_multiple_of(BLOCK) {
                touched = 0;
            }
            let touches = self.touches_at(pair);
            touched += u32::from(touches);
            if touches { touched } else { 0 }
        };
        (0..self.len()).map(place).collect()
    }

    /// Copies the history of pair `from` of the list `other` to pair `at` of this list. `place` is the index of this
    /// history in its block of `other`. Pairs must be filled in increasing order. `exchanged` is given if the first and
    /// the second grain have changed roles.
    pub(crate) fn take(&mut self, at: usize, other: &Self, (from, place): (usize, u32), exchanged: Option<&Layout>) {
        self.touches[at / WIDEST] |= 1 << (at % WIDEST);
        let memories = self.memory[at / BLOCK].iter_mut().zip(&other.memory[from / BLOCK]);
        for (number, (mine, other)) in memories.enumerate() {
            if let Some(value) = other.get(place as usize) {
                mine.push(value * exchanged.map_or(1.0, |layout| layout.exchanged[number]));
            }
        }
    }

    /// Prepares the history of a block for `count` contacts. Without `before`, the pairs in contact are unchanged, and
    /// their history stays in place. With `before`, the previous history moves there, and the evaluation writes a new
    /// one. Padding follows the last contact, so that the last register can be filled.
    pub(crate) fn make_room(&mut self, block: usize, count: usize, before: Option<&mut BlockHistory>) {
        let Some(memory) = self.memory.get_mut(block) else { return };
        if let Some(before) = before {
            std::mem::swap(memory, before);
            for (values, before) in memory.iter_mut().zip(before) {
                // All entries will be overwritten, except for the first, which is zero.
                values.resize(if before.is_empty() { 0 } else { values.len().max(1) }, 0.0);
            }
        }
        for values in memory.iter_mut().filter(|values| !values.is_empty()) {
            let room = 1 + count + WIDEST;
            reserve(values, room.saturating_sub(values.len()));
            values.resize(room, 0.0);
        }
    }

    /// Removes the padding after the history of the `count` contacts of a block.
    pub(crate) fn remember(&mut self, block: usize, count: usize) {
        if let Some(memory) = self.memory.get_mut(block) {
            memory.iter_mut().for_each(|values| values.truncate(1 + count));
        }
    }

    /// Clears the history of every contact.
    pub(crate) fn forget(&mut self) {
        self.memory.iter_mut().flatten().for_each(|memory| memory.fill(0.0));
    }
}

/// Reserves memory for more entries. A full list grows by at least an eighth, because it may have millions of entries.
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more.max(list.len() / 8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A list that does not fit the number of grains, as in a damaged checkpoint, is rejected.
    #[test]
    fn lists_of_other_grains_are_told() {
        let layout = Layout { numbers: 1, exchanged: [1.0; MEMORY] };
        let pairs = Pairs::list(0..2, layout, |row, partners, _| {
            if row == 0 {
                partners.push(1)
            }
        });
        let is_of_grains = |pairs: &Pairs, grains: usize| pairs.is_of(grains, layout);
        assert_eq!([1, 2, 3].map(|grains| is_of_grains(&pairs, grains)), [false, true, false]);
        assert!(is_of_grains(&Pairs::empty(), 2));
        let mut other = pairs.clone();
        other.partner[0] = 2;
        assert!(!is_of_grains(&other, 2));
        assert!(!is_of_grains(&Pairs { start: vec![0, 2, 1], ..pairs.clone() }, 2));
        assert!(!is_of_grains(&Pairs { start: vec![0, 1, 2], ..pairs.clone() }, 2));
        let mut other = pairs.clone();
        other.row[0] = 1;
        assert!(!is_of_grains(&other, 2));
        assert!(!is_of_grains(&Pairs { touches: Vec::new(), ..pairs.clone() }, 2));
        assert!(!is_of_grains(&Pairs { touches: vec![1], ..pairs.clone() }, 2));
        assert!(!is_of_grains(&Pairs { memory: Default::default(), ..pairs.clone() }, 2));
        assert!(!is_of_grains(&Pairs { row: vec![0], ..pairs }, 2));
    }
}
