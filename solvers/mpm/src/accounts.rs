//! Where energy comes from and goes, added up from step to step for runs that ask for it.
//!
//! - work: impulses of driven grains and walls, times their velocities;
//! - plastic: ∫ q dε_p V over points; friction: mean force of the spring times what its end slid, or the impulse along the
//!   surface times the slip at nodes before the step;
//! - contact: what contacts take from the motion, and neither store in springs nor lose to friction. Springs take from two
//!   surfaces their force times the way that these go against each other, contact by contact for the velocities before the step;
//!   for those after it by their forces on the nodes, which is the same: a surface follows its nodes with the weights by which a
//!   force on it reaches them. Conditions at nodes take their impulses times the velocity of the nodes. Surfaces follow the mean of
//!   the velocities that points bring to the nodes before and after the step. (The velocity that a force gives to a node beside a
//!   surface, which may have hardly any mass, is felt by nothing.)
//! - transfer: the kinetic energy that nodes gain in a step and points do not when they take it over; less the work that impulses do
//!   on that part of the nodes' velocity which points do not bring back, and which neither stresses nor surfaces follow (points that
//!   keep their own velocity and bring it back lose nothing in sum: the two are equal); and half of what stresses take from the
//!   velocities that they follow, less what the same stresses take from the nodes once points have moved on, across cells.
//!
//! No entry is what the others leave. That they add up to the work of what drives grains is a test of it all: that impulses are
//! equal and opposite, that forces on nodes take from the motion what stresses take in points, and that stress, plastic work and
//! elastic energy go together. (Where stresses come first, what crossing cells takes is left out.) Energy is counted in whole steps: kinetic energy belongs to the
//! velocities of points, half a step before their positions, and springs are those of the last forces.

use crate::damping::Damping;
use crate::grid::Node;
use crate::off::Off;
use crate::options::{Contact, StressUpdate};
use crate::simulation::{Simulation, with_basis};
use grainbench_scene::body::Hold;
use grainbench_scene::budget::Budget;
use grainbench_scene::scene::Scene;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// What contacts tell of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Energy in springs (J).
    pub(crate) springs: f64,
    /// Work of friction (J).
    pub(crate) friction: f64,
    /// Work of walls (J).
    pub(crate) walls: f64,
    /// What springs take from the motion of surfaces, by half of their velocities before the step and all of the walls' (J).
    pub(crate) taken: f64,
}

/// Where contacts tell what they do to energy: the budget of a run that asks for it, or its absence.
pub(crate) trait Ledger {
    /// What they tell of the step, if anybody asks.
    fn tally(&mut self) -> Option<&mut Tally>;
}

impl Ledger for Off {
    #[inline(always)]
    fn tally(&mut self) -> Option<&mut Tally> {
        None
    }
}

impl Ledger for &mut Tally {
    #[inline(always)]
    fn tally(&mut self) -> Option<&mut Tally> {
        Some(self)
    }
}

/// What stresses tell of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// Σ V σ:Δε of the stresses after the step (J).
    pub(crate) taken: f64,
    /// Work of plastic flow (J).
    pub(crate) plastic: f64,
}

/// Sums since the start (J, N s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sums {
    /// Kinetic energy of points at the start.
    kinetic_at_start: f64,
    /// Work of gravity on nodes.
    gravity: f64,
    /// What springs take from the motion of surfaces.
    taken: f64,
    /// Work of conditions at nodes and of what drives grains, on the velocities that surfaces follow.
    contacts: f64,
    /// Kinetic energy that nodes gain in their steps.
    stepped: f64,
    /// Work of what drives grains, on points that share their nodes with others.
    carried: f64,
    /// Work on that part of the nodes' velocity which points do not bring back.
    stray: f64,
    /// What stresses took in the last step (J), of which nodes are told in the next.
    stressed: f64,
    /// What they take less than that from nodes when points have moved on.
    crossed: f64,
    damping: f64,
    /// Of it, what damping takes from motion that nodes do not show.
    unseen: f64,
    plastic: f64,
    friction: f64,
    work: f64,
    impulse: Vector3<f64>,
}

/// Sums, and what a step leaves for them.
#[derive(Clone, Debug)]
pub(crate) struct Accounts<S: Space> {
    pub(crate) sums: Sums,
    /// Of the last step.
    pub(crate) tally: Tally,
    /// Internal forces on the nodes (N); then impulses of contacts and of what drives grains (N s).
    impulses: Vec<S::Vector>,
    /// Forces with those of springs (N); then impulses with those of internal forces (N s).
    forces: Vec<S::Vector>,
    /// Forces of springs on the nodes (N).
    springs: Vec<S::Vector>,
    /// Work of what drives grains on nodes in this step (J).
    held: f64,
    /// Kinetic energy of points before the step, where motion is damped (J).
    brought: f64,
}

impl<S: Space> Default for Accounts<S> {
    fn default() -> Self {
        Self {
            sums: Sums::default(),
            tally: Tally::default(),
            impulses: Vec::new(),
            forces: Vec::new(),
            springs: Vec::new(),
            held: 0.0,
            brought: 0.0,
        }
    }
}

impl<S: Space> Accounts<S> {
    /// Memory that is in use (B).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.impulses) + size_of_val(&*self.forces) + size_of_val(&*self.springs)
    }
}

/// Velocity of a node before the step.
fn before<S: Space>(node: &Node<S>, keep: f64) -> S::Vector {
    (node.velocity - node.change) * (1.0 / keep)
}

/// Why the budget of a scene cannot be told, if it cannot.
pub(crate) fn reason(scene: &Scene) -> Option<String> {
    let held = scene.bodies.iter().any(|body| body.sides.iter().flatten().any(|&side| side != Hold::Free));
    let what = if held {
        "held sides of bodies"
    } else if scene.start.manufactured.is_some() {
        "a manufactured body force"
    } else {
        return None;
    };
    Some(format!("a probe asks for its energy budget, and what {what} gives is not added up"))
}

impl<S: Space> Simulation<S> {
    /// Before springs push: the forces on the nodes are internal.
    pub(crate) fn note_internal_forces(&mut self) {
        if let Some(accounts) = &mut self.accounts {
            accounts.impulses.clear();
            accounts.impulses.extend(self.nodes[..self.used].iter().map(|node| node.change));
        }
    }

    /// Before velocities change.
    pub(crate) fn note_forces(&mut self) {
        let Some(accounts) = &mut self.accounts else { return };
        let Accounts { forces, springs, impulses, .. } = accounts;
        let nodes = &self.nodes[..self.used];
        forces.clear();
        forces.extend(nodes.iter().map(|node| node.change));
        springs.clear();
        springs.extend(nodes.iter().zip(impulses).map(|(node, internal)| node.change - *internal));
        if self.damping > 0.0 {
            let brought = self.kinetic_energy();
            self.accounts.iter_mut().for_each(|accounts| accounts.brought = brought);
        }
    }

    /// Work of driven grains in this step so far (J).
    fn work_of_driven(&self) -> f64 {
        let work = self.driven.groups.iter().map(|group| -S::dot(group.force, group.velocity));
        work.sum::<f64>() * self.time_step
    }

    /// Before points of driven bodies are carried along.
    pub(crate) fn note_driven(&mut self) {
        let held = self.work_of_driven();
        self.accounts.iter_mut().for_each(|accounts| accounts.held = held);
    }

    /// After velocities have changed.
    pub(crate) fn account_for_nodes(&mut self) {
        let driven_work = self.work_of_driven();
        let Self { nodes, accounts, setting, gravity, time_step, damping, driven, walls, used, .. } = self;
        let Some(accounts) = accounts else { return };
        let Accounts { sums, tally, impulses, forces, held, brought, .. } = accounts;
        let Damping { keep, gain } = Damping::over(*damping, *time_step);
        let (mut mass, mut given, mut seen) = (0.0, 0.0, 0.0);
        for ((node, force), impulse) in nodes[..*used].iter().zip(forces.iter_mut()).zip(impulses) {
            if node.mass <= 0.0 {
                (*impulse, *force) = (S::ORIGIN, S::ORIGIN);
                continue;
            }
            mass += node.mass;
            let before = before(node, keep);
            let mean = (before + node.velocity) * 0.5;
            let pull = *gravity * node.mass;
            given += S::dot(*impulse, before) * *time_step;
            let dragged = before * (keep - 1.0) + (*force * (1.0 / node.mass) + *gravity) * (gain - *time_step);
            let drag = dragged * node.mass;
            // All that changed the momentum, but gravity and drag; and without internal forces.
            *force = (node.velocity - before) * node.mass - pull * *time_step - drag;
            *impulse = *force - *impulse * *time_step;
            seen += 0.5 * node.mass * S::dot(before, before);
            sums.stepped += 0.5 * node.mass * (S::dot(node.velocity, node.velocity) - S::dot(before, before));
            sums.gravity += S::dot(pull, mean) * *time_step;
            sums.damping -= S::dot(drag, mean);
        }
        if setting.stress_update != StressUpdate::First {
            sums.crossed += 0.5 * (sums.stressed + given);
        }
        if *damping > 0.0 {
            sums.unseen += (1.0 - keep * keep) * (*brought - seen);
        }
        sums.impulse += S::embed(*gravity) * (mass * *time_step);
        for group in &driven.groups {
            sums.impulse -= S::embed(group.force) * *time_step;
        }
        sums.work += driven_work;
        sums.carried += driven_work - *held;
        for wall in walls.iter() {
            sums.impulse -= S::embed(wall.force) * *time_step;
        }
        sums.work += tally.walls;
        sums.friction += tally.friction;
        sums.taken += tally.taken;
    }

    /// After points have brought their new velocities to the nodes, where they do.
    pub(crate) fn account_for_contacts(&mut self) {
        let is_projected = self.setting.stress_update == StressUpdate::ModifiedLast;
        let Self { nodes, projected, accounts, time_step, damping, .. } = self;
        let Some(accounts) = accounts else { return };
        let Accounts { sums, impulses, forces, springs, .. } = accounts;
        let Damping { keep, .. } = Damping::over(*damping, *time_step);
        let after = |slot: usize| if is_projected { projected[slot] } else { nodes[slot].velocity };
        for (slot, ((impulse, all), spring)) in impulses.iter().zip(forces.iter()).zip(springs.iter()).enumerate() {
            let (node, after) = (&nodes[slot], after(slot));
            sums.contacts += S::dot(*impulse, (before(node, keep) + after) * 0.5);
            sums.stray += 0.5 * S::dot(*all, node.velocity - after);
            sums.taken -= 0.5 * S::dot(*spring, after) * *time_step;
        }
    }

    /// After stresses have changed.
    pub(crate) fn account_for_flow(&mut self, flow: Flow) {
        if let Some(Accounts { sums, .. }) = &mut self.accounts {
            sums.stressed = flow.taken;
            sums.plastic += flow.plastic;
        }
    }

    /// Begins to add up, with the points as they are, where the budget is asked for.
    pub(crate) fn open_accounts(&mut self) {
        self.accounts = self.scene.asks_for_budget().then(|| {
            let sums = Sums { kinetic_at_start: self.kinetic_energy(), ..Sums::default() };
            Accounts { sums, ..Accounts::default() }
        });
    }

    /// Kinetic energy (J) of the points' velocities and of the affine part that they carry, ½ m tr(A D Aᵀ) with
    /// D = Σ w r rᵀ: what their momentum on the nodes has, but for the smoothing.
    fn kinetic_energy(&self) -> f64 {
        let Self { lattice, points, bodies, setting, .. } = self;
        let mut sum = 0.0;
        for body in bodies {
            with_basis!(setting.basis, B => for at in body.part.points.clone() {
                let velocity = points.velocity[at];
                let affine = S::embed_gradient(points.affine_of(at));
                let mut squared = S::dot(velocity, velocity);
                if affine.norm_squared() > 0.0 {
                    let extent = body.part.extent::<S, B>(points.deformation[at]);
                    let stencil = crate::grid::Stencil::new::<S, B>(lattice, points.position[at], extent);
                    for axis in 0..S::DIMENSION {
                        squared += affine.column(axis).norm_squared() * stencil.spread(axis);
                    }
                }
                sum += 0.5 * points.mass[at] * squared;
            });
        }
        sum
    }

    /// The budget, with the elastic energy of the material (J), where it is asked for.
    pub(crate) fn budget(&self, elastic: f64) -> Option<Budget> {
        let Accounts { sums, tally, .. } = self.accounts.as_ref()?;
        let kinetic = self.kinetic_energy();
        let points = &self.points;
        let all = 0..points.len();
        let height = |at: usize| -points.mass[at] * self.scene.gravity.dot(&S::embed(points.position[at]));
        Some(Budget {
            kinetic,
            elastic,
            springs: tally.springs,
            gravitational: all.clone().map(height).sum(),
            work: sums.work,
            plastic: sums.plastic,
            friction: sums.friction,
            damping: sums.damping + sums.unseen,
            transfer: sums.stepped + sums.carried
                - (kinetic - sums.kinetic_at_start)
                - sums.unseen
                - sums.stray
                - sums.crossed,
            contact: match self.setting.contact {
                Contact::Penalty => sums.taken - tally.springs - sums.friction,
                _ => sums.work - sums.carried - sums.contacts - sums.friction,
            },
            momentum: all.map(|at| S::embed(points.velocity[at]) * points.mass[at]).sum(),
            impulse: sums.impulse,
        })
    }
}
