//! Springs between surfaces. The force κ |g| a pushes out each tracer that penetrates another surface. Here g is the
//! gap (m), a the tracer's area (m²) and κ the stiffness per area (Pa/m). With friction, a tangential spring of the
//! same stiffness acts along the surface ([`super::friction`]). Forces on both surfaces act at the same contact point,
//! so linear momentum is conserved to rounding and torques are consistent.

use super::friction::{Coulomb, Overlap, Shear};
use super::search::{PenetratingPoint, SearchResults};
use super::{ContactPartner, ContactPoint, Rules};
use crate::boundary::walls::RigidPlane;
use crate::energy::ledger::Tally;
use crate::grid::basis::Basis;
use crate::grid::lattice::Node;
use crate::points::body::Body;
use crate::surface::shape_function::SurfaceShapeFunction;
use crate::surface::tracers::Tracers;
use grainbench_lanes::{FourKernel, FourLanes};
use grainbench_solver::space::Space;
use std::marker::PhantomData;

/// Friction and outputs of the springs in a step.
pub(crate) struct Springs<'a, S: Space> {
    /// Tangential springs, if there is friction.
    pub(crate) friction: Option<&'a mut Coulomb<S>>,
    /// Energies of contacts, if the run requests an energy budget.
    pub(crate) tally: Option<&'a mut Tally>,
    /// Contact points, if requested.
    pub(crate) touches: Option<&'a mut Vec<ContactPoint<S>>>,
    /// Number of tracers in contact.
    pub(crate) touched: &'a mut u64,
}

/// Kernel that applies the springs of one step between bodies, and between bodies and walls.
pub(crate) struct Push<'a, S: Space, B> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) found: &'a [SearchResults<S>],
    pub(crate) tracers: &'a Tracers<S>,
    pub(crate) walls: &'a mut [RigidPlane<S>],
    pub(crate) nodes: &'a mut [Node<S>],
    /// Weight limit of each node at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) springs: Springs<'a, S>,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis> FourKernel for Push<'_, S, B> {
    #[inline(always)]
    fn run<L: FourLanes>(mut self, _: L) {
        self.at_walls();
        for gone in self.found.iter().flat_map(|found| &found.gone) {
            self.between(gone);
        }
    }
}

impl<S: Space, B: Basis> Push<'_, S, B> {
    /// Applies springs between bodies and walls.
    #[inline(always)]
    fn at_walls(&mut self) {
        let Self { rules, bodies, tracers, walls, nodes, most, springs, .. } = self;
        let cell = rules.lattice.shortest(S::DIMENSION);
        for (number, wall) in walls.iter_mut().enumerate() {
            let other = ContactPartner::Wall(number as u16);
            for (place, body) in bodies.iter().enumerate() {
                if lowest::<S>(body, wall) > 0.0 {
                    continue;
                }
                let Some(coefficient) = rules.friction.between(body.material, wall.material) else { continue };
                let per_area = rules.setting.penalty * body.deformable.plane_modulus() / cell;
                for at in body.tracers.clone() {
                    let position = tracers.position[at];
                    let depth = -wall.height(position);
                    if depth <= 0.0 {
                        continue;
                    }
                    let Some(grip) = SurfaceShapeFunction::<S>::new::<B>(rules.lattice, body, position, nodes, most)
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
                    let force = springs.force(at, &overlap, place as u32, other, position);
                    grip.push::<B>(body, force, nodes, most);
                    wall.force -= force;
                    if let Some(tally) = &mut springs.tally {
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
        let Self { bodies, nodes, most, springs, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let force = springs.force(*tracer, overlap, pair.first, ContactPartner::Body(pair.second), *there);
        one.push::<B>(first, force, nodes, most);
        two.push::<B>(second, -force, nodes, most);
        if let Some(tally) = &mut springs.tally {
            tally.taken -= 0.5 * S::dot(force, overlap.slip);
        }
    }
}

impl<S: Space> Springs<'_, S> {
    /// Returns the force on a tracer of a body at a contact `point` (m), which is the normal force k g plus friction (N).
    /// Records the requested outputs.
    #[inline(always)]
    fn force(
        &mut self,
        tracer: usize,
        overlap: &Overlap<S>,
        body: u32,
        other: ContactPartner,
        point: S::Vector,
    ) -> S::Vector {
        *self.touched += 1;
        let &Overlap { depth, normal, stiffness, .. } = overlap;
        let push = normal * (stiffness * depth);
        let has_friction = self.friction.is_some();
        let shear = match &mut self.friction {
            Some(friction) => friction.respond(tracer, other, overlap),
            None => Shear::without_friction(overlap),
        };
        let force = if has_friction { push + shear.force } else { push };
        if let Some(tally) = &mut self.tally {
            if has_friction {
                tally.friction += shear.rubbed(overlap);
            }
            tally.springs += shear.energy(overlap);
        }
        if let Some(touches) = &mut self.touches {
            let energy = shear.energy_ahead(overlap);
            let (shear, slipping) = (shear.force, shear.slipping);
            touches.push(ContactPoint { body, other, point, push, shear, depth, slipping, energy });
        }
        force
    }
}

/// Returns the height of the lowest corner of a body's bounding box above a wall (m).
fn lowest<S: Space>(body: &Body, wall: &RigidPlane<S>) -> f64 {
    let normal = S::embed(wall.normal);
    let [low, high] = &body.bounds;
    let corner = normal.zip_zip_map(low, high, |n, low, high| if n > 0.0 { low } else { high });
    (corner - S::embed(wall.point)).dot(&normal)
}
