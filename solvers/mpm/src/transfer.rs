//! Loops over material points and the nodes that reach them. Each is compiled for a basis and, where it matters, a
//! transfer; the stages between them are chosen at run time.

use crate::basis::Basis;
use crate::grid::{Lattice, Node, Stencil, Window};
use crate::points::Points;
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// How velocities travel between points and nodes.
pub(crate) trait Transfer: Copy + Send + 'static {
    /// Whether points carry the affine part of the velocity, or its spin.
    const AFFINE: bool;
    /// Velocity of a point after the step, from that before, the velocity of the nodes around it and their change.
    fn taken<S: Space>(&self, before: S::Vector, around: S::Vector, change: S::Vector) -> S::Vector;
    /// What of a node makes the affine part: its velocity or its change.
    fn source<S: Space>(node: &Node<S>) -> S::Vector;
    /// Affine part after the step, from that before and the one that the nodes make.
    fn carried<S: Space>(before: S::Matrix, made: S::Matrix, stencil: &Stencil) -> S::Matrix;
}

/// Points keep their velocity and take on its change (Brackbill & Ruppel 1986), blended with the velocity itself:
/// v ← (1 − α)(v + Δv) + α v_grid.
#[derive(Clone, Copy)]
pub(crate) struct Flip {
    /// Fraction α.
    pub(crate) pic: f64,
}

impl Transfer for Flip {
    const AFFINE: bool = false;

    #[inline(always)]
    fn taken<S: Space>(&self, before: S::Vector, around: S::Vector, change: S::Vector) -> S::Vector {
        (before + change) * (1.0 - self.pic) + around * self.pic
    }
    #[inline(always)]
    fn source<S: Space>(_node: &Node<S>) -> S::Vector {
        S::ORIGIN
    }
    #[inline(always)]
    fn carried<S: Space>(before: S::Matrix, _made: S::Matrix, _stencil: &Stencil) -> S::Matrix {
        before
    }
}

/// Points carry the affine part of the velocity (Jiang et al. 2015), which keeps angular momentum and damps what is
/// shorter than a few cells.
#[derive(Clone, Copy)]
pub(crate) struct Apic;

impl Transfer for Apic {
    const AFFINE: bool = true;

    #[inline(always)]
    fn taken<S: Space>(&self, _before: S::Vector, around: S::Vector, _change: S::Vector) -> S::Vector {
        around
    }
    #[inline(always)]
    fn source<S: Space>(node: &Node<S>) -> S::Vector {
        node.velocity
    }
    #[inline(always)]
    fn carried<S: Space>(_before: S::Matrix, made: S::Matrix, _stencil: &Stencil) -> S::Matrix {
        made
    }
}

/// Points keep their velocity and a spin, and take on the change of both: FLIP that does not lose the angular momentum
/// which points of finite extent have, and, unlike APIC, damps nothing.
///
/// The change of the spin is that of the rigid rotation with the angular momentum that the nodes' change has about the
/// point: Δω = Σ w r × Δv / Σ w |r|² about each axis, r from the point to the node and its lengths across that axis.
#[derive(Clone, Copy)]
pub(crate) struct Spin;

impl Transfer for Spin {
    const AFFINE: bool = true;

    #[inline(always)]
    fn taken<S: Space>(&self, before: S::Vector, _around: S::Vector, change: S::Vector) -> S::Vector {
        before + change
    }
    #[inline(always)]
    fn source<S: Space>(node: &Node<S>) -> S::Vector {
        node.change
    }
    #[inline(always)]
    fn carried<S: Space>(before: S::Matrix, made: S::Matrix, stencil: &Stencil) -> S::Matrix {
        // The affine part is B D⁻¹ with B = Σ w Δv rᵀ and D = Σ w r rᵀ, which is diagonal.
        let made = S::embed_gradient(made);
        let about = |a: usize, b: usize| {
            let spread = [stencil.spread(a), stencil.spread(b)];
            let total = spread[0] + spread[1];
            if total > 0.0 { (made[(b, a)] * spread[0] - made[(a, b)] * spread[1]) / total } else { 0.0 }
        };
        let spin = if S::DIMENSION == 2 {
            Vector3::new(0.0, 0.0, about(0, 1))
        } else {
            Vector3::new(about(1, 2), about(2, 0), about(0, 1))
        };
        before + S::restrict_gradient(spin.cross_matrix())
    }
}

/// The points of one body and the window they share.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The points.
    pub(crate) points: Range<usize>,
    /// Where their field keeps its nodes.
    pub(crate) window: Window,
    /// Half the extent of a point (cells), for GIMP.
    pub(crate) half: f64,
}

impl Part {
    /// Half the extent of a point along each axis (cells): it grows with the material lines along the axis, √b_ii, which
    /// keeps points contiguous where the stretch is along the axes and does not change under rotation.
    #[inline(always)]
    pub(crate) fn extent<S: Space, B: Basis>(&self, deformation: S::Matrix) -> [f64; 3] {
        if !B::EXTENDED {
            return [self.half; 3];
        }
        let f = S::embed_gradient(deformation);
        [0, 1, 2].map(|axis| {
            let stretch = (f[(axis, 0)].powi(2) + f[(axis, 1)].powi(2) + f[(axis, 2)].powi(2)).sqrt();
            (self.half * stretch).clamp(1e-3, 0.5)
        })
    }
}

/// Mass, momentum and internal force, −Vσ∇N, of a body's points to its nodes.
pub(crate) fn scatter<S: Space, B: Basis, T: Transfer>(
    lattice: &Lattice,
    part: &Part,
    points: &Points<S>,
    nodes: &mut [Node<S>],
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let (mass, velocity, affine) = (points.mass[at], points.velocity[at], points.affine[at]);
        let (stress, volume) = (points.stress[at], -points.volume[at]);
        stencil.each::<S, B>(&part.window, |node| {
            let shown = if T::AFFINE { velocity + affine * stencil.arm(&node) } else { velocity };
            let share = node.weight * mass;
            let to = &mut nodes[node.slot];
            to.mass += share;
            to.velocity += shown * share;
            to.change += S::apply(stress, stencil.gradient(&node)) * volume;
        });
    }
}

/// Internal force alone, after the stress has changed.
pub(crate) fn scatter_force<S: Space, B: Basis>(
    lattice: &Lattice,
    part: &Part,
    points: &Points<S>,
    nodes: &mut [Node<S>],
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let (stress, volume) = (points.stress[at], -points.volume[at]);
        stencil.each::<S, B>(&part.window, |node| {
            nodes[node.slot].change += S::apply(stress, stencil.gradient(&node)) * volume;
        });
    }
}

/// A force (N) on each point, such as that of a manufactured solution, to the nodes.
pub(crate) fn scatter_body_force<S: Space, B: Basis>(
    lattice: &Lattice,
    part: &Part,
    points: &Points<S>,
    force: impl Fn(usize) -> S::Vector,
    nodes: &mut [Node<S>],
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let force = force(at);
        stencil.each::<S, B>(&part.window, |node| nodes[node.slot].change += force * node.weight);
    }
}

/// Velocity and next position of a body's points from its nodes; and, with `PROJECT`, the momentum of the points with
/// their new velocity back to the nodes (MUSL).
pub(crate) fn gather<S: Space, B: Basis, T: Transfer, const PROJECT: bool>(
    lattice: &Lattice,
    part: &Part,
    transfer: T,
    time_step: f64,
    points: &mut Points<S>,
    nodes: &[Node<S>],
    projected: &mut [S::Vector],
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let (mut around, mut change, mut affine) = (S::ORIGIN, S::ORIGIN, S::NO_GRADIENT);
        stencil.each::<S, B>(&part.window, |node| {
            let from = &nodes[node.slot];
            around += from.velocity * node.weight;
            change += from.change * node.weight;
            if T::AFFINE {
                affine += S::outer(T::source::<S>(from), stencil.affine(&node));
            }
        });
        let velocity = transfer.taken::<S>(points.velocity[at], around, change);
        points.velocity[at] = velocity;
        if T::AFFINE {
            affine = T::carried::<S>(points.affine[at], affine, &stencil);
            points.affine[at] = affine;
        }
        points.next[at] = points.position[at] + around * time_step;
        if PROJECT {
            let mass = points.mass[at];
            stencil.each::<S, B>(&part.window, |node| {
                let shown = if T::AFFINE { velocity + affine * stencil.arm(&node) } else { velocity };
                projected[node.slot] += shown * (node.weight * mass);
            });
        }
    }
}

/// Velocity gradients at a body's points.
pub(crate) fn gradients<S: Space, B: Basis>(
    lattice: &Lattice,
    part: &Part,
    points: &mut Points<S>,
    velocity: impl Fn(usize) -> S::Vector,
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let mut gradient = S::NO_GRADIENT;
        stencil.each::<S, B>(&part.window, |node| {
            gradient += S::outer(velocity(node.slot), stencil.gradient(&node));
        });
        points.gradient[at] = gradient;
    }
}
