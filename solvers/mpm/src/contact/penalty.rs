//! Springs between surfaces: each tracer that has gone through another surface is pushed out by κ |g| a, with g the gap
//! (m), a the tracer's area and κ a stiffness per area; along the surface a spring of the same stiffness rubs, where
//! there is friction ([`super::friction`]). Forces act where the surfaces meet, at the same point on both, so linear
//! momentum is kept to rounding and torques are right.

use super::friction::{Friction, Overlap, Tangential};
use super::grip::Grip;
use super::search::{Found, Gone};
use super::{FrictionTable, Other, Touch};
use crate::basis::Basis;
use crate::bodies::Body;
use crate::grid::{Lattice, Node};
use crate::ledger::Ledger;
use crate::surface::Tracers;
use crate::walls::RigidPlane;
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_scene::space::Space;
use std::marker::PhantomData;

/// What is kept of springs from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Springs<S: Space> {
    /// Springs along surfaces, or their absence.
    pub(crate) friction: Friction<S>,
    /// What each share of the pairs has found.
    pub(crate) found: Vec<Found<S>>,
    /// How many tracers have touched since the evaluation began.
    pub(crate) touched: u64,
}

impl<S: Space> Springs<S> {
    /// Those of so many tracers, with friction if it `acts`.
    pub(crate) fn new(acts: bool, tracers: usize) -> Self {
        Self { friction: Friction::new(acts, tracers), found: Vec::new(), touched: 0 }
    }

    /// Begins an evaluation.
    pub(crate) const fn begin(&mut self) {
        self.friction.begin();
        self.touched = 0;
    }
}

/// What all springs need to know.
#[derive(Clone, Copy)]
pub(crate) struct Rules<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) friction: &'a FrictionTable,
    /// Stiffness per area in E'/h.
    pub(crate) penalty: f64,
    pub(crate) time_step: f64,
}

/// What springs tell of a step.
pub(crate) struct Told<'a, S: Space, A> {
    /// The energy budget, or its absence.
    pub(crate) ledger: A,
    /// What touches, where it is asked for.
    pub(crate) touches: Option<&'a mut Vec<Touch<S>>>,
    /// How many tracers have touched.
    pub(crate) touched: &'a mut u64,
}

/// Springs of all bodies, with walls and with each other, in one step: with friction or without, with an energy budget
/// or without.
pub(crate) struct Push<'a, S: Space, B, F, A> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) found: &'a [Found<S>],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) friction: F,
    pub(crate) walls: &'a mut [RigidPlane<S>],
    pub(crate) nodes: &'a mut [Node<S>],
    /// What each node counts for at most at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) told: Told<'a, S, A>,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis, F: Tangential<S>, A: Ledger> FourKernel for Push<'_, S, B, F, A> {
    #[inline(always)]
    fn run<L: FourLanes>(mut self, _: L) {
        self.at_walls();
        for gone in self.found.iter().flat_map(|found| &found.gone) {
            self.between(gone);
        }
    }
}

impl<S: Space, B: Basis, F: Tangential<S>, A: Ledger> Push<'_, S, B, F, A> {
    /// Springs between bodies and walls.
    #[inline(always)]
    fn at_walls(&mut self) {
        let Self { rules, bodies, tracers, friction, walls, nodes, most, told, .. } = self;
        let cell = rules.lattice.shortest(S::DIMENSION);
        for (number, wall) in walls.iter_mut().enumerate() {
            let other = Other::Wall(number as u16);
            for (place, body) in bodies.iter().enumerate() {
                if lowest::<S>(body, wall) > 0.0 {
                    continue;
                }
                let Some(coefficient) = rules.friction.between(body.material, wall.material) else { continue };
                let per_area = rules.penalty * body.deformable.plane_modulus() / cell;
                for at in body.tracers.clone() {
                    let position = tracers.position[at];
                    let depth = -wall.height(position);
                    if depth <= 0.0 {
                        continue;
                    }
                    let Some(grip) = Grip::<S>::new::<B>(rules.lattice, &body.part, position, nodes, most) else {
                        continue;
                    };
                    let overlap = Overlap {
                        depth,
                        normal: wall.normal,
                        stiffness: per_area * S::dot(tracers.area[at], tracers.area[at]).sqrt(),
                        slip: (grip.velocity - wall.velocity(position)) * rules.time_step,
                        friction: coefficient,
                    };
                    let place = Place { body: place as u32, other, point: position };
                    let force = told.force(friction, at, &overlap, place);
                    grip.push::<B>(&body.part, force, nodes, most);
                    wall.force -= force;
                    if let Some(tally) = told.ledger.tally() {
                        let worked = S::dot(force, wall.velocity(position)) * rules.time_step;
                        tally.walls += worked;
                        // The other half of a wall's part is known now, too.
                        tally.taken += 0.5 * (worked - S::dot(force, overlap.slip));
                    }
                }
            }
        }
    }

    /// The spring between two bodies at a tracer of the first that has gone through the surface of the second.
    #[inline(always)]
    fn between(&mut self, Gone { pair, tracer, overlap, there, grips: [one, two] }: &Gone<S>) {
        let Self { bodies, friction, nodes, most, told, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let place = Place { body: pair.first, other: Other::Body(pair.second), point: *there };
        let force = told.force(friction, *tracer, overlap, place);
        one.push::<B>(&first.part, force, nodes, most);
        two.push::<B>(&second.part, -force, nodes, most);
        if let Some(tally) = told.ledger.tally() {
            tally.taken -= 0.5 * S::dot(force, overlap.slip);
        }
    }
}

/// Where a tracer of a body touches.
struct Place<S: Space> {
    body: u32,
    other: Other,
    /// Where (m).
    point: S::Vector,
}

impl<S: Space, A: Ledger> Told<'_, S, A> {
    /// Force (N) on a tracer: what pushes it out, k g along the normal, and friction. What is asked for is told.
    #[inline(always)]
    fn force<F: Tangential<S>>(
        &mut self,
        friction: &mut F,
        tracer: usize,
        overlap: &Overlap<S>,
        Place { body, other, point }: Place<S>,
    ) -> S::Vector {
        *self.touched += 1;
        let &Overlap { depth, normal, stiffness, .. } = overlap;
        let push = normal * (stiffness * depth);
        let shear = friction.respond(tracer, other, overlap);
        if let Some(tally) = self.ledger.tally() {
            if F::ACTIVE {
                tally.friction += shear.rubbed(overlap);
            }
            tally.springs += shear.energy(overlap);
        }
        if let Some(touches) = self.touches.as_mut() {
            let energy = shear.energy_ahead(overlap);
            let (shear, slipping) = (shear.force, shear.slipping);
            touches.push(Touch { body, other, point, push, shear, depth, slipping, energy });
        }
        if F::ACTIVE { push + shear.force } else { push }
    }
}

/// Height of the lowest corner of a body's box above a wall (m).
fn lowest<S: Space>(body: &Body, wall: &RigidPlane<S>) -> f64 {
    let normal = S::embed(wall.normal);
    let [low, high] = &body.bounds;
    let corner = normal.zip_zip_map(low, high, |n, low, high| if n > 0.0 { low } else { high });
    (corner - S::embed(wall.point)).dot(&normal)
}
