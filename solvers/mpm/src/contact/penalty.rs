//! Springs between surfaces. The force κ |g| a pushes out each tracer that penetrates another surface. Here g is the
//! gap (m), a the tracer's area (m²) and κ the stiffness per area (Pa/m). With friction, a tangential spring of the
//! same stiffness acts along the surface ([`super::friction`]). Forces on both surfaces act at the same contact point,
//! so linear momentum is conserved to rounding and torques are consistent.

use super::friction::{Friction, Overlap, Tangential};
use super::search::{PenetratingPoint, Rules, SearchResults};
use super::{ContactPartner, ContactPoint};
use crate::boundary::walls::RigidPlane;
use crate::energy::ledger::Ledger;
use crate::grid::basis::Basis;
use crate::grid::lattice::Node;
use crate::points::body::Body;
use crate::surface::shape_function::SurfaceShapeFunction;
use crate::surface::tracers::Tracers;
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_solver::space::Space;
use std::marker::PhantomData;

/// Springs of all tracers, with the results of the contact search.
#[derive(Clone, Debug)]
pub(crate) struct Springs<S: Space> {
    /// Tangential springs, if there is friction.
    pub(crate) friction: Friction<S>,
    /// Penetrating tracers, with one list for each subrange of pairs.
    pub(crate) found: Vec<SearchResults<S>>,
    /// Number of tracers in contact since the evaluation began.
    pub(crate) touched: u64,
}

impl<S: Space> Springs<S> {
    /// Creates the springs of a number of tracers, with friction if it `acts`.
    pub(crate) fn new(acts: bool, tracers: usize) -> Self {
        Self { friction: Friction::new(acts, tracers), found: Vec::new(), touched: 0 }
    }

    /// Starts a new evaluation of all contacts.
    pub(crate) const fn begin(&mut self) {
        self.friction.begin();
        self.touched = 0;
    }
}

/// Outputs of the springs in a step.
pub(crate) struct SpringOutputs<'a, S: Space, A> {
    /// Receiver of contact energies; `AbsentEffect` if the run requests no energy budget.
    pub(crate) ledger: A,
    /// Contact points, if requested.
    pub(crate) touches: Option<&'a mut Vec<ContactPoint<S>>>,
    /// Number of tracers in contact.
    pub(crate) touched: &'a mut u64,
}

/// Kernel that applies the springs of one step between bodies, and between bodies and walls. Type parameters select
/// friction and energy budget.
pub(crate) struct Push<'a, S: Space, B, F, A> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) found: &'a [SearchResults<S>],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) friction: F,
    pub(crate) walls: &'a mut [RigidPlane<S>],
    pub(crate) nodes: &'a mut [Node<S>],
    /// Weight limit of each node at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) told: SpringOutputs<'a, S, A>,
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
    /// Applies springs between bodies and walls.
    #[inline(always)]
    fn at_walls(&mut self) {
        let Self { rules, bodies, tracers, friction, walls, nodes, most, told: outputs, .. } = self;
        let cell = rules.lattice.shortest(S::DIMENSION);
        for (number, wall) in walls.iter_mut().enumerate() {
            let other = ContactPartner::Wall(number as u16);
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
                    let Some(grip) =
                        SurfaceShapeFunction::<S>::new::<B>(rules.lattice, &body.part, position, nodes, most)
                    else {
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
                    let force = outputs.force(friction, at, &overlap, place);
                    grip.push::<B>(&body.part, force, nodes, most);
                    wall.force -= force;
                    if let Some(tally) = outputs.ledger.tally() {
                        let worked = S::dot(force, wall.velocity(position)) * rules.time_step;
                        tally.walls += worked;
                        // The velocity of the wall is prescribed, so its contribution with the velocity after the step
                        // is known already.
                        tally.taken += 0.5 * (worked - S::dot(force, overlap.slip));
                    }
                }
            }
        }
    }

    /// Applies the spring at a tracer of the first body of a pair that penetrates the surface of the second body.
    #[inline(always)]
    fn between(&mut self, PenetratingPoint { pair, tracer, overlap, there, grips: [one, two] }: &PenetratingPoint<S>) {
        let Self { bodies, friction, nodes, most, told: outputs, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let place = Place { body: pair.first, other: ContactPartner::Body(pair.second), point: *there };
        let force = outputs.force(friction, *tracer, overlap, place);
        one.push::<B>(&first.part, force, nodes, most);
        two.push::<B>(&second.part, -force, nodes, most);
        if let Some(tally) = outputs.ledger.tally() {
            tally.taken -= 0.5 * S::dot(force, overlap.slip);
        }
    }
}

/// Contact point of a tracer.
struct Place<S: Space> {
    body: u32,
    other: ContactPartner,
    /// Contact point (m).
    point: S::Vector,
}

impl<S: Space, A: Ledger> SpringOutputs<'_, S, A> {
    /// Returns the force on a tracer (N), which is the normal force k g plus friction. Records the requested outputs.
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
            touches.push(ContactPoint { body, other, point, push, shear, depth, slipping, energy });
        }
        if F::ACTIVE { push + shear.force } else { push }
    }
}

/// Returns the height of the lowest corner of a body's bounding box above a wall (m).
fn lowest<S: Space>(body: &Body, wall: &RigidPlane<S>) -> f64 {
    let normal = S::embed(wall.normal);
    let [low, high] = &body.bounds;
    let corner = normal.zip_zip_map(low, high, |n, low, high| if n > 0.0 { low } else { high });
    (corner - S::embed(wall.point)).dot(&normal)
}
