//! The loops over contacts: pairs of grains, and grains at walls.
//!
//! They find what touches, hand it to the chain of stages ([`crate::contact`]) and add the answers to the forces and
//! torques on the grains. Tangential and rolling springs are stretched by what slipped and rolled in the time `elapsed`
//! (s) since the last evaluation. With `RECORD` every contact is kept in `seen`.

use crate::contact::Options;
use crate::contact::at_wall::AtWall;
use crate::contact::chain::Memory;
use crate::contact::normal::Normal;
use crate::contact::pair::Pair;
use crate::contact::rolling::Rolling;
use crate::contact::seen::Seen;
use crate::contact::tangential::Tangential;
use crate::grains::Grains;
use crate::laws::Laws;
use crate::neighbours::Neighbours;
use crate::rotation::Rotation;
use crate::walls::MovingWall;
use grainbench_scene::record::{Counts, Partner};
use grainbench_scene::space::Space;

/// What every contact of an evaluation is computed with.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    /// The contact laws of the scene.
    pub(crate) laws: &'a Laws,
    /// The options of the convention.
    pub(crate) options: Options,
    /// Time since the last evaluation (s).
    pub(crate) elapsed: f64,
}

/// Forces and torques at the contacts between grains; with `ACROSS`, of pairs across a periodic face, else of all other
/// pairs.
pub(crate) fn pairs<S, N, T, R, const RECORD: bool, const ACROSS: bool>(
    terms: Terms<'_>,
    grains: &mut Grains<S, T::Rotation>,
    neighbours: &mut Neighbours<S, Memory<S, T, R>>,
    seen: &mut Vec<Seen<S>>,
    cost: &mut Counts,
) where
    S: Space,
    N: Normal,
    T: Tangential<S>,
    R: Rolling<S>,
{
    let pairs = if ACROSS { &mut neighbours.across } else { &mut neighbours.near };
    if pairs.partner.is_empty() {
        return;
    }
    cost.pair_tests += pairs.partner.len() as u64;
    let mut touching = 0_u64;
    for (row, ends) in pairs.start.windows(2).enumerate() {
        let range = ends[0] as usize..ends[1] as usize;
        if ACROSS && range.is_empty() {
            continue;
        }
        let (place, movement, rotation) = (grains.place[row], grains.movement[row], grains.rotation[row]);
        let laws = terms.laws.of(grains.material[row]);
        let shifts = if ACROSS { &neighbours.shift[range.clone()] } else { &[] };
        let mut force = S::ORIGIN;
        let mut torque = <T::Rotation as Rotation<S>>::Torque::default();
        let listed = pairs.partner[range.clone()].iter().zip(&mut pairs.history[range]);
        for (at, (&partner, history)) in listed.enumerate() {
            let other = partner as usize;
            let other_place = &grains.place[other];
            let mut between = other_place.position - place.position;
            if ACROSS {
                between -= shifts[at];
            }
            let squared = S::dot(between, between);
            let reach = place.radius + other_place.radius;
            if squared < reach * reach {
                touching += 1;
                let other_movement = &grains.movement[other];
                let pair = Pair {
                    law: &laws[usize::from(grains.material[other])],
                    between,
                    squared,
                    radii: [place.radius, other_place.radius],
                    velocity: movement.velocity - other_movement.velocity,
                    inverse_masses: [movement.inverse_mass, other_movement.inverse_mass],
                    spins: [rotation.spin(), grains.rotation[other].spin()],
                    inertia: if R::ACTIVE { [rotation.inertia(), grains.rotation[other].inertia()] } else { [0.0; 2] },
                };
                let answer = pair.respond::<N, T, R, RECORD>(&terms.options, terms.elapsed, history);
                force += answer.force;
                grains.force[other] -= answer.force;
                if T::ACTIVE {
                    T::Rotation::add(&mut torque, answer.twist * answer.arms[0]);
                    T::Rotation::add(&mut grains.torque[other], answer.twist * answer.arms[1]);
                }
                if R::ACTIVE {
                    T::Rotation::add(&mut torque, answer.rolling);
                    T::Rotation::add(&mut grains.torque[other], -answer.rolling);
                }
                if RECORD {
                    let [id, partner] = [row, other].map(|slot| grains.id[slot] + 1);
                    seen.push(Seen::new(&answer, id, Partner::Grain(partner), place.position, place.radius));
                }
            } else {
                *history = Memory::<S, T, R>::default();
            }
        }
        grains.force[row] += force;
        if T::ACTIVE {
            T::Rotation::add(&mut grains.torque[row], T::Rotation::torque(torque));
        }
    }
    cost.contact_evaluations += touching;
}

/// Forces and torques at the contacts between grains and walls, and the force on every wall.
pub(crate) fn wall_contacts<S, N, T, R, const RECORD: bool>(
    terms: Terms<'_>,
    grains: &mut Grains<S, T::Rotation>,
    walls: &mut [MovingWall<S, Memory<S, T, R>>],
    seen: &mut Vec<Seen<S>>,
    cost: &mut Counts,
) where
    S: Space,
    N: Normal,
    T: Tangential<S>,
    R: Rolling<S>,
{
    for (number, wall) in walls.iter_mut().enumerate() {
        let mut near = std::mem::take(&mut wall.near);
        wall.force = S::ORIGIN;
        cost.pair_tests += near.len() as u64;
        for (slot, history) in &mut near {
            let slot = *slot as usize;
            let place = grains.place[slot];
            let facing = wall.facing(place.position);
            if facing.distance >= place.radius {
                *history = Memory::<S, T, R>::default();
                continue;
            }
            let movement = grains.movement[slot];
            let rotation = grains.rotation[slot];
            let at_wall = AtWall {
                law: &terms.laws.of(grains.material[slot])[usize::from(wall.material())],
                normal: facing.normal,
                distance: facing.distance,
                radius: place.radius,
                velocity: movement.velocity - facing.velocity,
                inverse_mass: movement.inverse_mass,
                spin: rotation.spin(),
                inertia: if R::ACTIVE { rotation.inertia() } else { 0.0 },
            };
            let answer = at_wall.respond::<N, T, R, RECORD>(&terms.options, terms.elapsed, history);
            grains.force[slot] += answer.force;
            wall.force -= answer.force;
            if T::ACTIVE {
                T::Rotation::add(&mut grains.torque[slot], answer.twist * answer.arms[0]);
            }
            if R::ACTIVE {
                T::Rotation::add(&mut grains.torque[slot], answer.rolling);
            }
            cost.contact_evaluations += 1;
            if RECORD {
                let (id, partner) = (grains.id[slot] + 1, Partner::Wall(number as u16));
                seen.push(Seen::new(&answer, id, partner, place.position, place.radius));
            }
        }
        wall.near = near;
    }
}
