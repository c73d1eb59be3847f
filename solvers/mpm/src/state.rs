//! The state: bodies and their material points.

use crate::basis::with_basis;
use crate::bodies::Body;
use crate::failure::Failure;
use crate::grid::{Lattice, Stencil};
use crate::options::Basis;
use crate::points::Points;
use crate::runs::{self, LONGEST, Run};
use grainbench_scene::solver::Cause;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// Points are put in order when they make more runs than in order, by one in so many.
const DISORDER: usize = 8;

/// Bodies and points.
#[derive(Clone, Debug)]
pub(crate) struct State<S: Space> {
    pub(crate) bodies: Vec<Body>,
    pub(crate) points: Points<S>,
    /// Velocities of the points a step before those of the last look (m/s): velocities are half a step behind
    /// positions.
    pub(crate) before: Vec<S::Vector>,
    /// Runs of points in the step under way.
    pub(crate) runs: Vec<Run>,
    /// Velocity gradients of the points at hand (1/s).
    pub(crate) gradients: Vec<S::Matrix>,
}

impl<S: Space> State<S> {
    pub(crate) fn new(bodies: Vec<Body>, points: Points<S>) -> Self {
        Self { bodies, points, before: Vec::new(), runs: Vec::new(), gradients: vec![S::NO_GRADIENT; LONGEST] }
    }

    /// Memory that is in use (B).
    pub(crate) fn bytes(&self) -> usize {
        self.points.bytes() + size_of_val(&*self.before) + size_of_val(&*self.runs) + size_of_val(&*self.bodies)
    }

    /// Finds the points of a body that reach the same nodes. Where they no longer follow each other they are put in the
    /// order of their cells.
    pub(crate) fn find_runs(&mut self, place: usize, basis: Basis, lattice: &Lattice) {
        let Self { bodies, points, runs, .. } = self;
        let part = &mut bodies[place].part;
        with_basis!(basis, B => {
            part.runs = runs::find::<S, B>(lattice, part.points.clone(), points, runs);
            if part.runs.len() > part.runs_in_order + part.runs_in_order / DISORDER {
                points.sort(part.points.clone(), |position| part.window.slot(lattice.first::<S, B>(position)));
                runs.truncate(part.runs.start);
                part.runs = runs::find::<S, B>(lattice, part.points.clone(), points, runs);
                part.runs_in_order = part.runs.len();
            }
        });
    }

    /// Puts the points of a body where they are next; the square of the farthest way that one goes (m²), not a number
    /// if one is lost.
    pub(crate) fn move_points(&mut self, place: usize) -> f64 {
        let Self { bodies, points, .. } = self;
        let range = bodies[place].part.points.clone();
        let (mut farthest, mut lost) = (0.0_f64, false);
        for (position, next) in points.position[range.clone()].iter_mut().zip(&points.next[range]) {
            let way = *next - *position;
            let squared = S::dot(way, way);
            lost |= squared.is_nan();
            farthest = farthest.max(squared);
            *position = *next;
        }
        if lost { f64::NAN } else { farthest }
    }

    /// The box around a body, of whose tracers the positions are given.
    pub(crate) fn find_bounds(&mut self, place: usize, tracers: &[S::Vector]) {
        let Self { bodies, points, .. } = self;
        let body = &mut bodies[place];
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let around = enclose::<S>(none, &points.position[body.part.points.clone()]);
        let bounds = enclose::<S>(around, &tracers[body.tracers.clone()]);
        body.bounds = bounds.map(|[x, y, z]| S::embed(S::restrict(Vector3::new(x, y, z))));
    }

    /// The boxes around all bodies.
    pub(crate) fn find_all_bounds(&mut self, tracers: &[S::Vector]) {
        (0..self.bodies.len()).for_each(|place| self.find_bounds(place, tracers));
    }

    /// Kinetic energy (J) of the points' velocities and of the affine part that they carry, ½ m tr(A D Aᵀ) with
    /// D = Σ w r rᵀ: what their momentum on the nodes has, but for the smoothing.
    pub(crate) fn kinetic_energy(&self, basis: Basis, lattice: &Lattice) -> f64 {
        let Self { points, bodies, .. } = self;
        let mut sum = 0.0;
        for body in bodies {
            with_basis!(basis, B => for at in body.part.points.clone() {
                let velocity = points.velocity[at];
                let affine = S::embed_gradient(points.affine_of(at));
                let mut squared = S::dot(velocity, velocity);
                if affine.norm_squared() > 0.0 {
                    let extent = body.part.extent::<S, B>(points.deformation[at]);
                    let stencil = Stencil::new::<S, B>(lattice, points.position[at], extent);
                    for axis in 0..S::DIMENSION {
                        squared += affine.column(axis).norm_squared() * stencil.spread(axis);
                    }
                }
                sum += 0.5 * points.mass[at] * squared;
            });
        }
        sum
    }

    /// A point of a body that broke.
    pub(crate) fn failure(&self, place: usize, point: usize, cause: Cause) -> Failure {
        Failure { owner: self.bodies[place].owner, position: S::embed(self.points.position[point]), cause }
    }

    /// Which point went too far in a step (s), of those that may go a `cell` (m).
    pub(crate) fn ran_away(&self, time_step: f64, cell: f64) -> Failure {
        let points = &self.points;
        let all = |body: &Body| -> Range<usize> { body.part.points.clone() };
        for (place, body) in self.bodies.iter().enumerate() {
            for at in all(body) {
                if !S::dot(points.position[at], points.position[at]).is_finite() {
                    return self.failure(place, at, Cause::NotFinite);
                }
            }
        }
        let mut worst = (0, 0, 0.0);
        for (place, body) in self.bodies.iter().enumerate() {
            for at in all(body) {
                let velocity = S::dot(points.velocity[at], points.velocity[at]).sqrt();
                if velocity > worst.2 {
                    worst = (place, at, velocity);
                }
            }
        }
        self.failure(worst.0, worst.1, Cause::LeftCell { moved: worst.2 * time_step, cell })
    }
}

/// The box around positions and another box.
fn enclose<S: Space>([mut low, mut high]: [[f64; 3]; 2], positions: &[S::Vector]) -> [[f64; 3]; 2] {
    for &position in positions {
        for axis in 0..S::DIMENSION {
            let at = S::component(position, axis);
            low[axis] = if at < low[axis] { at } else { low[axis] };
            high[axis] = if at > high[axis] { at } else { high[axis] };
        }
    }
    [low, high]
}
