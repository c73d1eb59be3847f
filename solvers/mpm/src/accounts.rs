//! Where energy comes from and goes, added up from step to step for runs that ask for it.
//!
//! - work: impulses of driven grains and walls, times their velocities;
//! - plastic: ∫ q dε_p V over points; friction: mean force of the spring times what its end slid, or the impulse along the
//!   surface times the slip at nodes before the step;
//! - contact: what contacts take from the motion, and neither store in springs nor lose to friction. They take their impulses on
//!   nodes times the velocity that carries surfaces, the mean of those that points bring to the nodes before and after the
//!   step. (The velocity that a force gives to a node beside a surface, which may have hardly any mass, is felt by nothing.)
//! - transfer: what stresses (Σ V σ:Δε, on the velocities that they follow), contacts, gravity and damping do on the motion,
//!   and points do not gain in kinetic energy: lumped masses, smoothing, and stresses that follow other velocities.
//!
//! What is left over all is how well stress, plastic work and elastic energy go together. Energy is counted in whole steps:
//! kinetic energy belongs to the velocities of points, half a step before their positions, and springs are those of the last
//! forces.

use crate::options::StressUpdate;
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
}

/// What stresses tell of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// Σ V σ:Δε (J).
    pub(crate) power: f64,
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
    /// Work of contacts and of what drives grains.
    contacts: f64,
    damping: f64,
    power: f64,
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
    /// Forces with those of springs (N).
    forces: Vec<S::Vector>,
}

impl<S: Space> Default for Accounts<S> {
    fn default() -> Self {
        Self { sums: Sums::default(), tally: Tally::default(), impulses: Vec::new(), forces: Vec::new() }
    }
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
        if self.accounting {
            self.accounts.impulses.clear();
            self.accounts.impulses.extend(self.nodes[..self.used].iter().map(|node| node.change));
        }
    }

    /// Before velocities change.
    pub(crate) fn note_forces(&mut self) {
        if self.accounting {
            self.accounts.forces.clear();
            self.accounts.forces.extend(self.nodes[..self.used].iter().map(|node| node.change));
        }
    }

    /// After velocities have changed.
    pub(crate) fn account_for_nodes(&mut self) {
        if !self.accounting {
            return;
        }
        let Self { nodes, accounts, gravity, time_step, damping, driven, walls, used, .. } = self;
        let Accounts { sums, tally, impulses, forces } = accounts;
        let half = 0.5 * *damping * *time_step;
        let (keep, gain) = ((1.0 - half) / (1.0 + half), *time_step / (1.0 + half));
        let mut mass = 0.0;
        for ((node, force), impulse) in nodes[..*used].iter().zip(forces.iter()).zip(impulses) {
            if node.mass <= 0.0 {
                *impulse = S::ORIGIN;
                continue;
            }
            mass += node.mass;
            let before = node.velocity - node.change;
            let mean = before + node.change * 0.5;
            let pull = *gravity * node.mass;
            let dragged = before * (keep - 1.0) + (*force * (1.0 / node.mass) + *gravity) * (gain - *time_step);
            let drag = dragged * node.mass;
            // All that changed the momentum, but internal forces, gravity and drag.
            *impulse = node.change * node.mass - (*impulse + pull) * *time_step - drag;
            sums.gravity += S::dot(pull, mean) * *time_step;
            sums.damping -= S::dot(drag, mean);
        }
        sums.impulse += S::embed(*gravity) * (mass * *time_step);
        for group in &driven.groups {
            let impulse = -S::embed(group.force) * *time_step;
            sums.impulse += impulse;
            sums.work += impulse.dot(&S::embed(group.velocity));
        }
        for wall in walls.iter() {
            sums.impulse -= S::embed(wall.force) * *time_step;
        }
        sums.work += tally.walls;
        sums.friction += tally.friction;
    }

    /// After points have brought their new velocities to the nodes, where they do.
    pub(crate) fn account_for_contacts(&mut self) {
        if !self.accounting {
            return;
        }
        let is_projected = self.setting.stress_update == StressUpdate::ModifiedLast;
        let Accounts { sums, impulses, .. } = &mut self.accounts;
        for ((node, after), impulse) in self.nodes.iter().zip(&self.projected).zip(impulses.iter()) {
            let carrying = if is_projected { *after } else { node.velocity };
            sums.contacts += S::dot(*impulse, (node.velocity - node.change + carrying) * 0.5);
        }
    }

    /// After stresses have changed.
    pub(crate) fn account_for_flow(&mut self, flow: Flow) {
        self.accounts.sums.power += flow.power;
        self.accounts.sums.plastic += flow.plastic;
    }

    /// Begins to add up, with the points as they are.
    pub(crate) fn open_accounts(&mut self) {
        self.accounting = self.scene.asks_for_budget();
        self.accounts = Accounts::default();
        if self.accounting {
            self.accounts.sums.kinetic_at_start = self.kinetic_energy();
        }
    }

    /// Kinetic energy (J) of the points' velocities and of the affine part that they carry, ½ m tr(A D Aᵀ) with
    /// D = Σ w r rᵀ: what their momentum on the nodes has, but for the smoothing.
    fn kinetic_energy(&self) -> f64 {
        let Self { lattice, points, bodies, setting, .. } = self;
        let mut sum = 0.0;
        for body in bodies {
            with_basis!(setting.basis, B => for at in body.part.points.clone() {
                let velocity = points.velocity[at];
                let affine = S::embed_gradient(points.affine[at]);
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

    /// The budget, with the elastic energy of the material (J).
    pub(crate) fn budget(&self, elastic: f64) -> Budget {
        let Accounts { sums, tally, .. } = &self.accounts;
        let kinetic = self.kinetic_energy();
        let points = &self.points;
        let all = 0..points.len();
        let height = |at: usize| -points.mass[at] * self.scene.gravity.dot(&S::embed(points.position[at]));
        Budget {
            kinetic,
            elastic,
            springs: tally.springs,
            gravitational: all.clone().map(height).sum(),
            work: sums.work,
            plastic: sums.plastic,
            friction: sums.friction,
            damping: sums.damping,
            transfer: sums.contacts + sums.gravity - sums.damping - sums.power - (kinetic - sums.kinetic_at_start),
            contact: sums.work - sums.contacts - tally.springs - sums.friction,
            momentum: all.map(|at| S::embed(points.velocity[at]) * points.mass[at]).sum(),
            impulse: sums.impulse,
        }
    }
}
