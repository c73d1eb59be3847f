//! Springs between surfaces: each tracer that has gone through another surface is pushed out by κ |g| a, with g the gap
//! (m), a the tracer's area and κ a stiffness per area; along the surface a spring of the same stiffness is stretched by
//! the slip and limited by Coulomb friction (Cundall & Strack 1979). Forces act where the surfaces meet, at the same point
//! on both, so linear momentum is kept to rounding and torques are right.

use super::{FrictionTable, Other, Touch};
use crate::basis::Basis;
use crate::bodies::Body;
use crate::grid::{Lattice, Node, Stencil};
use crate::surface::Tracers;
use crate::transfer::Part;
use crate::walls::RigidPlane;
use grainbench_scene::space::Space;

/// A body as a point on its surface sees it: the nodes around that carry mass.
pub(crate) struct Grip<S: Space> {
    stencil: Stencil,
    /// Sum of the functions of the nodes that carry mass.
    total: f64,
    /// Velocity there (m/s).
    pub(crate) velocity: S::Vector,
}

impl<S: Space> Grip<S> {
    /// The body at `position`; none where it has no mass around. Nodes hold momenta.
    #[inline(always)]
    pub(crate) fn new<B: Basis>(
        lattice: &Lattice,
        part: &Part,
        position: S::Vector,
        nodes: &[Node<S>],
    ) -> Option<Self> {
        let stencil = Stencil::new::<S, B>(lattice, position, part.half);
        if !part.window.holds(S::DIMENSION, stencil.base(), B::WIDTH as i32) {
            return None;
        }
        let (mut total, mut velocity) = (0.0, S::ORIGIN);
        stencil.each::<S, B>(&part.window, |node| {
            let at = &nodes[node.slot];
            if at.mass > 0.0 {
                total += node.weight;
                velocity += at.velocity * (node.weight / at.mass);
            }
        });
        (total > 1e-6).then(|| Self { stencil, total, velocity: velocity * (1.0 / total) })
    }

    /// A force (N) on the body there.
    #[inline(always)]
    pub(crate) fn push<B: Basis>(&self, part: &Part, force: S::Vector, nodes: &mut [Node<S>]) {
        let share = force * (1.0 / self.total);
        self.stencil.each::<S, B>(&part.window, |node| {
            let at = &mut nodes[node.slot];
            if at.mass > 0.0 {
                at.change += share * node.weight;
            }
        });
    }
}

/// Force along the surface after `slip` (m) more, and the spring's new stretch: −k s, at most μ times the push.
#[inline(always)]
pub(crate) fn rub<S: Space>(
    stretch: S::Vector,
    slip: S::Vector,
    normal: S::Vector,
    stiffness: f64,
    limit: f64,
) -> (S::Vector, S::Vector, bool) {
    let moved = stretch + slip;
    let along = moved - normal * S::dot(moved, normal);
    let size = stiffness * S::dot(along, along).sqrt();
    if size <= limit {
        (along * -stiffness, along, false)
    } else {
        let kept = along * (limit / size);
        (kept * -stiffness, kept, true)
    }
}

/// What springs at walls need to know.
pub(crate) struct WallSprings<'a, S: Space> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) friction: &'a FrictionTable,
    /// Stiffness per area in E'/h.
    pub(crate) penalty: f64,
    pub(crate) time_step: f64,
    /// Stretch of the springs of each tracer, wall by wall.
    pub(crate) stretches: &'a mut [Vec<S::Vector>],
}

/// Springs between bodies and walls; what touches is added to `touches` when it is asked for.
pub(crate) fn at_walls<S: Space, B: Basis>(
    springs: &mut WallSprings<'_, S>,
    bodies: &[Body],
    tracers: &Tracers<S>,
    walls: &mut [RigidPlane<S>],
    nodes: &mut [Node<S>],
    mut touches: Option<&mut Vec<Touch<S>>>,
) {
    let cell = springs.lattice.shortest(S::DIMENSION);
    for (number, (wall, stretches)) in walls.iter_mut().zip(springs.stretches.iter_mut()).enumerate() {
        for (place, body) in bodies.iter().enumerate() {
            if lowest::<S>(body, wall) > 0.0 {
                continue;
            }
            let friction = springs.friction.between(body.material, wall.material);
            let stiffness = springs.penalty * body.deformable.plane_modulus() / cell;
            for at in body.tracers.clone() {
                let position = tracers.position[at];
                let depth = -wall.height(position);
                if depth <= 0.0 {
                    stretches[at] = S::ORIGIN;
                    continue;
                }
                let Some(grip) = Grip::<S>::new::<B>(springs.lattice, &body.part, position, nodes) else { continue };
                let area = S::dot(tracers.area[at], tracers.area[at]).sqrt();
                let spring = stiffness * area;
                let push = wall.normal * (spring * depth);
                let slip = (grip.velocity - wall.velocity(position)) * springs.time_step;
                let (shear, stretch, slipping) =
                    rub::<S>(stretches[at], slip, wall.normal, spring, friction * spring * depth);
                stretches[at] = stretch;
                let force = push + shear;
                grip.push::<B>(&body.part, force, nodes);
                wall.force -= force;
                if let Some(touches) = touches.as_mut() {
                    let other = Other::Wall(number as u16);
                    let energy = 0.5 * spring * (depth * depth + S::dot(stretch, stretch));
                    touches.push(Touch {
                        body: place as u32,
                        other,
                        point: position,
                        push,
                        shear,
                        depth,
                        slipping,
                        energy,
                    });
                }
            }
        }
    }
}

/// Height of the lowest corner of a body's box above a wall (m).
fn lowest<S: Space>(body: &Body, wall: &RigidPlane<S>) -> f64 {
    let normal = S::embed(wall.normal);
    let [low, high] = &body.bounds;
    let corner = normal.zip_zip_map(low, high, |n, low, high| if n > 0.0 { low } else { high });
    (corner - S::embed(wall.point)).dot(&normal)
}
