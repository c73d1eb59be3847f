//! Nodes that are shared by several bodies, or by a body and a wall.

use super::ContactPartner;
use super::pairs::Pair;
use crate::boundary::walls::RigidPlane;
use crate::grid::basis::{Basis, Linear, Quadratic};
use crate::grid::lattice::{Lattice, Node, Stencil, Window};
use crate::points::arrays::Points;
use crate::points::body::Body;
use crate::surface::tracers::Tracers;
use grainbench_solver::space::Space;
use std::ops::Range;

/// Velocities of nodes.
pub(crate) enum Field<'a, S: Space> {
    /// Velocities after the step. `change` of the nodes contains the velocities before the step. Impulses count as forces
    /// on walls and driven bodies.
    Stepped(&'a mut [Node<S>]),
    /// Velocities projected from points. There are no separate velocities before the step, and impulses do not count.
    Projected(&'a mut [S::Vector]),
}

impl<S: Space> Field<'_, S> {
    /// Returns the velocity of a node.
    #[inline(always)]
    pub(crate) const fn velocity(&mut self, slot: usize) -> &mut S::Vector {
        match self {
            Self::Stepped(nodes) => &mut nodes[slot].velocity,
            Self::Projected(velocities) => &mut velocities[slot],
        }
    }

    /// Returns the velocity of a node before the step.
    #[inline(always)]
    pub(crate) const fn before(&self, slot: usize) -> S::Vector {
        match self {
            Self::Stepped(nodes) => nodes[slot].change,
            Self::Projected(velocities) => velocities[slot],
        }
    }
}

/// One body at a shared node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    key: u64,
    pub(crate) body: u32,
    pub(crate) slot: usize,
    pub(crate) mass: f64,
}

/// Surface of a body near a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face<S: Space> {
    /// Outward normal of any length.
    pub(crate) normal: S::Vector,
    /// Stress times volume, Σ w V σ (Pa m³), summed over points with weight w.
    pub(crate) stress: S::Matrix,
}

/// Contact of a body with another body or a wall at a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodalContact<S: Space> {
    pub(crate) key: u64,
    pub(crate) body: u32,
    pub(crate) other: ContactPartner,
    /// Position of the node (m).
    pub(crate) position: S::Vector,
    /// Slots of the node in the fields of the body and of its contact partner.
    pub(crate) slots: [usize; 2],
    pub(crate) masses: [f64; 2],
    /// Unit normal from the body to its contact partner.
    pub(crate) normal: S::Vector,
    /// Impulse on the contact partner so far (N s).
    pub(crate) impulse: S::Vector,
}

/// Shared node with the bodies that share it.
#[derive(Clone, Debug)]
pub(crate) struct Group<S: Space> {
    pub(crate) members: Range<usize>,
    /// Index of the wall that contains the node, if any.
    pub(crate) wall: Option<usize>,
    pub(crate) position: S::Vector,
}

/// All shared nodes of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct SharedNodes<S: Space> {
    pub(crate) members: Vec<Member>,
    pub(crate) groups: Vec<Group<S>>,
    pub(crate) faces: Vec<Face<S>>,
    pub(crate) meetings: Vec<NodalContact<S>>,
    densities: Vec<f64>,
    /// For each body, true if the body shares a node.
    touching: Vec<bool>,
}

/// Returns a number that identifies a node of the lattice.
fn key(node: [i32; 3]) -> u64 {
    const BIAS: i64 = 1 << 20;
    let part = |axis: usize| (i64::from(node[axis]) + BIAS) as u64 & 0x1f_ffff;
    part(2) << 42 | part(1) << 21 | part(0)
}

impl<S: Space> SharedNodes<S> {
    /// Returns the memory in use (bytes).
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.members)
            + size_of_val(&*self.groups)
            + size_of_val(&*self.faces)
            + size_of_val(&*self.meetings)
            + size_of_val(&*self.densities)
            + size_of_val(&*self.touching)
    }

    /// Finds the nodes that bodies share with each other or with a wall.
    pub(crate) fn find(
        &mut self,
        lattice: &Lattice,
        bodies: &[Body],
        fields: usize,
        pairs: &[Pair<S>],
        walls: &[RigidPlane<S>],
        nodes: &[Node<S>],
    ) {
        self.members.clear();
        let behind = |position: S::Vector| {
            walls.iter().position(|wall| wall.height(position) <= 1e-9 * lattice.shortest(S::DIMENSION))
        };
        if !walls.is_empty() {
            for (place, body) in bodies.iter().enumerate().take(fields) {
                let window = &body.window;
                for at in 0..window.len() {
                    let (slot, node) = (window.start + at, window.node(at));
                    if nodes[slot].mass > 0.0 && behind(lattice.place::<S>(node)).is_some() {
                        self.add(lattice, place, node, slot, nodes);
                    }
                }
            }
        }
        for pair in pairs {
            let [one, two] = [pair.first, pair.second].map(|body| bodies[body as usize].window);
            let periods = [0, 1, 2].map(|axis| {
                let shift = if axis < S::DIMENSION { S::component(pair.shift, axis) } else { 0.0 };
                (shift / lattice.cell[axis]).round() as i32
            });
            each_common(&one, &two, periods, |node, other, first, second| {
                if nodes[first].mass > 0.0 && nodes[second].mass > 0.0 {
                    self.add(lattice, pair.first as usize, node, first, nodes);
                    self.add(lattice, pair.second as usize, other, second, nodes);
                }
            });
        }
        self.members.sort_unstable_by_key(|member| (member.key, member.body));
        self.members.dedup_by_key(|member| (member.key, member.body));
        self.groups.clear();
        let mut start = 0;
        for group in self.members.chunk_by(|a, b| a.key == b.key) {
            let first = &group[0];
            let window = &bodies[first.body as usize].window;
            let position = lattice.place::<S>(window.node(first.slot - window.start));
            self.groups.push(Group { members: start..start + group.len(), wall: behind(position), position });
            start += group.len();
        }
    }

    fn add(&mut self, lattice: &Lattice, body: usize, node: [i32; 3], slot: usize, nodes: &[Node<S>]) {
        let key = key(lattice.wrapped(node));
        self.members.push(Member { key, body: body as u32, slot, mass: nodes[slot].mass });
    }

    /// Marks the bodies that share nodes.
    pub(crate) fn find_touching(&mut self, bodies: usize) {
        self.touching.clear();
        self.touching.resize(bodies, false);
        for member in &self.members {
            self.touching[member.body as usize] = true;
        }
        for meeting in &self.meetings {
            self.touching[meeting.body as usize] = true;
            if let ContactPartner::Body(other) = meeting.other {
                self.touching[other as usize] = true;
            }
        }
    }

    /// Computes surface normals from the mass gradient, and stresses at the surface, for all bodies that share nodes.
    pub(crate) fn find_faces<B: Basis>(&mut self, lattice: &Lattice, bodies: &[Body], used: usize, points: &Points<S>) {
        self.faces.clear();
        self.faces.resize(used, Face { normal: S::ORIGIN, stress: S::NO_GRADIENT });
        for (body, _) in bodies.iter().zip(&self.touching).filter(|(_, touching)| **touching) {
            body.each_stencil::<S, B>(lattice, points, |at, stencil| {
                let (mass, volume) = (points.mass[at], points.volume[at]);
                let stress = S::restrict_gradient(S::embed_symmetric(points.stress[at])) * volume;
                stencil.each::<S, B>(&body.window, |node| {
                    let face = &mut self.faces[node.slot];
                    face.normal += stencil.gradient::<S>(&node) * mass;
                    face.stress += stress * node.weight;
                });
            });
        }
    }

    /// Computes surface normals as in Bardenhagen, Brackbill & Sulsky (2000, eq. 24): the gradient of a density at cell
    /// centres that is smoothed by a quadratic B-spline.
    pub(crate) fn smooth_normals(&mut self, lattice: &Lattice, bodies: &[Body], used: usize, points: &Points<S>) {
        self.densities.clear();
        self.densities.resize(used, 0.0);
        let mut middles = *lattice;
        (0..S::DIMENSION).for_each(|axis| middles.origin[axis] += 0.5 * lattice.cell[axis]);
        for (body, _) in bodies.iter().zip(&self.touching).filter(|(_, touching)| **touching) {
            for at in body.points.clone() {
                let stencil = Stencil::new::<S, Quadratic>(&middles, points.position[at], [body.half; 3]);
                let mass = points.mass[at];
                stencil.each::<S, Quadratic>(&body.window, |node| {
                    self.densities[node.slot] += node.weight * mass;
                });
            }
        }
        // Slot i contains the density at the centre of the cell above node i. The gradient at a node follows from
        // differences between the adjacent cells. Its length is arbitrary.
        for member in &self.members {
            let window = &bodies[member.body as usize].window;
            let node = window.node(member.slot - window.start);
            let mut gradient = [0.0; 3];
            for corner in 0..1 << S::DIMENSION {
                let low = [0, 1, 2].map(|axis| i32::from(axis < S::DIMENSION && corner >> axis & 1 == 0));
                let cell = [0, 1, 2].map(|axis| node[axis] - low[axis]);
                if window.holds(S::DIMENSION, cell, 1) {
                    let density = self.densities[window.slot(cell)];
                    (0..S::DIMENSION).for_each(|axis| {
                        gradient[axis] += density * f64::from(1 - 2 * low[axis]) / lattice.cell[axis];
                    });
                }
            }
            self.faces[member.slot].normal = -S::restrict(nalgebra::Vector3::from(gradient));
        }
    }

    /// Finds the nodes around tracers that penetrate another surface or a wall, and the normals at these nodes.
    pub(crate) fn find_meetings(
        &mut self,
        lattice: &Lattice,
        bodies: &[Body],
        pairs: &[Pair<S>],
        tracers: &Tracers<S>,
        walls: &[RigidPlane<S>],
        nodes: &[Node<S>],
    ) {
        self.meetings.clear();
        for (number, wall) in walls.iter().enumerate() {
            for (place, body) in bodies.iter().enumerate().filter(|(_, body)| body.driven.is_none()) {
                for at in body.tracers.clone() {
                    let position = tracers.position[at];
                    if wall.height(position) <= 0.0 {
                        let other = ContactPartner::Wall(number as u16);
                        let normal = -wall.normal;
                        let met = SurfaceContact { body: place, other, position, normal, shift: S::ORIGIN };
                        self.meet(lattice, bodies, &met, nodes);
                    }
                }
            }
        }
        let reach = 0.8 * lattice.shortest(S::DIMENSION);
        for pair in pairs.iter().flat_map(|pair| [*pair, pair.exchanged()]) {
            let [first, second] = [&bodies[pair.first as usize], &bodies[pair.second as usize]];
            let [low, high] = second.bounds.map(|corner| S::restrict(corner) + pair.shift);
            for chunk in tracers.chunks[first.chunks.clone()].iter().filter(|chunk| chunk.meets(low, high)) {
                let mut closest = None;
                for at in chunk.tracers.clone() {
                    let position = tracers.position[at];
                    let (chunks, seen) = (second.chunks.clone(), position - pair.shift);
                    let near = tracers.gone_through(chunks, seen, tracers.area[at], reach, &mut closest);
                    let Some(near) = near else { continue };
                    let normal = tracers.normal(at);
                    // The lower body index comes first, so that the tracers of both bodies give the same pair.
                    let (out, swap) = (normal - near.normal, pair.second < pair.first);
                    let (body, other) = if swap { (pair.second, pair.first) } else { (pair.first, pair.second) };
                    let (position, shift) =
                        if swap { (position - pair.shift, -pair.shift) } else { (position, pair.shift) };
                    let normal = if swap { -out } else { out };
                    let met = SurfaceContact {
                        body: body as usize,
                        other: ContactPartner::Body(other),
                        position,
                        normal,
                        shift,
                    };
                    self.meet(lattice, bodies, &met, nodes);
                }
            }
        }
        self.meetings.sort_by_key(|meeting| (meeting.key, meeting.body, meeting.other));
        self.meetings.dedup_by(|next, kept| {
            let same = (next.key, next.body, next.other) == (kept.key, kept.body, kept.other);
            if same {
                kept.normal += next.normal;
            }
            same
        });
        for meeting in &mut self.meetings {
            let length = S::dot(meeting.normal, meeting.normal).sqrt();
            meeting.normal = meeting.normal * (1.0 / length);
        }
    }

    /// Adds a contact at every node around a contact point if both bodies have mass at the node.
    fn meet(&mut self, lattice: &Lattice, bodies: &[Body], met: &SurfaceContact<S>, nodes: &[Node<S>]) {
        let &SurfaceContact { body, other, position, normal, shift } = met;
        let window = bodies[body].window;
        let stencil = Stencil::new::<S, Linear>(lattice, position, [0.0; 3]);
        if !window.holds(S::DIMENSION, stencil.base, Linear::WIDTH as i32) {
            return;
        }
        stencil.each::<S, Linear>(&window, |node| {
            let place = [0, 1, 2].map(|axis| stencil.base[axis] + node.axes[axis] as i32);
            let mass_of = |body: usize, slot: usize| {
                let mass = nodes[slot].mass;
                // A driven body has a prescribed motion and thus infinite mass.
                if bodies[body].driven.is_some() && mass > 0.0 { f64::INFINITY } else { mass }
            };
            let mass = mass_of(body, node.slot);
            let (slots, masses) = match other {
                ContactPartner::Wall(_) => ([node.slot; 2], [mass, f64::INFINITY]),
                ContactPartner::Body(other) => {
                    let window = bodies[other as usize].window;
                    let there = [0, 1, 2].map(|axis| {
                        let away = if axis < S::DIMENSION { S::component(shift, axis) } else { 0.0 };
                        place[axis] - (away / lattice.cell[axis]).round() as i32
                    });
                    if !window.holds(S::DIMENSION, there, 1) {
                        return;
                    }
                    let slot = window.slot(there);
                    ([node.slot, slot], [mass, mass_of(other as usize, slot)])
                }
            };
            // If the contact point is on a grid line, some nodes have zero weight. They get no normal from this contact
            // point.
            if node.weight > 0.0 && masses[0] > 0.0 && masses[1] > 0.0 {
                self.meetings.push(NodalContact {
                    key: key(lattice.wrapped(place)),
                    body: body as u32,
                    other,
                    position: lattice.place::<S>(place),
                    slots,
                    masses,
                    normal: normal * node.weight,
                    impulse: S::ORIGIN,
                });
            }
        });
    }
}

/// Contact point between the surface of a body and another body or a wall.
struct SurfaceContact<S: Space> {
    body: usize,
    other: ContactPartner,
    /// Position (m).
    position: S::Vector,
    /// Outward normal of the body, of any length.
    normal: S::Vector,
    /// Translation of the partner to its periodic image nearest to the body (m).
    shift: S::Vector,
}

/// Visits the nodes that two windows share. The second window is shifted by `periods` nodes.
///
/// The arguments of `visit` are the node in the first and in the second window, and the slots of both.
fn each_common(one: &Window, two: &Window, periods: [i32; 3], mut visit: impl FnMut([i32; 3], [i32; 3], usize, usize)) {
    let low = [0, 1, 2].map(|axis| one.low[axis].max(two.low[axis] + periods[axis]));
    let high =
        [0, 1, 2].map(|axis| (one.low[axis] + one.size[axis]).min(two.low[axis] + two.size[axis] + periods[axis]));
    for z in low[2]..high[2] {
        for y in low[1]..high[1] {
            for x in low[0]..high[0] {
                let node = [x, y, z];
                let other = [x - periods[0], y - periods[1], z - periods[2]];
                visit(node, other, one.slot(node), two.slot(other));
            }
        }
    }
}
