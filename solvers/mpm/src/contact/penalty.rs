//! Springs between surfaces: each tracer that has gone through another surface is pushed out by κ |g| a, with g the gap
//! (m), a the tracer's area and κ a stiffness per area; along the surface a spring of the same stiffness is stretched by
//! the slip and limited by Coulomb friction (Cundall & Strack 1979). Forces act where the surfaces meet, at the same point
//! on both, so linear momentum is kept to rounding and torques are right.

use super::grip::Grip;
use super::pairs::Pair;
use super::{FrictionTable, Other, Touch};
use crate::accounts::Tally;
use crate::basis::Basis;
use crate::bodies::Body;
use crate::grid::{Lattice, Node};
use crate::lanes::{Kernel, Lanes};
use crate::surface::Tracers;
use crate::walls::RigidPlane;
use grainbench_scene::space::Space;
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;

/// How far a surface can bulge beyond the box around its tracers (cells).
const BULGE: f64 = 0.25;

/// Depth at which surfaces are taken to have passed through each other, and are let go (cells).
const DEEPEST: f64 = 0.8;

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

/// Work of friction in a step (J) in which a spring of given stretch went to another, and slid for the rest of `slip`: the mean
/// force of the spring times what its end slid.
#[inline(always)]
fn rubbed<S: Space>(stiffness: f64, before: S::Vector, slip: S::Vector, after: S::Vector, normal: S::Vector) -> f64 {
    let slid = before + slip - after;
    let along = slid - normal * S::dot(slid, normal);
    0.5 * stiffness * S::dot(before + after, along)
}

/// Energy (J) in the springs of a tracer at the end of the step, when points and stresses are looked at: forces are those
/// at its beginning, and `slip` (m) is what the surfaces move against each other in a step. A spring that slips stores no more.
#[inline(always)]
fn energy_ahead<S: Space>(
    stiffness: f64,
    depth: f64,
    stretch: S::Vector,
    slip: S::Vector,
    normal: S::Vector,
    slipping: bool,
) -> f64 {
    let away = S::dot(slip, normal);
    let deeper = (depth - away).max(0.0);
    let stretched = if slipping { stretch * (deeper / depth) } else { stretch + slip - normal * away };
    0.5 * stiffness * (deeper * deeper + S::dot(stretched, stretched))
}

/// Springs along the surface that a tracer can have at a time.
const AT_ONCE: usize = 4;

/// A spring along the surface, stretched since `stamp` − some steps.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct Spring<S: Space> {
    /// What the tracer touches.
    other: Other,
    /// Evaluation at which it last touched.
    stamp: u64,
    stretch: S::Vector,
}

/// Springs along the surface of every tracer; one that did not touch at the last evaluation has been forgotten.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Springs<S: Space> {
    of: Vec<[Spring<S>; AT_ONCE]>,
    now: u64,
    /// Runs of the other surface that are near the tracers at hand.
    #[serde(skip)]
    near: Vec<usize>,
    /// How many have touched since the evaluation began.
    pub(crate) touched: u64,
}

impl<S: Space> Springs<S> {
    /// Memory that the springs of a tracer take up (B).
    pub(crate) const BYTES: usize = size_of::<[Spring<S>; AT_ONCE]>();

    pub(crate) fn new(tracers: usize) -> Self {
        let none = Spring { other: Other::Wall(u16::MAX), stamp: 0, stretch: S::ORIGIN };
        Self { of: vec![[none; AT_ONCE]; tracers], now: 1, near: Vec::new(), touched: 0 }
    }

    /// Of how many tracers.
    pub(crate) fn len(&self) -> usize {
        self.of.len()
    }

    /// Begins an evaluation.
    pub(crate) fn begin(&mut self) {
        self.now += 1;
        self.touched = 0;
    }

    /// Stretch of the spring of a tracer to what it touches; it counts as touching now.
    #[inline(always)]
    fn stretch(&mut self, tracer: usize, other: Other) -> &mut S::Vector {
        self.touched += 1;
        let (now, springs) = (self.now, &mut self.of[tracer]);
        let same = springs.iter().position(|spring| spring.other == other);
        let oldest = || (1..AT_ONCE).fold(0, |a, b| if springs[b].stamp < springs[a].stamp { b } else { a });
        let at = same.unwrap_or_else(oldest);
        let spring = &mut springs[at];
        if same.is_none() || spring.stamp + 1 < now {
            *spring = Spring { other, stamp: now, stretch: S::ORIGIN };
        }
        spring.stamp = now;
        &mut spring.stretch
    }
}

/// What all springs need to know.
pub(crate) struct Rules<'a> {
    pub(crate) lattice: &'a Lattice,
    pub(crate) friction: &'a FrictionTable,
    /// Stiffness per area in E'/h.
    pub(crate) penalty: f64,
    pub(crate) time_step: f64,
}

/// What springs tell of a step.
pub(crate) struct Told<'a, S: Space> {
    pub(crate) tally: &'a mut Tally,
    /// What touches, where it is asked for.
    pub(crate) touches: Option<&'a mut Vec<Touch<S>>>,
}

/// Springs of all bodies, with walls and with each other, in one step.
pub(crate) struct Push<'a, S: Space, B> {
    pub(crate) rules: Rules<'a>,
    pub(crate) bodies: &'a [Body],
    pub(crate) pairs: &'a [Pair<S>],
    pub(crate) tracers: &'a mut Tracers<S>,
    pub(crate) springs: &'a mut Springs<S>,
    pub(crate) walls: &'a mut [RigidPlane<S>],
    pub(crate) nodes: &'a mut [Node<S>],
    /// What each node counts for at most at a surface.
    pub(crate) most: &'a [f64],
    pub(crate) told: Told<'a, S>,
    pub(crate) basis: PhantomData<B>,
}

impl<S: Space, B: Basis> Kernel for Push<'_, S, B> {
    #[inline(always)]
    fn run<L: Lanes>(mut self, _: L) {
        self.at_walls();
        if !self.pairs.is_empty() {
            self.tracers.find_boxes();
        }
        for pair in self.pairs {
            for pair in [*pair, pair.exchanged()] {
                self.between(&pair);
            }
        }
    }
}

impl<S: Space, B: Basis> Push<'_, S, B> {
    /// Springs between bodies and walls.
    #[inline(always)]
    fn at_walls(&mut self) {
        let Self { rules, bodies, tracers, springs, walls, nodes, most, told, .. } = self;
        let cell = rules.lattice.shortest(S::DIMENSION);
        for (number, wall) in walls.iter_mut().enumerate() {
            let other = Other::Wall(number as u16);
            for (place, body) in bodies.iter().enumerate() {
                if lowest::<S>(body, wall) > 0.0 {
                    continue;
                }
                let Some(friction) = rules.friction.between(body.material, wall.material) else { continue };
                let stiffness = rules.penalty * body.deformable.plane_modulus() / cell;
                for at in body.tracers.clone() {
                    let position = tracers.position[at];
                    let depth = -wall.height(position);
                    if depth <= 0.0 {
                        continue;
                    }
                    let Some(grip) = Grip::<S>::new::<B>(rules.lattice, &body.part, position, nodes, most) else {
                        continue;
                    };
                    let area = S::dot(tracers.area[at], tracers.area[at]).sqrt();
                    let spring = stiffness * area;
                    let push = wall.normal * (spring * depth);
                    let slip = (grip.velocity - wall.velocity(position)) * rules.time_step;
                    let stretch = springs.stretch(at, other);
                    let (shear, stretched, slipping) =
                        rub::<S>(*stretch, slip, wall.normal, spring, friction * spring * depth);
                    told.tally.friction += rubbed::<S>(spring, *stretch, slip, stretched, wall.normal);
                    told.tally.springs += 0.5 * spring * (depth * depth + S::dot(stretched, stretched));
                    *stretch = stretched;
                    let force = push + shear;
                    grip.push::<B>(&body.part, force, nodes, most);
                    wall.force -= force;
                    let worked = S::dot(force, wall.velocity(position)) * rules.time_step;
                    told.tally.walls += worked;
                    // The other half of a wall's part is known now, too.
                    told.tally.taken += 0.5 * (worked - S::dot(force, slip));
                    if let Some(touches) = told.touches.as_mut() {
                        let energy = energy_ahead::<S>(spring, depth, stretched, slip, wall.normal, slipping);
                        let body = place as u32;
                        touches.push(Touch { body, other, point: position, push, shear, depth, slipping, energy });
                    }
                }
            }
        }
    }

    /// Springs between two bodies, from the tracers of `first` that have gone through the surface of `second`: half of the
    /// stiffness, since the tracers of the second do the same.
    #[inline(always)]
    fn between(&mut self, pair: &Pair<S>) {
        let Self { rules, bodies, tracers, springs, nodes, most, told, .. } = self;
        let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
        let cell = rules.lattice.shortest(S::DIMENSION);
        let moduli = [first, second].map(|body| body.deformable.plane_modulus());
        let harmonic = 2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]);
        let stiffness = 0.5 * rules.penalty * harmonic / cell;
        let Some(friction) = rules.friction.between(first.material, second.material) else { return };
        let reach = DEEPEST * cell;
        let [low, high] = second.bounds.map(|corner| S::restrict(corner) + pair.shift);
        let mut chunks = std::mem::take(&mut springs.near);
        for chunk in &tracers.chunks[first.chunks.clone()] {
            if !chunk.meets(low, high) {
                continue;
            }
            tracers.find_near(chunk, -pair.shift, &second.chunks, reach, &mut chunks);
            if chunks.is_empty() {
                continue;
            }
            for at in chunk.tracers.clone() {
                if beyond::<S>(tracers.position[at], low, high) > BULGE * cell {
                    continue;
                }
                let position = tracers.position[at] - pair.shift;
                let near = tracers.gone_through(chunks.iter().copied(), position, tracers.area[at], reach);
                let Some(near) = near.filter(|near| near.gap < 0.0) else { continue };
                let normal = tracers.normal(at);
                let depth = -near.gap;
                // Out of the second body, as the mean of both surfaces has it, so that no surface is preferred.
                let out = near.normal - normal;
                let out = out * (1.0 / S::dot(out, out).sqrt());
                let middle = position + near.normal * (0.5 * depth);
                let there = middle + pair.shift;
                let Some(one) = Grip::<S>::new::<B>(rules.lattice, &first.part, there, nodes, most) else { continue };
                let Some(two) = Grip::<S>::new::<B>(rules.lattice, &second.part, middle, nodes, most) else { continue };
                let area = S::dot(tracers.area[at], tracers.area[at]).sqrt();
                let spring = stiffness * area;
                let push = out * (spring * depth);
                let slip = (one.velocity - two.velocity) * rules.time_step;
                let other = Other::Body(pair.second);
                let stretch = springs.stretch(at, other);
                let (shear, stretched, slipping) = rub::<S>(*stretch, slip, out, spring, friction * spring * depth);
                told.tally.friction += rubbed::<S>(spring, *stretch, slip, stretched, out);
                told.tally.springs += 0.5 * spring * (depth * depth + S::dot(stretched, stretched));
                *stretch = stretched;
                let force = push + shear;
                one.push::<B>(&first.part, force, nodes, most);
                two.push::<B>(&second.part, -force, nodes, most);
                told.tally.taken -= 0.5 * S::dot(force, slip);
                if let Some(touches) = told.touches.as_mut() {
                    let energy = energy_ahead::<S>(spring, depth, stretched, slip, out, slipping);
                    let body = pair.first;
                    touches.push(Touch { body, other, point: there, push, shear, depth, slipping, energy });
                }
            }
        }
        springs.near = chunks;
    }
}

/// Height of the lowest corner of a body's box above a wall (m).
fn lowest<S: Space>(body: &Body, wall: &RigidPlane<S>) -> f64 {
    let normal = S::embed(wall.normal);
    let [low, high] = &body.bounds;
    let corner = normal.zip_zip_map(low, high, |n, low, high| if n > 0.0 { low } else { high });
    (corner - S::embed(wall.point)).dot(&normal)
}

/// How far beyond a box a position is, along the axis along which it is farthest (m); negative inside.
#[inline(always)]
fn beyond<S: Space>(position: S::Vector, low: S::Vector, high: S::Vector) -> f64 {
    let beyond = |axis: usize| {
        let at = |vector: S::Vector| S::component(vector, axis);
        (at(low) - at(position)).max(at(position) - at(high))
    };
    (0..S::DIMENSION).map(beyond).fold(f64::NEG_INFINITY, f64::max)
}
