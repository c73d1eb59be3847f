//! Loop over pairs in contact. It processes as many pairs at a time as a SIMD register holds.

use crate::contact::chain::Answer;
use crate::contact::normal::Normal;
use crate::contact::pair::{Pair, PairDistances};
use crate::contact::rolling::Rolling;
use crate::contact::tangential::Tangential;
use crate::contact::{MEMORY, Memory, Terms};
use crate::geometry::{Geometry, Linear};
use crate::grains::{GrainTables, Loads, Sums};
use crate::laws::{self, Constants, gathered, gathered_of, places};
use crate::listed::Pairs;
use crate::seen::RecordedContacts;
use crate::touching::ContactList;
use grainbench_lanes::{Kernel, Lanes, Number, Processor, Quad, ScalarBackend, SimdPack, WIDEST};
use grainbench_solver::record::Partner;
use std::marker::PhantomData;

/// Loop over pairs in contact, for the stages `N`, `T` and `R` of the contact law. The velocity and spin of each grain
/// take `Q` quads.
pub(crate) struct PairLoop<'a, S: Geometry, N, T, R, const Q: usize> {
    terms: Terms<'a>,
    touching: &'a ContactList,
    grains: GrainTables<'a>,
    sums: Sums<'a>,
    shift: &'a [Quad],
    /// Contact history of the block, which the loop overwrites. If the same pairs were in contact in the previous
    /// evaluation, it still holds the previous history. Otherwise `touching` holds the previous history.
    memory: [&'a mut [f64]; MEMORY],
    seen: Option<&'a mut RecordedContacts>,
    chain: PhantomData<(S, N, T, R)>,
}

/// Number of SIMD registers of pairs whose distances are computed before their forces. Square roots and divisions have
/// long latencies, so it is faster to start several of them at a time. The number is small enough for the results to stay
/// in registers. Loops with the widest registers do not use it, because storing the distances costs as much time as this
/// saves.
const ROUND: usize = 8;

impl<S: Geometry, L: Lanes> PairDistances<S, SimdPack<L>> {
    /// Returns zeros, as initial values of a buffer.
    #[inline(always)]
    fn none(lanes: L) -> Self {
        let zero = SimdPack::splat(lanes, 0.0);
        let between = S::vector([zero; 4]);
        Self { between, distance: zero, inverse_distance: zero, reach: zero, radii: [zero; 2] }
    }
}

/// For the pairs of one register, the slots of their first grains and of their second grains.
type Slots = [[usize; WIDEST]; 2];

impl<'a, S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>, const Q: usize> PairLoop<'a, S, N, T, R, Q> {
    /// Number of history values of a contact.
    const NUMBERS: usize = T::NUMBERS + R::NUMBERS;

    /// Creates the loop over the pairs of a block.
    pub(crate) fn new(
        terms: Terms<'a>,
        (grains, sums): (GrainTables<'a>, Sums<'a>),
        (pairs, block): (&'a mut Pairs, usize),
        touching: &'a ContactList,
        seen: Option<&'a mut RecordedContacts>,
    ) -> Self {
        let Pairs { shift, memory, .. } = pairs;
        let memory = match memory.get_mut(block) {
            Some(memory) => memory.each_mut().map(|numbers| numbers.get_mut(1..).unwrap_or_default()),
            None => Default::default(),
        };
        Self { terms, touching, grains, sums, shift, memory, seen, chain: PhantomData }
    }

    /// Runs the loop with an instruction set of the processor. If contacts are recorded, it processes them one by one.
    pub(crate) fn run_on(self, processor: Processor) {
        if self.seen.is_some() {
            self.run(ScalarBackend::<1>);
        } else {
            processor.run(self);
        }
    }

    /// Computes the distances between the grains of the contacts in one register. `from` is the index of the first of
    /// these contacts in the contact list.
    #[inline(always)]
    fn apart<L: Lanes>(&self, lanes: L, slots: &Slots, from: usize) -> PairDistances<S, SimdPack<L>> {
        let ([first, second], zero) = (slots, SimdPack::splat(lanes, 0.0));
        let (place, shift) = (self.grains.place, self.shift);
        let (mut between, reach, radii);
        if T::ACTIVE && Q == 1 {
            let at = [gathered(lanes, place, first), gathered(lanes, place, second)];
            between = S::vector(at[1]) - S::vector(at[0]);
            (radii, reach) = ([at[0][3], at[1][3]], at[0][3] + at[1][3]);
        } else {
            // Differences are taken before the quads are transposed, which halves the number of transpositions. Radii
            // are read only for laws that need them.
            let away = laws::between(lanes, place.as_chunks::<1>().0, 0, [first, second]);
            (between, reach) = (S::vector(away), away[3]);
            radii = if !T::ACTIVE && (N::CURVED || R::ACTIVE) {
                [gathered(lanes, place, first)[3], gathered(lanes, place, second)[3]]
            } else {
                [zero; 2]
            };
        }
        if !shift.is_empty() {
            let pair = places(lanes, &self.touching.pair[from..], shift.len());
            between = between - S::vector(gathered(lanes, shift, &pair));
        }
        let distance = between.dot(between).sqrt();
        PairDistances { between, distance, inverse_distance: distance.like(1.0) / distance, reach, radii }
    }

    /// Gathers the data of the pairs in one register for the stages of the contact law.
    #[inline(always)]
    fn pair<'l, L: Lanes>(
        &self,
        lanes: L,
        slots: &Slots,
        mut apart: PairDistances<S, SimdPack<L>>,
        law: &'l Constants<SimdPack<L>>,
    ) -> Pair<'l, S, SimdPack<L>> {
        let ([first, second], zero) = (slots, SimdPack::splat(lanes, 0.0));
        let GrainTables { place, movement, inverse_inertia: inertia, .. } = self.grains;
        let movement = &movement.as_chunks::<Q>().0[..place.len()];
        let (velocity, inverse_mass, mut inverse_masses, mut spins);
        if T::ACTIVE && Q == 1 {
            let moves = [gathered_of(lanes, movement, 0, first), gathered_of(lanes, movement, 0, second)];
            velocity = S::vector(moves[0]) - S::vector(moves[1]);
            (inverse_masses, inverse_mass) = ([moves[0][3], moves[1][3]], moves[0][3] + moves[1][3]);
            spins = Some([S::spin(moves[0]), S::spin(moves[1])]);
        } else {
            let moves = laws::between(lanes, movement, 0, [second, first]);
            (velocity, inverse_mass) = (S::vector(moves), moves[3]);
            (inverse_masses, spins) = ([zero; 2], None);
            if T::ACTIVE {
                let turns = [gathered_of(lanes, movement, Q - 1, first), gathered_of(lanes, movement, Q - 1, second)];
                apart.radii = [turns[0][3], turns[1][3]];
                spins = Some([S::spin(turns[0]), S::spin(turns[1])]);
            }
            if R::ACTIVE {
                let masses = [gathered_of(lanes, movement, 0, first), gathered_of(lanes, movement, 0, second)];
                inverse_masses = [masses[0][3], masses[1][3]];
            }
        }
        let mut inverse_inertia = [zero; 2];
        if R::ACTIVE {
            for (inverse, slots) in inverse_inertia.iter_mut().zip([first, second]) {
                let mut each = [0.0; WIDEST];
                for lane in 0..L::WIDTH {
                    each[lane] = inertia[slots[lane]];
                }
                *inverse = SimdPack::load(lanes, &each);
            }
        }
        Pair { law, apart, velocity, inverse_mass, inverse_masses, spins, inverse_inertia }
    }

    /// Reads the previous history of the contacts in one register, which start at index `from` of the contact list.
    #[inline(always)]
    fn remembered<L: Lanes>(&self, lanes: L, from: usize) -> Memory<SimdPack<L>> {
        let mut memory = [SimdPack::splat(lanes, 0.0); MEMORY];
        let ContactList { steady, remembered, before, .. } = self.touching;
        if *steady {
            for (number, now) in memory.iter_mut().zip(&self.memory).take(Self::NUMBERS) {
                let mut values = [0.0; WIDEST];
                values[..L::WIDTH].copy_from_slice(&now[from..from + L::WIDTH]);
                *number = SimdPack::load(lanes, &values);
            }
            return memory;
        }
        let mut places = [0; WIDEST];
        places.copy_from_slice(&remembered[from..from + WIDEST]);
        // Even if a block has changed, most contacts are still consecutive in the previous history.
        let follow = places[..L::WIDTH].iter().zip(0..).all(|(&place, lane)| place == places[0] + lane);
        for (number, before) in memory.iter_mut().zip(before).take(Self::NUMBERS) {
            let mut values = [0.0; WIDEST];
            if follow {
                values[..L::WIDTH].copy_from_slice(&before[places[0] as usize..][..L::WIDTH]);
            } else {
                for (value, &place) in values.iter_mut().zip(&places[..L::WIDTH]) {
                    *value = before[place as usize];
                }
            }
            *number = SimdPack::load(lanes, &values);
        }
        memory
    }

    /// Stores the history of the contacts in one register, which start at index `from` of the contact list.
    #[inline(always)]
    fn remember<L: Lanes>(&mut self, memory: &Memory<SimdPack<L>>, from: usize) {
        for (number, now) in memory.iter().zip(&mut self.memory).take(Self::NUMBERS) {
            now[from..from + L::WIDTH].copy_from_slice(&number.store()[..L::WIDTH]);
        }
    }

    /// Adds the forces and torques of `count` contacts to the sums of their grains, in the order of the contacts.
    #[inline(always)]
    fn add<L: Lanes>(&mut self, lanes: L, answer: &Answer<S, SimdPack<L>>, slots: &Slots, count: usize) {
        let zero = SimdPack::splat(lanes, 0.0);
        let one = S::load(answer.force, answer.torques[0], zero);
        let added = [one, S::load(-answer.force, answer.torques[1], zero)];
        // If the sums cover all grains and the register is full, no slot and no lane needs a check.
        match self.sums.all(self.grains.place.len()) {
            Some(mut all) if count == L::WIDTH => Self::add_to(lanes, &mut all, added, slots, L::WIDTH),
            _ => Self::add_to(lanes, &mut self.sums, added, slots, count),
        }
    }

    /// Adds force and torque of each contact to its first grain. The second grain receives the opposite force and its own
    /// torque.
    #[inline(always)]
    fn add_to<L: Lanes>(
        lanes: L,
        loads: &mut impl Loads,
        [one, other]: [[[SimdPack<L>; 4]; 2]; 2],
        [first, second]: &Slots,
        count: usize,
    ) {
        if Q == 2 {
            let other = spread_pairs(lanes, [one[0], other[1]]);
            let one = spread_pairs(lanes, one);
            for lane in 0..count {
                if let Some(load) = loads.load(first[lane]) {
                    lanes.add_to(load, one[lane]);
                }
                if let Some(load) = loads.load(second[lane]) {
                    lanes.oppose(load, other[lane]);
                }
            }
        } else if T::ACTIVE {
            let [one, other] = [spread(lanes, one[0]), spread(lanes, other[0])];
            for lane in 0..count {
                if let Some([load]) = loads.load(first[lane]) {
                    load.add(&one[lane]);
                }
                if let Some([load]) = loads.load(second[lane]) {
                    load.add(&other[lane]);
                }
            }
        } else {
            let one = spread(lanes, one[0]);
            for lane in 0..count {
                if let Some([force]) = loads.load(first[lane]) {
                    force.add(&one[lane]);
                }
                if let Some([force]) = loads.load(second[lane]) {
                    force.subtract(&one[lane]);
                }
            }
        }
    }
}

impl<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>, const Q: usize> Kernel for PairLoop<'_, S, N, T, R, Q> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let grains = self.grains.place.len();
        // These slices let the compiler check the bounds once instead of at every contact.
        self.grains.movement = &self.grains.movement[..grains * Q];
        self.grains.material = &self.grains.material[..grains];
        let (laws, touching) = (self.terms.laws, self.touching);
        let terms = Terms { record: L::WIDTH == 1 && self.seen.is_some(), ..self.terms };
        let mut law = laws.gather(lanes, &[0; WIDEST]);
        let mut aparts = [PairDistances::none(lanes); ROUND];
        for round in (0..touching.count).step_by(ROUND * L::WIDTH) {
            let end = touching.count.next_multiple_of(L::WIDTH).min(round + ROUND * L::WIDTH);
            let [first, second] = [&touching.first[round..end], &touching.second[round..end]];
            let mut from = round;
            for (slots, apart) in first.chunks_exact(L::WIDTH).zip(second.chunks_exact(L::WIDTH)).zip(&mut aparts) {
                if L::WIDTH < WIDEST {
                    let slots = [places(lanes, slots.0, grains), places(lanes, slots.1, grains)];
                    *apart = self.apart(lanes, &slots, from);
                }
                from += L::WIDTH;
            }
            let mut from = round;
            for (slots, apart) in first.chunks_exact(L::WIDTH).zip(second.chunks_exact(L::WIDTH)).zip(&aparts) {
                let slots = [places(lanes, slots.0, grains), places(lanes, slots.1, grains)];
                if !laws.is_one() {
                    law = laws.gather(lanes, &laws.numbers(self.grains.material, &slots));
                }
                let mut memory = self.remembered(lanes, from);
                let apart = if L::WIDTH < WIDEST { *apart } else { self.apart(lanes, &slots, from) };
                let answer = self.pair(lanes, &slots, apart, &law).respond::<N, T, R>(terms, &mut memory);
                let count = (touching.count - from).min(L::WIDTH);
                self.add(lanes, &answer, &slots, count);
                self.remember(&memory, from);
                if terms.record
                    && let Some(seen) = &mut self.seen
                    && self.sums.holds(slots[0][0])
                {
                    let ([[one, ..], [other, ..]], GrainTables { place, id, .. }) = (slots, self.grains);
                    let partner = Partner::Grain(id[other] + 1);
                    seen.add(&answer, id[one] + 1, partner, S::vector_in_space(&place[one]), place[one].0[3]);
                }
                from += L::WIDTH;
            }
        }
    }
}

/// Transposes four registers to one quad per lane.
#[inline(always)]
fn spread<L: Lanes>(lanes: L, [a, b, c, d]: [SimdPack<L>; 4]) -> [Quad; WIDEST] {
    lanes.quads([a.register(), b.register(), c.register(), d.register()])
}

/// Transposes eight registers to two quads per lane.
#[inline(always)]
fn spread_pairs<L: Lanes>(lanes: L, [[a, b, c, d], [e, f, g, h]]: [[SimdPack<L>; 4]; 2]) -> [L::Pair; WIDEST] {
    let one = [a.register(), b.register(), c.register(), d.register()];
    lanes.pairs([one, [e.register(), f.register(), g.register(), h.register()]])
}
