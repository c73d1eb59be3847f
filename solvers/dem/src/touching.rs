//! Selection of the pairs in contact from the listed pairs. As many pairs are tested at a time as a SIMD register holds.
//! Contact laws are evaluated only for pairs in contact.

use crate::geometry::{Geometry, Linear};
use crate::laws::{between, gathered, places};
use crate::listed::{BLOCK, BlockHistory, Pairs};
use grainbench_lanes::{Kernel, Lanes, Number, Processor, Quad, WIDEST};
use std::marker::PhantomData;
use std::ops::Range;

/// Returns the index ranges of the blocks into which a list of pairs is divided.
pub(crate) fn blocks(pairs: usize) -> impl Iterator<Item = Range<usize>> {
    (0..pairs).step_by(BLOCK).map(move |from| from..(from + BLOCK).min(pairs))
}

/// Pairs in contact in one block of the neighbour list, in the order of the list.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactList {
    /// Number of pairs in contact.
    pub(crate) count: usize,
    /// Slot of the first grain of each pair. The pair is in this grain's row of the neighbour list. Copies of the last
    /// entry follow, so that the last register is full.
    pub(crate) first: Vec<u32>,
    /// Slot of the second grain of each pair.
    pub(crate) second: Vec<u32>,
    /// Index of each pair in the neighbour list; only for lists with periodic shifts.
    pub(crate) pair: Vec<u32>,
    /// True if the same pairs were in contact at the last evaluation.
    pub(crate) steady: bool,
    /// For each contact, its index in the previous history of the block; 0 for a new contact.
    pub(crate) remembered: Vec<u32>,
    /// Previous history of the block, if the pairs in contact have changed.
    pub(crate) before: BlockHistory,
}

impl ContactList {
    /// Finds the pairs in contact in a block of listed pairs. Blocks must be processed in order.
    pub(crate) fn find<S: Geometry>(
        &mut self,
        processor: Processor,
        place: &[Quad],
        pairs: &mut Pairs,
        block: Range<usize>,
    ) {
        for all in [&mut self.first, &mut self.second, &mut self.pair, &mut self.remembered] {
            all.resize(BLOCK + 2 * WIDEST, 0);
        }
        let number = block.start / BLOCK;
        processor.run(Find::<S> { place, pairs, block, touching: self, space: PhantomData });
        pairs.make_room(number, self.count, (!self.steady).then_some(&mut self.before));
        for all in [&mut self.first, &mut self.second, &mut self.pair, &mut self.remembered] {
            let last = self.count.checked_sub(1).map_or(0, |last| all[last]);
            all[self.count..self.count + WIDEST].fill(last);
        }
    }
}

/// Loop over the listed pairs of a block that finds the pairs in contact.
struct Find<'a, S: Geometry> {
    place: &'a [Quad],
    pairs: &'a mut Pairs,
    block: Range<usize>,
    touching: &'a mut ContactList,
    space: PhantomData<S>,
}

impl<S: Geometry> Kernel for Find<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { place, pairs, block, touching, space: _ } = self;
        let Pairs { row, partner, shift, touches, .. } = pairs;
        let ContactList { count, first, second, pair, steady, remembered, before: _ } = touching;
        let (mut had, mut changed) = (0, 0);
        *count = 0;
        for from in block.clone().step_by(WIDEST) {
            let (ones, others) = (eight(row, from), eight(partner, from));
            let mut numbers = [0_u32; WIDEST];
            count_up(&mut numbers, from);
            let mut near = 0;
            for lane in (0..WIDEST).step_by(L::WIDTH) {
                let slots = [&ones, &others].map(|slots| places(lanes, &slots[lane..], place.len()));
                let less = between(lanes, place.as_chunks::<1>().0, 0, slots.each_ref());
                let (mut between, reach) = (S::vector(less), less[3]);
                if !shift.is_empty() {
                    between =
                        between - S::vector(gathered(lanes, shift, &places(lanes, &numbers[lane..], shift.len())));
                }
                near |= between.dot(between).below(reach * reach).bits() << lane;
            }
            near &= ALL >> (WIDEST - (block.end - from).min(WIDEST));
            first[*count..*count + WIDEST].copy_from_slice(&lanes.pack(&ones, near));
            second[*count..*count + WIDEST].copy_from_slice(&lanes.pack(&others, near));
            if !shift.is_empty() {
                pair[*count..*count + WIDEST].copy_from_slice(&lanes.pack(&numbers, near));
            }
            if let Some(touches) = touches.get_mut(from / WIDEST) {
                let touched = u32::from(std::mem::replace(touches, near as u8));
                changed |= touched ^ near;
                let remembered = &mut remembered[*count..*count + WIDEST];
                if touched == near {
                    count_up(remembered, 1 + had);
                } else {
                    let mut numbers = [0; WIDEST];
                    let mut place = 1 + had as u32;
                    for (lane, at) in numbers.iter_mut().enumerate() {
                        if touched >> lane & 1 == 1 {
                            *at = place;
                            place += 1;
                        }
                    }
                    remembered.copy_from_slice(&lanes.pack(&numbers, near));
                }
                had += touched.count_ones() as usize;
            }
            *count += near.count_ones() as usize;
        }
        *steady = changed == 0;
    }
}

/// Fills a slice with consecutive integers that start at `from`.
#[inline(always)]
fn count_up(numbers: &mut [u32], from: usize) {
    for (lane, number) in numbers.iter_mut().enumerate() {
        *number = (from + lane) as u32;
    }
}

/// Mask with the bits of eight pairs set.
const ALL: u32 = 255;

/// Returns the eight integers of a slice that start at index `from`.
#[inline(always)]
fn eight(values: &[u32], from: usize) -> [u32; WIDEST] {
    let mut eight = [0; WIDEST];
    eight.copy_from_slice(&values[from..from + WIDEST]);
    eight
}
