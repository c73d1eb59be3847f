//! Listed pairs, in rows, with what their contacts remember in the order of those that touch.

use crate::contact::chain::Layout;
use crate::contact::{MEMORY, Memory};
use grainbench_lanes::{Quad, WIDEST};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Listed pairs that are looked at before the forces of those that touch are found: so few that their grains are still at
/// hand, and so many that little is lost at the end. A multiple of eight.
pub(crate) const BLOCK: usize = 2048;

/// What the contacts of a block of pairs remember, number by number: of those that touched when they were looked at last, in
/// their order, after nothing. Empty where so many numbers are not remembered.
pub(crate) type Remembered = [Vec<f64>; MEMORY];

/// Pairs of grains, in rows: a row holds the partners of one grain. Partners, rows and shifts are filled up beyond the last
/// pair, so that registers can be.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Pairs {
    /// The first of its rows. Where other rows than its own have pairs here too, these stand before its own and after.
    #[serde(skip)]
    first_row: usize,
    /// Number of the first pair of every row of its own, and where the last ends.
    start: Vec<u32>,
    /// Slot of the first grain of each pair: its row.
    pub(crate) row: Vec<u32>,
    /// Slot of the partner of each pair.
    pub(crate) partner: Vec<u32>,
    /// Shift of each pair across a periodic face: what is added to the position of the first grain (m). Empty where none is.
    pub(crate) shift: Vec<Quad>,
    /// Whether each pair touched when it was looked at last, as bits, the first of eight lowest. Empty where nothing is
    /// remembered.
    pub(crate) touches: Vec<u8>,
    /// What contacts remember, by blocks of pairs. Empty where nothing is.
    pub(crate) memory: Vec<Remembered>,
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

    /// Number of pairs.
    pub(crate) fn len(&self) -> usize {
        self.partner.len() - WIDEST
    }

    /// Lists what `partners` gives of each row, with room for what the contacts remember.
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
            pairs.memory = vec![nothing(layout); count.div_ceil(BLOCK)];
        }
        pairs.fill_up();
        pairs
    }

    /// Pairs that touch, of so many rows, with what each remembers.
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
            for (number, of) in pairs.memory[at / BLOCK].iter_mut().enumerate().filter(|(_, of)| !of.is_empty()) {
                of.push(memory[number]);
            }
        }
        pairs
    }

    /// Row, partner and what is remembered, of each pair in rows of its own that touches.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = (u32, u32, Memory<f64>)> {
        let own = self.own();
        self.places().into_iter().enumerate().filter_map(move |(at, place)| {
            let number = |number: usize| self.memory[at / BLOCK][number].get(place as usize).copied().unwrap_or(0.0);
            let told = place > 0 && own.contains(&at);
            told.then(|| (self.row[at], self.partner[at], std::array::from_fn(number)))
        })
    }

    /// Room beyond the last pair, so that registers can be filled.
    fn fill_up(&mut self) {
        for places in [&mut self.row, &mut self.partner] {
            places.resize(places.len() + WIDEST, 0);
        }
        if !self.shift.is_empty() {
            self.shift.resize(self.shift.len() + WIDEST, Quad::default());
        }
    }

    /// Of lists whose rows follow one another, the pairs in some rows and the others whose partners are to be kept, in their
    /// order and with what their contacts remember. The rows of its own are the given ones.
    pub(crate) fn chosen(lists: &[&Self], rows: Range<usize>, keep: impl Fn(usize) -> bool) -> Self {
        if lists.iter().all(|list| list.start == [0]) {
            return Self::empty();
        }
        let mut chosen = Self { partner: Vec::new(), row: Vec::new(), start: Vec::new(), ..Self::empty() };
        chosen.first_row = rows.start;
        let nothing = lists
            .iter()
            .find_map(|list| list.memory.first())
            .map(|of| of.each_ref().map(|of| of[..of.len().min(1)].to_vec()));
        for list in lists {
            let own = list.own();
            for (at, place) in list.places().into_iter().enumerate().take(own.end) {
                let (row, partner) = (list.row[at] as usize, list.partner[at] as usize);
                if at < own.start || !(rows.contains(&row) || keep(partner)) {
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

    /// The pairs in rows of its own.
    pub(crate) fn own(&self) -> Range<usize> {
        let end = |of: Option<&u32>| of.map_or(0, |&end| end as usize);
        end(self.start.first())..end(self.start.last())
    }

    /// Whether a pair touched when it was looked at last; of none where nothing is remembered.
    fn touches_at(&self, pair: usize) -> bool {
        self.touches.get(pair / WIDEST).is_some_and(|bits| bits >> (pair % WIDEST) & 1 == 1)
    }

    /// Whether these are pairs of so many grains: rows that follow one another, and for each pair what it must have.
    pub(crate) fn is_of(&self, grains: usize, layout: Layout) -> bool {
        let Self { start, row, partner, shift, touches, memory, first_row: _ } = self;
        let Some(count) = partner.len().checked_sub(WIDEST) else { return false };
        let rows = start.len() == grains + 1 || start == &[0];
        let in_order = start.first() == Some(&0) && start.is_sorted();
        let remembers = |count: usize| if layout.numbers > 0 && *start != [0] { count } else { 0 };
        let told = |(bits, of): (&[u8], &Remembered)| {
            let touched = bits.iter().map(|bits| bits.count_ones() as usize).sum::<usize>();
            of.iter().enumerate().all(|(number, of)| of.len() == if number < layout.numbers { 1 + touched } else { 0 })
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
            && touches.chunks(BLOCK / WIDEST).zip(memory).all(told)
            // Beyond the last pair stands the first slot, of no grain where none are left.
            && row.iter().chain(partner).all(|&slot| (slot as usize) < grains.max(1))
    }

    /// Number of a pair in the rows of its own.
    pub(crate) fn find(&self, row: u32, partner: u32) -> Option<usize> {
        let row = (row as usize).checked_sub(self.first_row)?;
        let range = *self.start.get(row)? as usize..*self.start.get(row + 1)? as usize;
        let at = self.partner[range.clone()].iter().position(|&other| other == partner)?;
        Some(range.start + at)
    }

    /// Place in the memory of its block of every pair that touched when it was looked at last, zero of the others.
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

    /// Remembers of the next pair `at` what another list does of a pair, in a place of its block's memory; with the roles of
    /// first and second grain exchanged if `exchanged` is given.
    pub(crate) fn take(&mut self, at: usize, other: &Self, (from, place): (usize, u32), exchanged: Option<&Layout>) {
        self.touches[at / WIDEST] |= 1 << (at % WIDEST);
        let memories = self.memory[at / BLOCK].iter_mut().zip(&other.memory[from / BLOCK]);
        for (number, (mine, other)) in memories.enumerate() {
            if let Some(value) = other.get(place as usize) {
                mine.push(value * exchanged.map_or(1.0, |layout| layout.exchanged[number]));
            }
        }
    }

    /// Makes the memory of a block ready for so many contacts: in place where they are those that touched before, else it is
    /// made anew, and what was remembered lies in `before`. Room follows the last, so that registers can be filled.
    pub(crate) fn make_room(&mut self, block: usize, count: usize, before: Option<&mut Remembered>) {
        let Some(memory) = self.memory.get_mut(block) else { return };
        if let Some(before) = before {
            std::mem::swap(memory, before);
            for (of, before) in memory.iter_mut().zip(before) {
                // What stands there will be written over, but for the first, which is nothing.
                of.resize(if before.is_empty() { 0 } else { of.len().max(1) }, 0.0);
            }
        }
        for of in memory.iter_mut().filter(|of| !of.is_empty()) {
            let room = 1 + count + WIDEST;
            reserve(of, room.saturating_sub(of.len()));
            of.resize(room, 0.0);
        }
    }

    /// What the contacts of a block remember is what was written, of so many.
    pub(crate) fn remember(&mut self, block: usize, count: usize) {
        if let Some(memory) = self.memory.get_mut(block) {
            memory.iter_mut().for_each(|of| of.truncate(1 + count));
        }
    }

    pub(crate) fn forget(&mut self) {
        self.memory.iter_mut().flatten().for_each(|memory| memory.fill(0.0));
    }
}

/// The memory of a block without contacts.
fn nothing(layout: Layout) -> Remembered {
    std::array::from_fn(|number| vec![0.0; usize::from(number < layout.numbers)])
}

/// Makes room for more: where it must grow, by an eighth at least, for there may be millions.
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more.max(list.len() / 8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a checkpoint may hold that some other program wrote.
    #[test]
    fn lists_of_other_grains_are_told() {
        let layout = Layout { numbers: 1, exchanged: [1.0; MEMORY] };
        let pairs = Pairs::list(0..2, layout, |row, partners, _| {
            if row == 0 {
                partners.push(1)
            }
        });
        let of = |pairs: &Pairs, grains: usize| pairs.is_of(grains, layout);
        assert!(of(&pairs, 2) && of(&Pairs::empty(), 2) && !of(&pairs, 1) && !of(&pairs, 3));
        let mut other = pairs.clone();
        other.partner[0] = 2;
        assert!(!of(&other, 2));
        assert!(!of(&Pairs { start: vec![0, 2, 1], ..pairs.clone() }, 2));
        assert!(!of(&Pairs { start: vec![0, 1, 2], ..pairs.clone() }, 2));
        let mut other = pairs.clone();
        other.row[0] = 1;
        assert!(!of(&other, 2));
        assert!(!of(&Pairs { touches: Vec::new(), ..pairs.clone() }, 2));
        assert!(!of(&Pairs { touches: vec![1], ..pairs.clone() }, 2));
        assert!(!of(&Pairs { memory: Default::default(), ..pairs.clone() }, 2));
        assert!(!of(&Pairs { row: vec![0], ..pairs }, 2));
    }
}
