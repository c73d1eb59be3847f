//! Energy budget: sources and sinks of energy, summed over all steps of runs that request it.
//!
//! - work: impulse times velocity of driven grains and walls;
//! - plastic: ∫ q dε_p V over points (q: equivalent stress, ε_p: equivalent plastic strain, V: volume);
//! - friction: for springs, the mean force of the tangential spring times the sliding displacement of the spring's end.
//!   For contact at nodes, the tangential impulse times the slip velocity before the step;
//! - contact: energy that contacts take from the motion and neither store in springs nor dissipate by friction. The
//!   energy that springs take is their force times the relative displacement of the two surfaces. This displacement is
//!   the mean of the velocities before and after the step, times Δt. The half with velocities before the step is summed
//!   over contacts, and the half with velocities after the step over spring forces on nodes. Sums over contacts and over
//!   nodes are equal, because surfaces follow nodes with the same weights that distribute surface forces to nodes. The
//!   energy that contact conditions at nodes take is their impulse times the velocity of the node. This velocity is the
//!   mean of the velocities that points transfer to the node before and after the step, because surfaces follow this
//!   mean. (A force may give a node of tiny mass beside a surface a large velocity, which no point or surface follows.)
//! - transfer: kinetic energy that nodes gain in a step and points do not receive, minus two terms. The first term is
//!   the work of impulses on the part of the node velocities that points do not transfer back to nodes. Neither
//!   stresses nor surfaces follow this part. (If points keep their own velocity, their total loss is zero, because the
//!   energy that they do not receive equals this work.) The second term is half the difference of two energies. The
//!   first energy is the work of the stresses with the velocities that they follow. The second is the energy that the
//!   same stresses take from the nodes after points have moved across cells.
//!
//! No entry is computed as a remainder. The entries therefore check the method if they add up to the work of driven
//! grains and walls. Impulses must be equal and opposite, internal forces must take from nodes the energy that stresses
//! take from points, and stress, plastic work and elastic energy must be consistent. (If the stress update comes first,
//! the loss at cell crossings is not included.) Energy is counted in whole steps. Kinetic energy belongs to the
//! velocities of points, half a step before their positions, and spring energy to the last forces.

use crate::boundary::Boundary;
use crate::boundary::driven::DrivenGroups;
use crate::energy::ledger::{Flow, Tally};
use crate::grid::lattice::{Lattice, Node};
use crate::grid::nodes::Grid;
use crate::options::{Basis, Contact, Setting};
use crate::points::state::State;
use crate::scheme::{Scheme, Surroundings};
use grainbench_lanes::Team;
use grainbench_scene::body::Hold;
use grainbench_scene::scene::Scene;
use grainbench_solver::budget::Budget;
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Sums since the start (J; N s for the impulse).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sums {
    /// Kinetic energy of points at the start.
    kinetic_at_start: f64,
    /// Work of gravity on nodes.
    gravity: f64,
    /// Energy that springs take from the motion of surfaces.
    taken: f64,
    /// Work of nodal contact conditions and of driven grains, on the velocities that surfaces follow.
    contacts: f64,
    /// Kinetic energy that nodes gain in all steps.
    stepped: f64,
    /// Work of driven grains on points at nodes that they share with other bodies.
    carried: f64,
    /// Work on the part of node velocities that points do not transfer back.
    stray: f64,
    /// Energy that stresses took in the last step (J). The nodes lose it in the next step.
    stressed: f64,
    /// Half the sum over steps of the difference between `stressed` and the energy that nodes lose after points have
    /// moved (J).
    crossed: f64,
    damping: f64,
    /// Work of damping on motion that nodes do not represent.
    unseen: f64,
    plastic: f64,
    viscous: f64,
    friction: f64,
    work: f64,
    impulse: Vector3<f64>,
}

/// Sums since the start, and intermediate values of the current step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Accounts<S: Space> {
    pub(crate) sums: Sums,
    /// Energies of contacts in the last step.
    pub(crate) tally: Tally,
    /// Internal forces on the nodes (N); later impulses of contacts and of driven grains (N s).
    impulses: Vec<S::Vector>,
    /// Forces including springs (N); later impulses including internal forces (N s).
    forces: Vec<S::Vector>,
    /// Forces of springs on the nodes (N).
    springs: Vec<S::Vector>,
    /// Work of driven grains on nodes in this step (J).
    pub(crate) held: f64,
    /// Kinetic energy of points before the step (J); only used with damping.
    pub(crate) brought: f64,
}

/// Returns the velocity of a node before the step, from its velocity after the step, its change in the step and the
/// factor `keep` of global damping.
fn before<S: Space>(node: &Node<S>, keep: f64) -> S::Vector {
    (node.velocity - node.change) * (1.0 / keep)
}

/// Returns the reason why the energy budget of a scene is not supported, or `None` if it is supported.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    let held = scene.bodies.iter().any(|body| body.sides.iter().flatten().any(|&side| side != Hold::Free));
    let what = if held {
        "fixed sides of bodies"
    } else if scene.start.manufactured.is_some() {
        "a manufactured body force"
    } else {
        return None;
    };
    Some(format!("a probe requests the energy budget, which does not include the energy from {what}"))
}

/// Returns the work (J) of driven grains in the current step of length `time_step` (s).
pub(crate) fn work_of<S: Space>(driven: &DrivenGroups<S>, time_step: f64) -> f64 {
    let work = driven.groups.iter().map(|group| -S::dot(group.force, group.velocity));
    work.sum::<f64>() * time_step
}

/// Number of nodes that are summed as one block. It is fixed, so that sums do not depend on the number of threads.
const BLOCK: usize = 4096;

/// Returns sums over a block of nodes in one step: mass (kg), work of internal forces on the velocities before the step
/// (J), kinetic energy before the step (J), gain of kinetic energy (J), work of gravity (J) and work of damping (J).
///
/// On entry, `forces` contains all forces on the nodes and `impulses` the internal forces (N). On return, `forces` contains
/// the impulses (N s) of all forces except gravity and damping, and `impulses` the same without internal forces.
fn node_sums<S: Space>(
    nodes: &[Node<S>],
    forces: &mut [S::Vector],
    impulses: &mut [S::Vector],
    &Surroundings { gravity, keep, gain }: &Surroundings<S>,
    time_step: f64,
) -> [f64; 6] {
    let [mut mass, mut given, mut seen, mut stepped, mut pulled, mut dragged] = [0.0; 6];
    for ((node, force), impulse) in nodes.iter().zip(forces).zip(impulses) {
        if node.mass <= 0.0 {
            (*impulse, *force) = (S::ORIGIN, S::ORIGIN);
            continue;
        }
        mass += node.mass;
        let before = before(node, keep);
        let mean = (before + node.velocity) * 0.5;
        let pull = gravity * node.mass;
        given += S::dot(*impulse, before) * time_step;
        let slowed = before * (keep - 1.0) + (*force * (1.0 / node.mass) + gravity) * (gain - time_step);
        let drag = slowed * node.mass;
        *force = (node.velocity - before) * node.mass - pull * time_step - drag;
        *impulse = *force - *impulse * time_step;
        seen += 0.5 * node.mass * S::dot(before, before);
        stepped += 0.5 * node.mass * (S::dot(node.velocity, node.velocity) - S::dot(before, before));
        pulled += S::dot(pull, mean) * time_step;
        dragged += S::dot(drag, mean);
    }
    [mass, given, seen, stepped, pulled, dragged]
}

/// Adds the sums of two blocks.
fn added<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|entry| a[entry] + b[entry])
}

impl<S: Space> Accounts<S> {
    /// Starts a budget with the current state of the points.
    pub(crate) fn open(basis: Basis, state: &State<S>, lattice: &Lattice) -> Self {
        let sums = Sums { kinetic_at_start: state.kinetic_energy(basis, lattice), ..Sums::default() };
        Self { sums, ..Self::default() }
    }

    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.impulses) + size_of_val(&*self.forces) + size_of_val(&*self.springs)
    }

    /// Records internal forces on the nodes. It must be called before spring forces are added.
    pub(crate) fn note_internal_forces(&mut self, team: &Team, grid: &Grid<S>) {
        let nodes = &grid.nodes[..grid.used];
        self.impulses.resize(nodes.len(), S::ORIGIN);
        team.each(self.impulses.chunks_mut(BLOCK).zip(nodes.chunks(BLOCK)), |_, (impulses, nodes)| {
            impulses.iter_mut().zip(nodes).for_each(|(impulse, node)| *impulse = node.change);
        });
    }

    /// Records all forces. It must be called before velocities change.
    pub(crate) fn note_forces(&mut self, team: &Team, grid: &Grid<S>) {
        let Self { forces, springs, impulses, .. } = self;
        let nodes = &grid.nodes[..grid.used];
        forces.resize(nodes.len(), S::ORIGIN);
        springs.resize(nodes.len(), S::ORIGIN);
        let blocks = forces.chunks_mut(BLOCK).zip(springs.chunks_mut(BLOCK)).zip(impulses.chunks(BLOCK));
        team.each(blocks.zip(nodes.chunks(BLOCK)), |_, (((forces, springs), impulses), nodes)| {
            let internal = impulses.iter().zip(nodes);
            for ((force, spring), (internal, node)) in forces.iter_mut().zip(springs).zip(internal) {
                (*force, *spring) = (node.change, node.change - *internal);
            }
        });
    }

    /// Adds the sums over nodes. It must be called after velocities have changed.
    pub(crate) fn add_nodes(
        &mut self,
        team: &Team,
        scheme: &Scheme,
        surroundings: &Surroundings<S>,
        grid: &Grid<S>,
        Boundary { walls, driven, .. }: &Boundary<S>,
    ) {
        let time_step = scheme.time_step;
        let driven_work = work_of(driven, time_step);
        let Self { sums, tally, impulses, forces, held, brought, .. } = self;
        let &Surroundings { gravity, keep, .. } = surroundings;
        let nodes = &grid.nodes[..grid.used];
        let blocks = forces.chunks_mut(BLOCK).zip(impulses.chunks_mut(BLOCK)).zip(nodes.chunks(BLOCK));
        let add = |_, ((forces, impulses), nodes)| node_sums(nodes, forces, impulses, surroundings, time_step);
        let [mass, given, seen, stepped, pulled, dragged] = team.fold(blocks, add, [0.0; 6], added);
        sums.stepped += stepped;
        sums.gravity += pulled;
        sums.damping -= dragged;
        if !scheme.has_stress_first() {
            sums.crossed += 0.5 * (sums.stressed + given);
        }
        if keep < 1.0 {
            sums.unseen += (1.0 - keep * keep) * (*brought - seen);
        }
        sums.impulse += S::embed(gravity) * (mass * time_step);
        for group in &driven.groups {
            sums.impulse -= S::embed(group.force) * time_step;
        }
        sums.work += driven_work;
        sums.carried += driven_work - *held;
        for wall in walls {
            sums.impulse -= S::embed(wall.force) * time_step;
        }
        sums.work += tally.walls;
        sums.friction += tally.friction;
        sums.taken += tally.taken;
    }

    /// Adds the sums over contacts. It must be called after points have transferred their new velocities to the nodes.
    pub(crate) fn add_contacts(&mut self, team: &Team, time_step: f64, keep: f64, grid: &Grid<S>) {
        let Grid { nodes, projected, .. } = grid;
        let Self { sums, impulses, forces, springs, .. } = self;
        let used = grid.used;
        let blocks = (0..used).step_by(BLOCK).map(|start| start..used.min(start + BLOCK));
        let add = |_, block: Range<usize>| {
            let mut sum = [0.0; 3];
            for slot in block {
                let node = &nodes[slot];
                let after = projected[slot];
                sum[0] += S::dot(impulses[slot], (before(node, keep) + after) * 0.5);
                sum[1] += 0.5 * S::dot(forces[slot], node.velocity - after);
                sum[2] -= 0.5 * S::dot(springs[slot], after) * time_step;
            }
            sum
        };
        let [contacts, stray, taken] = team.fold(blocks, add, [0.0; 3], added);
        sums.contacts += contacts;
        sums.stray += stray;
        sums.taken += taken;
    }

    /// Adds the plastic and the viscous work of a step, and stores the stress work Σ V σ:Δε of the step. It must be called
    /// after the stress update.
    pub(crate) fn add_flow(&mut self, flow: Flow) {
        self.sums.stressed = flow.taken;
        self.sums.plastic += flow.plastic;
        self.sums.viscous += flow.viscous;
    }

    /// Returns the budget of energy and momentum. The caller gives the elastic energy of the material (J) and gravity
    /// (m/s²).
    pub(crate) fn budget(
        &self,
        setting: &Setting,
        gravity: Vector3<f64>,
        state: &State<S>,
        lattice: &Lattice,
        elastic: f64,
    ) -> Budget {
        let Self { sums, tally, .. } = self;
        let kinetic = state.kinetic_energy(setting.basis, lattice);
        let points = &state.points;
        Budget {
            kinetic,
            elastic,
            springs: tally.springs,
            gravitational: points.gravitational_energy(gravity),
            work: sums.work,
            plastic: sums.plastic,
            friction: sums.friction,
            damping: sums.damping + sums.unseen + sums.viscous,
            transfer: sums.stepped + sums.carried
                - (kinetic - sums.kinetic_at_start)
                - sums.unseen
                - sums.stray
                - sums.crossed,
            contact: match setting.contact {
                Contact::Penalty => sums.taken - tally.springs - sums.friction,
                _ => sums.work - sums.carried - sums.contacts - sums.friction,
            },
            momentum: (0..points.len()).map(|at| S::embed(points.velocity[at]) * points.mass[at]).sum(),
            impulse: sums.impulse,
        }
    }
}
