//! How velocities travel between points and nodes, and the forces that reach nodes by themselves.

use crate::basis::Basis;
use crate::grid::{Lattice, Node, Stencil, Window};
use crate::points::Points;
use grainbench_lanes::Number;
use grainbench_scene::space::Space;
use std::ops::Range;

/// How velocities travel between points and nodes.
pub(crate) trait Transfer: Copy + Send + 'static {
    /// Whether points carry the affine part of the velocity, or its spin.
    const AFFINE: bool;
    /// Whether points take on the velocity of the nodes itself, and not its change alone.
    const AROUND: bool;
    /// A component of a point's velocity after the step, from what damping leaves of that before, the velocity of the
    /// nodes around it and their change but for damping.
    fn taken<N: Number>(&self, before: N, around: N, change: N) -> N;
    /// What of nodes makes the affine part: their velocities or the changes of these.
    fn source<N>(velocity: N, change: N) -> N;
    /// Affine part after the step, row by row, from that before and the one that the nodes make.
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], made: [[N; 3]; 3], stencil: &Stencil<N>) -> [[N; 3]; 3];
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
    const AROUND: bool = true;

    #[inline(always)]
    fn taken<N: Number>(&self, before: N, around: N, change: N) -> N {
        (before + change) * (1.0 - self.pic) + around * self.pic
    }
    #[inline(always)]
    fn source<N>(velocity: N, _change: N) -> N {
        velocity
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], _made: [[N; 3]; 3], _stencil: &Stencil<N>) -> [[N; 3]; 3] {
        before
    }
}

/// Points carry the affine part of the velocity (Jiang et al. 2015), which keeps angular momentum and damps what is
/// shorter than a few cells.
#[derive(Clone, Copy)]
pub(crate) struct Apic;

impl Transfer for Apic {
    const AFFINE: bool = true;
    const AROUND: bool = true;

    #[inline(always)]
    fn taken<N: Number>(&self, _before: N, around: N, _change: N) -> N {
        around
    }
    #[inline(always)]
    fn source<N>(velocity: N, _change: N) -> N {
        velocity
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(_before: [[N; 3]; 3], made: [[N; 3]; 3], _stencil: &Stencil<N>) -> [[N; 3]; 3] {
        made
    }
}

/// Points keep their velocity and a spin, and take on the change of both: FLIP that does not lose the angular momentum
/// which points of finite extent have, and, unlike APIC, damps nothing.
///
/// The change of the spin is that of the rigid rotation with the angular momentum that the nodes' change has about the
/// point: Δω = Σ w r × Δv / Σ w |r|² about each axis, r from the point to the node and its lengths across that axis. A
/// point that flows takes on the spin around it ([`crate::stress::Update`]).
#[derive(Clone, Copy)]
pub(crate) struct Spin;

impl Transfer for Spin {
    const AFFINE: bool = true;
    const AROUND: bool = false;

    #[inline(always)]
    fn taken<N: Number>(&self, before: N, _around: N, change: N) -> N {
        before + change
    }
    #[inline(always)]
    fn source<N>(_velocity: N, change: N) -> N {
        change
    }
    #[inline(always)]
    fn carried<S: Space, N: Number>(before: [[N; 3]; 3], made: [[N; 3]; 3], stencil: &Stencil<N>) -> [[N; 3]; 3] {
        // The affine part is B D⁻¹ with B = Σ w Δv rᵀ and D = Σ w r rᵀ, which is diagonal.
        let mut after = before;
        for a in 0..S::DIMENSION {
            for b in a + 1..S::DIMENSION {
                let [one, two] = [stencil.spread(a), stencil.spread(b)];
                let total = one + two;
                let turn = (made[b][a] * one - made[a][b] * two) / total;
                // A point on a node of hat functions has nothing to turn about.
                let turn = total.like(0.0).pick_below(total, turn, total.like(0.0));
                after[b][a] = after[b][a] + turn;
                after[a][b] = after[a][b] - turn;
            }
        }
        after
    }
}

/// The points of one body and the window they share.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The points.
    pub(crate) points: Range<usize>,
    /// Where their field keeps its nodes.
    pub(crate) window: Window,
    /// How many runs there were when the points were last put in order.
    pub(crate) runs_in_order: usize,
    /// Half the extent of a point (cells), for GIMP.
    pub(crate) half: f64,
    /// Mass of a full cell at the start (kg).
    pub(crate) cell_mass: f64,
}

impl Part {
    /// Half the extent of a point along each axis (cells): it grows with the material lines along the axis, √b_ii,
    /// which keeps points contiguous where the stretch is along the axes and does not change under rotation.
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

/// Sets a vector of each point of a part to Σ N_i Δv_i over the changes of the nodes that reach it.
pub(crate) fn gather_changes<S: Space, B: Basis>(
    lattice: &Lattice,
    part: &Part,
    points: &Points<S>,
    nodes: &[Node<S>],
    changes: &mut [S::Vector],
) {
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        changes[at] = S::ORIGIN;
        stencil.each::<S, B>(&part.window, |node| changes[at] += nodes[node.slot].change * node.weight);
    }
}
