//! State of a simulation: bodies and their material points.

use crate::failure::Failure;
use crate::grid::basis::with_basis;
use crate::grid::lattice::{Lattice, Stencil};
use crate::options::Basis;
use crate::points::arrays::Points;
use crate::points::body::{Body, extent};
use crate::points::runs::ParticleBatch;
use crate::points::share::{self, BodyBatches, LargestDisplacement, NO_BOX, ThreadPartition, enclose};
use crate::surface::tracers::Tracers;
use grainbench_lanes::Team;
use grainbench_solver::failure::Cause;
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// Inverse of the allowed relative growth in the number of batches. Beyond this growth, points are sorted again.
///
/// With a third more batches, a step costs little more. Sorting costs up to a tenth of a step.
const DISORDER: usize = 3;

/// Bodies of a simulation with their points, and the partition of the points among threads.
#[derive(Clone, Debug)]
pub(crate) struct State<S: Space> {
    pub(crate) bodies: Vec<Body>,
    pub(crate) points: Points<S>,
    /// Velocities of the points before the last observed step (m/s). Velocities are half a step behind positions, so an
    /// observation extrapolates from these and the current velocities.
    pub(crate) before: Vec<S::Vector>,
    /// Partition of the particle batches for each thread.
    pub(crate) shares: Vec<ThreadPartition<S>>,
    /// Threads of the run.
    pub(crate) team: Team,
}

impl<S: Space> State<S> {
    pub(crate) fn new(bodies: Vec<Body>, points: Points<S>, team: Team) -> Self {
        let shares = vec![ThreadPartition::new(); team.members()];
        Self { bodies, before: points.velocity.clone(), points, shares, team }
    }

    /// Replaces the threads of the run.
    #[cfg(test)]
    pub(crate) fn set_team(&mut self, team: Team) {
        (self.shares, self.team) = (vec![ThreadPartition::new(); team.members()], team);
    }

    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        let runs: usize = self.shares.iter().map(|share| size_of_val(&*share.runs) + size_of_val(&*share.before)).sum();
        self.points.bytes() + size_of_val(&*self.before) + runs + size_of_val(&*self.bodies)
    }

    /// Assigns points to thread partitions and finds the batches of the points. If a body has too many batches, its
    /// points are sorted by cell.
    pub(crate) fn find_runs(&mut self, basis: Basis, lattice: &Lattice) {
        with_basis!(basis, B => {
            self.share_points::<B>(lattice);
            let mut found = vec![0; self.bodies.len()];
            for piece in self.shares.iter().flat_map(|share| &share.pieces) {
                found[piece.body] += piece.runs.len();
            }
            let Self { bodies, points, team, .. } = self;
            let is_out_of_order = |&place: &usize| {
                let in_order = bodies[place].runs_in_order;
                found[place] > in_order + in_order / DISORDER
            };
            let out_of_order: Vec<usize> = (0..bodies.len()).filter(is_out_of_order).collect();
            if !out_of_order.is_empty() {
                let order = |_, &place: &usize| {
                    let body = &bodies[place];
                    vec![points.order(body.points.clone(), |at| body.window.slot(lattice.first::<S, B>(at)))]
                };
                let orders = team.fold(out_of_order.iter(), order, Vec::new(), |all, one| [all, one].concat());
                points.put_in(&orders, team);
                self.forget_runs(&out_of_order);
                self.share_points::<B>(lattice);
            }
            for &place in &out_of_order {
                let pieces = self.shares.iter().flat_map(|share| &share.pieces);
                let runs = pieces.filter(|piece| piece.body == place).map(|piece| piece.runs.len()).sum();
                self.bodies[place].runs_in_order = runs;
            }
        });
    }

    /// Marks the batches of these bodies as unknown.
    fn forget_runs(&mut self, places: &[usize]) {
        for ThreadPartition { pieces, runs, .. } in &mut self.shares {
            for piece in pieces.iter().filter(|piece| places.contains(&piece.body)) {
                runs[piece.runs.clone()].iter_mut().for_each(|run| run.is_known = false);
            }
        }
    }

    fn share_points<B: crate::grid::basis::Basis>(&mut self, lattice: &Lattice) {
        let Self { bodies, points, shares, team, .. } = self;
        share::cut_points::<S, B>(shares, lattice, bodies, points);
        team.each(shares.iter_mut(), |_, share| share.find_runs::<B>(lattice, bodies, points));
    }

    /// Iterates over the partitions, and in each over the bodies whose windows contain any of these nodes. Yields partition
    /// number, body and batches in order.
    pub(crate) fn reaching(&self, nodes: &Range<usize>) -> impl Iterator<Item = (usize, &Body, &[ParticleBatch])> {
        let Self { bodies, shares, .. } = self;
        let all = shares.iter().enumerate();
        let all = all.flat_map(|(number, share)| share.parts(bodies).map(move |(body, runs)| (number, body, runs)));
        all.filter(|(_, body, _)| {
            let slots = body.window.slots();
            slots.start < nodes.end && nodes.start < slots.end
        })
    }

    /// Moves the points to their next positions.
    pub(crate) fn move_points(&mut self, lattice: &Lattice, start: f64) -> LargestDisplacement {
        let Self { points, shares, team, .. } = self;
        let mut left = points.lent();
        let parts = shares.iter_mut().map(|share| (left.take_off(share.points.len()), share));
        let go = |_, (mut points, share): (_, &mut ThreadPartition<S>)| share.move_points(&mut points, lattice, start);
        team.fold(parts, go, LargestDisplacement::default(), LargestDisplacement::farther)
    }

    /// Computes the bounding boxes of all bodies from the boxes of thread partitions and tracer chunks.
    pub(crate) fn gather_bounds(&mut self, tracers: &Tracers<S>) {
        let Self { bodies, shares, .. } = self;
        let mut around = vec![NO_BOX; bodies.len()];
        for BodyBatches { body, bounds: [low, high], .. } in shares.iter().flat_map(|share| &share.pieces) {
            let around = &mut around[*body];
            for axis in 0..S::DIMENSION {
                around[0][axis] = around[0][axis].min(low[axis]);
                around[1][axis] = around[1][axis].max(high[axis]);
            }
        }
        for (body, around) in bodies.iter_mut().zip(around) {
            body.bounds = in_space::<S>(tracers.enclose_runs(body.chunks.clone(), around));
        }
    }

    /// Computes the bounding boxes of all bodies and tracer chunks from their positions.
    pub(crate) fn find_all_bounds(&mut self, tracers: &mut Tracers<S>) {
        tracers.find_boxes();
        for body in &mut self.bodies {
            let around = enclose::<S>(NO_BOX, &self.points.position[body.points.clone()]);
            body.bounds = in_space::<S>(tracers.enclose_runs(body.chunks.clone(), around));
        }
    }

    /// Returns the kinetic energy (J) of all points, Σ ½ m (v² + tr(A D Aᵀ)), with velocity v, affine part A and D = Σ
    /// w r rᵀ.
    ///
    /// This is the energy of the points' momentum on the nodes, without the smoothing.
    pub(crate) fn kinetic_energy(&self, basis: Basis, lattice: &Lattice) -> f64 {
        let Self { points, bodies, .. } = self;
        let mut sum = 0.0;
        for body in bodies {
            with_basis!(basis, B => for at in body.points.clone() {
                let velocity = points.velocity[at];
                let affine = S::embed_gradient(points.affine_of(at));
                let mut squared = S::dot(velocity, velocity);
                if affine.norm_squared() > 0.0 {
                    let extent = extent::<S, B>(body.half, points.deformation[at]);
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

    /// Returns the failure of a point of a body.
    pub(crate) fn failure(&self, place: usize, point: usize, cause: Cause) -> Failure {
        Failure { owner: self.bodies[place].owner, position: S::embed(self.points.position[point]), cause }
    }

    /// Returns the failure for a step (s) in which a point has moved more than a `cell` (m). It names the first point
    /// with a position that is not finite, otherwise the fastest point.
    pub(crate) fn ran_away(&self, time_step: f64, cell: f64) -> Failure {
        let points = &self.points;
        let all = |body: &Body| -> Range<usize> { body.points.clone() };
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

/// Converts a box to three dimensions. In two dimensions its extent along z is zero.
fn in_space<S: Space>(bounds: [[f64; 3]; 2]) -> [Vector3<f64>; 2] {
    bounds.map(|[x, y, z]| S::embed(S::restrict(Vector3::new(x, y, z))))
}
