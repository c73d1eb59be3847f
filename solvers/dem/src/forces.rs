//! Loops over contacts between grains, and over contacts of grains with walls, for any combination of contact laws.
//!
//! The loops pass contacts to the chain of stages ([`crate::contact`]). They add the results to the forces and torques on
//! the grains, in the order of the neighbour list. Loops over walls and over pairs ([`crate::pairs`]) are compiled for
//! each combination of contact laws. Loops over pairs are also compiled for each instruction set. Pairs are processed one
//! by one instead of in SIMD registers if contacts are recorded.

use crate::contact::at_wall::WallContact;
use crate::contact::chain::Layout;
use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::tangential::Tangential;
use crate::contact::{MEMORY, Memory, Terms};
use crate::geometry::Geometry;
use crate::grains::{GrainTables, Grains, Sums};
use crate::listed::Pairs;
use crate::pairs::PairLoop;
use crate::seen::RecordedContacts;
use crate::touching::ContactList;
use crate::walls::{MovingWall, WallView};
use grainbench_lanes::{Processor, Quad};
use grainbench_solver::record::Partner;
use std::marker::PhantomData;

/// Loops over contacts for any combination of contact laws.
pub(crate) trait Forces<S: Geometry>: Send + Sync {
    /// Adds the forces and torques of the pairs in contact to the sums. `pairs` is the list of pairs and the index of one of
    /// its blocks, and `touching` holds the pairs in contact of this block. With `seen`, the method records every
    /// contact whose first grain is among the summed grains.
    fn of_pairs(
        &self,
        processor: Processor,
        terms: Terms<'_>,
        grains: (GrainTables<'_>, Sums<'_>),
        pairs: (&mut Pairs, usize),
        touching: &ContactList,
        seen: Option<&mut RecordedContacts>,
    );
    /// Adds the forces and torques at the wall with index `number` to its grains, and computes the force on the wall.
    /// Returns the number of contacts.
    fn at_wall(
        &self,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        wall: &mut MovingWall,
        number: u16,
        seen: Option<&mut RecordedContacts>,
    ) -> u64;
    /// Returns the layout of the contact history.
    fn layout(&self) -> Layout;
    /// Returns the number of history values of the tangential spring, that of the rolling spring, and the number of
    /// dimensions.
    fn springs(&self) -> [usize; 3];
    /// Returns true if tangential forces rotate the grains.
    fn turn(&self) -> bool;
    /// Returns the type name of the loops. It contains the number of dimensions and the stages.
    fn words(&self) -> &'static str;
}

/// Adds the forces and torques of a contact between the grain in `slot` and the wall with index `number`.
#[inline(always)]
fn at_contact<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>>(
    terms: Terms<'_>,
    grains: &mut Grains<S>,
    wall: &mut MovingWall,
    (slot, number): (usize, u16),
    facing: &WallView,
    memory: &mut Memory<f64>,
    seen: &mut Option<&mut RecordedContacts>,
) {
    let (position, radius) = (grains.position(slot), grains.radius(slot));
    let at_wall = WallContact::<S> {
        law: terms.laws.between(grains.material[slot], wall.initial.material),
        normal: S::vector_of(facing.normal),
        distance: facing.distance,
        radius,
        velocity: S::vector_of(grains.velocity(slot) - facing.velocity),
        inverse_mass: grains.inverse_mass(slot),
        spin: grains.spin(slot).filter(|_| T::ACTIVE).map(S::spin_of),
        wall_spin: S::spin_of(wall.spin),
        inertia: if R::ACTIVE { 1.0 / grains.inverse_inertia[slot] } else { 0.0 },
    };
    let answer = at_wall.respond::<N, T, R>(terms, memory);
    let [load, torque] = S::load(answer.force, answer.torques[0], 0.0);
    let at = grains.first_quad(slot);
    grains.load[at].add(&Quad(load));
    if S::DIMENSION == 3 && T::ACTIVE {
        grains.load[at + 1].add(&Quad(torque));
    }
    let force = S::whole(answer.force, 0.0);
    (0..3).for_each(|axis| wall.kept.force[axis] -= force[axis]);
    if let Some(seen) = seen {
        let (id, partner) = (grains.id[slot] + 1, Partner::Wall(number));
        seen.add(&answer, id, partner, position, radius);
    }
}

/// Chain of a normal stage `N`, a tangential stage `T` and a rolling stage `R`, in two or three dimensions (`S`).
pub(crate) struct Chain<S, N, T, R>(pub(crate) PhantomData<(S, N, T, R)>);

impl<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>> Chain<S, N, T, R> {
    /// True if the spin of a grain has a quad of its own. As a constant without an operation, it keeps the compiler from
    /// compiling the loop that is not used.
    const SEPARATE_SPINS: bool = T::ACTIVE && S::DIMENSION == 3;

    /// Evaluates the contacts of all grains at a mesh wall. A grain may be in contact with several parts of the mesh.
    fn at_mesh(
        &self,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        wall: &mut MovingWall,
        number: u16,
        mut seen: Option<&mut RecordedContacts>,
    ) -> u64 {
        let Some(mesh) = wall.mesh().cloned() else { return 0 };
        let mut at_mesh = std::mem::take(&mut wall.kept.at_mesh);
        let touching = at_mesh.evaluate(&mesh, grains, |grains, slot, touched, memory| {
            let facing = wall.facing_part(&mesh, grains.position(slot), touched);
            at_contact::<S, N, T, R>(terms, grains, wall, (slot, number), &facing, memory, &mut seen);
        });
        wall.kept.at_mesh = at_mesh;
        touching
    }
}

impl<S: Geometry, N: Normal, T: Tangential<S>, R: Rolling<S>> Forces<S> for Chain<S, N, T, R> {
    fn of_pairs(
        &self,
        processor: Processor,
        terms: Terms<'_>,
        grains: (GrainTables<'_>, Sums<'_>),
        pairs: (&mut Pairs, usize),
        touching: &ContactList,
        seen: Option<&mut RecordedContacts>,
    ) {
        if Self::SEPARATE_SPINS {
            PairLoop::<S, N, T, R, 2>::new(terms, grains, pairs, touching, seen).run_on(processor);
        } else {
            PairLoop::<S, N, T, R, 1>::new(terms, grains, pairs, touching, seen).run_on(processor);
        }
    }

    fn at_wall(
        &self,
        terms: Terms<'_>,
        grains: &mut Grains<S>,
        wall: &mut MovingWall,
        number: u16,
        mut seen: Option<&mut RecordedContacts>,
    ) -> u64 {
        wall.kept.force = Default::default();
        if wall.mesh().is_some() {
            return self.at_mesh(terms, grains, wall, number, seen);
        }
        let mut near = std::mem::take(&mut wall.kept.near);
        let mut touching = 0;
        for (entry, (slot, memory)) in near.iter_mut().enumerate() {
            let slot = *slot as usize;
            let facing = wall.facing(grains.position(slot));
            let is_covered = wall.covered.get(entry).is_some_and(|covered| *covered);
            if is_covered || facing.distance >= grains.radius(slot) {
                *memory = [0.0; MEMORY];
                continue;
            }
            touching += 1;
            at_contact::<S, N, T, R>(terms, grains, wall, (slot, number), &facing, memory, &mut seen);
        }
        wall.kept.near = near;
        touching
    }

    fn layout(&self) -> Layout {
        Layout::new::<S, T, R>()
    }

    fn springs(&self) -> [usize; 3] {
        [T::NUMBERS, R::NUMBERS, S::DIMENSION]
    }

    fn turn(&self) -> bool {
        T::ACTIVE
    }

    fn words(&self) -> &'static str {
        std::any::type_name::<Self>()
    }
}
