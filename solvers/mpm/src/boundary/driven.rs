//! Grains with prescribed motion. Like walls, they set the velocity of every node that their points influence.
//!
//! If each body has its own velocity field, these nodes belong only to the driven body. If all bodies share one field,
//! these nodes also move the points of other bodies that they influence.

use crate::grid::basis::with_basis;
use crate::grid::lattice::{Lattice, Node};
use crate::options::Basis;
use crate::points::arrays::Points;
use crate::points::body::Body;
use crate::scheme::Surroundings;
use grainbench_scene::scene::{Driven as DrivenGrains, Scene};
use grainbench_solver::space::Space;

/// Group of driven bodies with a common motion.
#[derive(Clone, Debug)]
pub(crate) struct Group<S: Space> {
    /// Current velocity (m/s); zero during relaxation.
    pub(crate) velocity: S::Vector,
    wanted: DrivenGrains,
    /// Sum of the forces on the group in the last step (N): contact forces of other bodies, and `own`.
    pub(crate) force: S::Vector,
    /// Part of `force` without contacts (N): M (v' − V)/Δt, with the mass M of the group, its prescribed velocity V, and
    /// the velocity v' that it would have after the step without contacts. It contains weight, inertia and global damping.
    own: S::Vector,
}

impl<S: Space> Group<S> {
    /// Returns the contact force of other bodies on the group in the last step (N).
    pub(crate) fn contact_force(&self) -> S::Vector {
        self.force - self.own
    }
}

/// All groups, and the nodes with the velocity of a group.
#[derive(Clone, Debug)]
pub(crate) struct DrivenGroups<S: Space> {
    pub(crate) groups: Vec<Group<S>>,
    /// Slots of nodes with prescribed velocity and index of their group, recomputed in each step.
    held: Vec<(usize, u16)>,
}

impl<S: Space> DrivenGroups<S> {
    pub(crate) fn new(scene: &Scene) -> Self {
        let groups = scene.driven.iter().map(|driven| Group {
            velocity: S::ORIGIN,
            wanted: driven.clone(),
            force: S::ORIGIN,
            own: S::ORIGIN,
        });
        Self { groups: groups.collect(), held: Vec::new() }
    }

    /// Sets the group velocities for a step at `time` (s). During relaxation they are zero.
    pub(crate) fn begin(&mut self, settling: bool, time: f64, time_step: f64) {
        for group in &mut self.groups {
            let wanted = || S::restrict(group.wanted.velocity_over(time, time_step));
            group.velocity = if settling { S::ORIGIN } else { wanted() };
            (group.force, group.own) = (S::ORIGIN, S::ORIGIN);
        }
    }

    /// Adds weight, inertia and global damping of the groups in a step of length `time_step` (s).
    pub(crate) fn note_own_forces(
        &mut self,
        bodies: &[Body],
        points: &Points<S>,
        &Surroundings { gravity, keep, gain }: &Surroundings<S>,
        time_step: f64,
    ) {
        for body in bodies {
            let Some(group) = body.driven else { continue };
            let group = &mut self.groups[usize::from(group)];
            for at in body.points.clone() {
                let free = points.velocity[at] * keep + gravity * gain;
                group.own += (free - group.velocity) * (points.mass[at] / time_step);
            }
        }
    }

    /// Finds the nodes with prescribed velocity. If all bodies share one velocity field, these are the nodes that points of
    /// driven bodies influence. If each body has its own field, they are all nodes of the driven bodies' fields.
    pub(crate) fn find_held(
        &mut self,
        lattice: &Lattice,
        bodies: &[Body],
        points: &Points<S>,
        basis: Basis,
        one_field: bool,
    ) {
        self.held.clear();
        for body in bodies {
            let Some(group) = body.driven else { continue };
            let window = &body.window;
            if one_field {
                with_basis!(basis, B => body.each_stencil::<S, B>(lattice, points, |_, stencil| {
                    stencil.each::<S, B>(window, |node| self.held.push((node.slot, group)));
                }));
            } else {
                self.held.extend((window.start..window.start + window.len()).map(|slot| (slot, group)));
            }
        }
        if one_field {
            self.held.sort_unstable();
            self.held.dedup_by_key(|(slot, _)| *slot);
        }
    }

    /// Sets the velocities of these nodes and adds the reactions to the groups as forces over the step.
    pub(crate) fn hold(&mut self, nodes: &mut [Node<S>], time_step: f64) {
        for &(slot, group) in &self.held {
            let (node, group) = (&mut nodes[slot], &mut self.groups[usize::from(group)]);
            if node.mass > 0.0 {
                group.force += (node.velocity - group.velocity) * (node.mass / time_step);
                node.velocity = group.velocity;
            }
        }
    }

    /// Sets the projected velocities of nodes with prescribed velocity.
    pub(crate) fn hold_projected(&self, projected: &mut [S::Vector], nodes: &[Node<S>]) {
        for &(slot, group) in &self.held {
            if nodes[slot].mass > 0.0 {
                projected[slot] = self.groups[usize::from(group)].velocity;
            }
        }
    }

    /// Sets the velocity of all points of driven bodies. At shared nodes, these points had received a part of the
    /// motion of other bodies.
    pub(crate) fn carry(&mut self, bodies: &[Body], points: &mut Points<S>, time_step: f64) {
        for body in bodies {
            let Some(group) = body.driven else { continue };
            let group = &mut self.groups[usize::from(group)];
            for at in body.points.clone() {
                group.force += (points.velocity[at] - group.velocity) * (points.mass[at] / time_step);
                points.velocity[at] = group.velocity;
            }
            if !points.affine.is_empty() {
                points.affine[body.points.clone()].fill(S::NO_GRADIENT);
            }
        }
    }
}
