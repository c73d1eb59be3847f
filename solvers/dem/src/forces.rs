//! The loops over contacts: pairs of grains that touch, and grains at walls.
//!
//! They hand what touches to the chain of stages ([`crate::contact`]) and add the answers to the forces and torques on the
//! grains, in the order of the list. Only these two loops are compiled for the laws of a scene; the loop over pairs for
//! each path of the processor too. Pairs that are recorded are taken one by one.

use crate::contact::at_wall::AtWall;
use crate::contact::chain::{Evaluation, Layout};
use crate::contact::normal::Normal;
use crate::contact::pair::Pair;
use crate::contact::rolling::Rolling;
use crate::contact::seen::Seen;
use crate::contact::tangential::Tangential;
use crate::contact::{MEMORY, Options};
use crate::geometry::Geometry;
use crate::grains::Grains;
use crate::laws::{Laws, gathered, places};
use crate::neighbours::Pairs;
use crate::touching::Touching;
use crate::walls::MovingWall;
use grainbench_lanes::{Kernel, Lanes, Processor, Quad, Single, WIDEST, Wide};
use grainbench_scene::record::Partner;
use std::marker::PhantomData;

/// What every contact of an evaluation is computed with.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    /// The contact laws of the scene.
    pub(crate) laws: &'a Laws,
    /// The options of the convention.
    pub(crate) options: &'a Options,
    /// Time since the last evaluation (s).
    pub(crate) elapsed: f64,
}

impl<'a> Terms<'a> {
    fn evaluation(&self, record: bool) -> Evaluation<'a> {
        Evaluation { options: self.options, elapsed: self.elapsed, record }
    }
}

/// The loops over contacts, whatever laws they were compiled for.
pub(crate) trait Forces<S: Geometry>: Send {
    /// Adds the forces and torques of the pairs that touch. Where `seen` is given every contact is kept in it.
    fn of_pairs(
        &self,
        processor: Processor,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        pairs: &mut Pairs,
        touching: &Touching,
        seen: Option<&mut Vec<Seen>>,
    );
    /// Adds the forces and torques at a wall, finds the force on it and how many grains touch it.
    fn at_wall(
        &self,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        wall: &mut MovingWall,
        number: u16,
        seen: Option<&mut Vec<Seen>>,
    ) -> u64;
    /// What a contact remembers.
    fn layout(&self) -> Layout;
    /// Whether tangential forces turn the grains.
    fn turn(&self) -> bool;
    /// The space and the stages in words.
    fn words(&self) -> &'static str;
}

/// A normal, a tangential and a rolling stage in a space.
pub(crate) struct Chain<S, N, T, R>(PhantomData<(S, N, T, R)>);

impl<S, N, T, R> Chain<S, N, T, R> {
    pub(crate) const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>> Forces<S> for Chain<S, N, T, R> {
    fn of_pairs(
        &self,
        processor: Processor,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        pairs: &mut Pairs,
        touching: &Touching,
        seen: Option<&mut Vec<Seen>>,
    ) {
        let one_by_one = seen.is_some();
        let of_pairs = OfPairs::<S, N, T, R> { terms, grains, pairs, touching, seen, chain: PhantomData };
        if one_by_one {
            of_pairs.run(Single);
        } else {
            processor.run(of_pairs);
        }
    }

    fn at_wall(
        &self,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        wall: &mut MovingWall,
        number: u16,
        mut seen: Option<&mut Vec<Seen>>,
    ) -> u64 {
        let mut near = std::mem::take(&mut wall.near);
        wall.force = Default::default();
        let mut touching = 0;
        for (slot, memory) in &mut near {
            let slot = *slot as usize;
            let (position, radius) = (grains.position(slot), grains.radius(slot));
            let facing = wall.facing(position);
            if facing.distance >= radius {
                *memory = [0.0; MEMORY];
                continue;
            }
            touching += 1;
            let at_wall = AtWall::<S> {
                law: terms.laws.between(grains.material[slot], wall.material()),
                normal: S::vector_of(facing.normal),
                distance: facing.distance,
                radius,
                velocity: S::vector_of(grains.velocity(slot) - facing.velocity),
                inverse_mass: grains.inverse_mass(slot),
                spin: grains.spin(slot).filter(|_| T::ACTIVE).map(|spin| S::as_spin(spin.into())),
                inertia: if R::ACTIVE { 1.0 / grains.inverse_inertia[slot] } else { 0.0 },
            };
            let answer = at_wall.respond::<N, T, R>(terms.evaluation(seen.is_some()), memory);
            let [load, torque] = S::load(answer.force, answer.torques[0], 0.0);
            grains.load[slot].add(&Quad(load));
            if let Some(sum) = grains.torque.get_mut(slot) {
                sum.add(&Quad(torque));
            }
            let force = S::whole(answer.force, 0.0);
            (0..3).for_each(|axis| wall.force[axis] -= force[axis]);
            if let Some(seen) = &mut seen {
                let (id, partner) = (grains.id[slot] + 1, Partner::Wall(number));
                seen.push(Seen::new(&answer, id, partner, position, radius));
            }
        }
        wall.near = near;
        touching
    }

    fn layout(&self) -> Layout {
        Layout::of::<S, T, R>()
    }

    fn turn(&self) -> bool {
        T::ACTIVE
    }

    fn words(&self) -> &'static str {
        std::any::type_name::<Self>()
    }
}

/// The loop over pairs that touch.
struct OfPairs<'a, S: Geometry, N, T, R> {
    terms: Terms<'a>,
    grains: &'a mut Grains<S>,
    pairs: &'a mut Pairs,
    touching: &'a Touching,
    seen: Option<&'a mut Vec<Seen>>,
    chain: PhantomData<(N, T, R)>,
}

impl<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>> Kernel for OfPairs<'_, S, N, T, R> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { terms, grains, pairs, touching, mut seen, chain: _ } = self;
        let zero = Wide::splat(lanes, 0.0);
        let evaluation = terms.evaluation(L::WIDTH == 1 && seen.is_some());
        let numbers = T::NUMBERS + R::NUMBERS;
        let mut law = terms.laws.gather(lanes, &[0; WIDEST]);
        let Grains { place, movement, turning, load, torque, inverse_inertia: inertia, material, id, .. } = grains;
        // Tables of one length: a place in one of them is a place in all.
        let grains = place.len();
        let (place, movement, load, material) =
            (&place[..], &movement[..grains], &mut load[..grains], &material[..grains]);
        let turns = if T::ACTIVE && S::DIMENSION == 3 { grains } else { 0 };
        let (turning, torque) = (&turning[..turns], &mut torque[..turns]);
        let kept_from = touching.kept_from();
        pairs.make_room(kept_from + touching.count);
        let Pairs { shift, memory: [low, high], next: [low_next, high_next], .. } = pairs;
        for from in (0..touching.count).step_by(L::WIDTH) {
            let first = places(lanes, &touching.first[from..], grains);
            let second = places(lanes, &touching.second[from..], grains);
            if !terms.laws.is_one() {
                let mut laws = [0; WIDEST];
                for lane in 0..L::WIDTH {
                    let [one, other] = [first[lane], second[lane]].map(|slot| material[slot]);
                    laws[lane] = terms.laws.number(one, other);
                }
                law = terms.laws.gather(lanes, &laws);
            }
            let sites = [gathered(lanes, place, &first), gathered(lanes, place, &second)];
            let moves = [gathered(lanes, movement, &first), gathered(lanes, movement, &second)];
            let mut between = S::vector(sites[1]) - S::vector(sites[0]);
            if !shift.is_empty() {
                let pair = places(lanes, &touching.pair[from..], shift.len());
                between = between - S::vector(gathered(lanes, shift, &pair));
            }
            let mut spins = None;
            if T::ACTIVE {
                let mut turned = [[zero; 4]; 2];
                if S::DIMENSION == 3 {
                    turned = [gathered(lanes, turning, &first), gathered(lanes, turning, &second)];
                }
                spins = Some([S::spin(moves[0], turned[0]), S::spin(moves[1], turned[1])]);
            }
            let mut inverse_inertia = [zero; 2];
            if R::ACTIVE {
                for (inverse, slots) in inverse_inertia.iter_mut().zip([&first, &second]) {
                    let mut each = [0.0; WIDEST];
                    for lane in 0..L::WIDTH {
                        each[lane] = inertia[slots[lane]];
                    }
                    *inverse = Wide::load(lanes, &each);
                }
            }
            let mut memory = [zero; MEMORY];
            if numbers > 0 {
                let remembered = places(lanes, &touching.remembered[from..], low.len());
                memory[..4].copy_from_slice(&gathered(lanes, low, &remembered));
            }
            if numbers > 4 {
                let remembered = places(lanes, &touching.remembered[from..], high.len());
                memory[4..].copy_from_slice(&gathered(lanes, high, &remembered));
            }
            let contact = Pair::<S, Wide<L>> {
                law: &law,
                between,
                radii: [sites[0][3], sites[1][3]],
                velocity: S::vector(moves[0]) - S::vector(moves[1]),
                inverse_masses: [moves[0][3], moves[1][3]],
                spins,
                inverse_inertia,
            };
            let answer = contact.respond::<N, T, R>(evaluation, &mut memory);

            let count = (touching.count - from).min(L::WIDTH);
            let [one, on_one] = S::load(answer.force, answer.torques[0], zero);
            let [other, on_other] = S::load(-answer.force, answer.torques[1], zero);
            let one = spread(lanes, one);
            if S::DIMENSION == 2 && T::ACTIVE {
                let other = spread(lanes, other);
                for lane in 0..count {
                    load[first[lane]].add(&one[lane]);
                    load[second[lane]].add(&other[lane]);
                }
            } else {
                for lane in 0..count {
                    load[first[lane]].add(&one[lane]);
                    load[second[lane]].subtract(&one[lane]);
                }
            }
            if S::DIMENSION == 3 && T::ACTIVE {
                let [on_one, on_other] = [spread(lanes, on_one), spread(lanes, on_other)];
                for lane in 0..count {
                    torque[first[lane]].add(&on_one[lane]);
                    torque[second[lane]].add(&on_other[lane]);
                }
            }
            if numbers > 0 {
                let quads = spread(lanes, [memory[0], memory[1], memory[2], memory[3]]);
                let at = kept_from + from;
                low_next[at..at + count].copy_from_slice(&quads[..count]);
            }
            if numbers > 4 {
                let quads = spread(lanes, [memory[4], memory[5], memory[6], memory[7]]);
                let at = kept_from + from;
                high_next[at..at + count].copy_from_slice(&quads[..count]);
            }
            if L::WIDTH == 1
                && let Some(seen) = &mut seen
            {
                let slot = first[0];
                let [id, partner] = [slot, second[0]].map(|slot| id[slot] + 1);
                let (centre, radius) = (S::vector_in_space(&place[slot]), place[slot].0[3]);
                seen.push(Seen::new(&answer, id, Partner::Grain(partner), centre, radius));
            }
        }
    }
}

/// A quad for each lane.
#[inline(always)]
fn spread<L: Lanes>(lanes: L, [a, b, c, d]: [Wide<L>; 4]) -> [Quad; WIDEST] {
    lanes.quads([a.register(), b.register(), c.register(), d.register()])
}
