//! Grains with prescribed motion. Like walls, they set the velocity of every node that their points influence.
//!
//! If each body has its own field, these are the nodes of the body. If all bodies share one field, other bodies at
//! these nodes are carried along.

use crate::basis::with_basis;
use crate::bodies::Body;
use crate::grid::{Lattice, Node, Stencil};
use crate::options::Basis;
use crate::points::Points;
use grainbench_scene::scene::{Driven as DrivenGrains, Scene};
use grainbench_scene::space::Space;

/// A group of driven bodies.
#[derive(Clone, Debug)]
pub(crate) struct Group<S: Space> {
    /// Current velocity (m/s); zero during relaxation.
    pub(crate) velocity: S::Vector,
    wanted: DrivenGrains,
    /// Force of other bodies on the group in the last step (N).
    pub(crate) force: S::Vector,
}

/// All groups, and the nodes that they hold.
#[derive(Clone, Debug)]
pub(crate) struct DrivenGroups<S: Space> {
    pub(crate) groups: Vec<Group<S>>,
    /// Held node slots with their group; recomputed in each step.
    held: Vec<(usize, u16)>,
}

impl<S: Space> DrivenGroups<S> {
    pub(crate) fn new(scene: &Scene) -> Self {
        let groups =
            scene.driven.iter().map(|driven| Group { velocity: S::ORIGIN, wanted: driven.clone(), force: S::ORIGIN });
        Self { groups: groups.collect(), held: Vec::new() }
    }

    /// Starts a step at a time (s). Groups move except during relaxation.
    pub(crate) fn begin(&mut self, settling: bool, time: f64, time_step: f64) {
        for group in &mut self.groups {
            let wanted = || S::restrict(group.wanted.velocity_over(time, time_step));
            group.velocity = if settling { S::ORIGIN } else { wanted() };
            group.force = S::ORIGIN;
        }
    }

    /// Finds the held nodes. With one field for all bodies, these are the nodes that points of driven bodies influence.
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
            let window = &body.part.window;
            if one_field {
                with_basis!(basis, B => for at in body.part.points.clone() {
                    let extent = body.part.extent::<S, B>(points.deformation[at]);
                    let stencil = Stencil::new::<S, B>(lattice, points.position[at], extent);
                    stencil.each::<S, B>(window, |node| self.held.push((node.slot, group)));
                });
            } else {
                self.held.extend((window.start..window.start + window.len()).map(|slot| (slot, group)));
            }
        }
        if one_field {
            self.held.sort_unstable();
            self.held.dedup_by_key(|(slot, _)| *slot);
        }
    }

    /// Sets the velocities of held nodes and adds the reactions to the groups as forces over the step.
    pub(crate) fn hold(&mut self, nodes: &mut [Node<S>], time_step: f64) {
        for &(slot, group) in &self.held {
            let (node, group) = (&mut nodes[slot], &mut self.groups[usize::from(group)]);
            if node.mass > 0.0 {
                group.force += (node.velocity - group.velocity) * (node.mass / time_step);
                node.velocity = group.velocity;
            }
        }
    }

    /// Sets the projected velocities of held nodes.
    pub(crate) fn hold_projected(&self, projected: &mut [S::Vector], nodes: &[Node<S>]) {
        for &(slot, group) in &self.held {
            if nodes[slot].mass > 0.0 {
                projected[slot] = self.groups[usize::from(group)].velocity;
            }
        }
    }

    /// Sets the velocity of all points of driven bodies. At shared nodes, the points had received a part of the motion
    /// of other bodies.
    pub(crate) fn carry(&mut self, bodies: &[Body], points: &mut Points<S>, time_step: f64) {
        for body in bodies {
            let Some(group) = body.driven else { continue };
            let group = &mut self.groups[usize::from(group)];
            for at in body.part.points.clone() {
                group.force += (points.velocity[at] - group.velocity) * (points.mass[at] / time_step);
                points.velocity[at] = group.velocity;
            }
            if !points.affine.is_empty() {
                points.affine[body.part.points.clone()].fill(S::NO_GRADIENT);
            }
        }
    }
}
