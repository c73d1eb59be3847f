//! Listed pairs, in rows, with what their contacts remember in the order of those that touch.

use crate::contact::Memory;
use crate::contact::chain::Layout;
use grainbench_lanes::{Quad, WIDEST};
use serde::{Deserialize, Serialize};
use std::ops::Range;

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
    /// What the contacts of those that touched remember, in their order, after nothing: four numbers and four more. Empty
    /// where so many are not remembered.
    pub(crate) memory: [Vec<Quad>; 2],
    /// Room for what they remember next, with no more in it than that.
    #[serde(skip)]
    pub(crate) next: [Vec<Quad>; 2],
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
            memory: Default::default(),
            next: Default::default(),
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
        let count = pairs.partner.len();
        pairs.touches = vec![0; if layout.numbers > 0 { count.div_ceil(WIDEST) } else { 0 }];
        pairs.memory = [0, 4].map(|from| vec![Quad::default(); usize::from(layout.numbers > from)]);
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
            for (number, of) in pairs.memory.iter_mut().enumerate().filter(|(_, of)| !of.is_empty()) {
                of.push(Quad(std::array::from_fn(|part| memory[4 * number + part])));
            }
        }
        pairs
    }

    /// Row, partner and what is remembered, of each pair in rows of its own that touches.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = (u32, u32, Memory<f64>)> {
        let (own, mut place) = (self.own(), 0);
        (0..own.end).filter_map(move |at| {
            let touches = self.touches_at(at);
            place += usize::from(touches);
            let number = |number: usize| self.memory[number / 4].get(place).map_or(0.0, |quad| quad.0[number % 4]);
            (touches && at >= own.start).then(|| (self.row[at], self.partner[at], std::array::from_fn(number)))
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
        chosen.memory = lists[0].memory.each_ref().map(|of| of.iter().take(1).copied().collect());
        let remembers = lists.iter().any(|list| !list.touches.is_empty());
        for list in lists {
            let mut place = 0;
            let own = list.own();
            for at in 0..own.end {
                let touches = list.touches_at(at);
                place += u32::from(touches);
                let (row, partner) = (list.row[at] as usize, list.partner[at] as usize);
                if at < own.start || !(rows.contains(&row) || keep(partner)) {
                    continue;
                }
                let number = chosen.row.len();
                chosen.row.push(list.row[at]);
                chosen.partner.push(list.partner[at]);
                chosen.shift.extend(list.shift.get(at));
                if remembers && number.is_multiple_of(WIDEST) {
                    chosen.touches.push(0);
                }
                if touches {
                    chosen.take(number, list, place, None);
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
        let Self { start, row, partner, shift, touches, memory, first_row: _, next: _ } = self;
        let Some(count) = partner.len().checked_sub(WIDEST) else { return false };
        let rows = start.len() == grains + 1 || start == &[0];
        let in_order = start.first() == Some(&0) && start.is_sorted();
        let touched = touches.iter().map(|bits| bits.count_ones() as usize).sum::<usize>();
        let remembers = |from: usize, count: usize| if layout.numbers > from && *start != [0] { count } else { 0 };
        rows && in_order
            && start.last().is_some_and(|&last| last as usize == count)
            && row.len() == partner.len()
            && start
                .windows(2)
                .zip(0..)
                .all(|(ends, number)| row[ends[0] as usize..ends[1] as usize].iter().all(|&row| row == number))
            && (shift.is_empty() || shift.len() == partner.len())
            && touches.len() == remembers(0, count.div_ceil(WIDEST))
            && [memory[0].len(), memory[1].len()] == [remembers(0, 1 + touched), remembers(4, 1 + touched)]
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

    /// Place in the memory of every pair that touched when it was looked at last, zero of the others.
    pub(crate) fn places(&self) -> Vec<u32> {
        let mut touched = 0;
        let place = |pair: usize| {
            let touches = self.touches_at(pair);
            touched += u32::from(touches);
            if touches { touched } else { 0 }
        };
        (0..self.len()).map(place).collect()
    }

    /// Remembers of the next pair `at` what another list does in a place of its memory; with the roles of first and second
    /// grain exchanged if `exchanged` is given.
    pub(crate) fn take(&mut self, at: usize, other: &Self, place: u32, exchanged: Option<&Layout>) {
        self.touches[at / WIDEST] |= 1 << (at % WIDEST);
        for (number, (mine, other)) in self.memory.iter_mut().zip(&other.memory).enumerate() {
            if let Some(mut quad) = other.get(place as usize).copied() {
                if let Some(layout) = exchanged {
                    (0..4).for_each(|part| quad.0[part] *= layout.exchanged[4 * number + part]);
                }
                mine.push(quad);
            }
        }
    }

    /// Room for what a block of pairs remembers from a place on.
    pub(crate) fn make_room(&mut self, places: usize) {
        for (memory, next) in self.memory.iter().zip(&mut self.next) {
            if !memory.is_empty() && next.len() < places {
                reserve(next, places - next.len());
                next.resize(places, Quad::default());
            }
        }
    }

    /// What was written as next, of so many contacts, is what is remembered.
    pub(crate) fn remember(&mut self, contacts: usize) {
        for (memory, next) in self.memory.iter_mut().zip(&mut self.next).filter(|(memory, _)| !memory.is_empty()) {
            std::mem::swap(memory, next);
            memory.truncate(1 + contacts);
            memory.resize(1 + contacts, Quad::default());
        }
    }

    pub(crate) fn forget(&mut self) {
        self.memory.iter_mut().for_each(|memory| memory.fill(Quad::default()));
    }
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
        let layout = Layout { numbers: 1, exchanged: [1.0; 8] };
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
