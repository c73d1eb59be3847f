//! Loops over material points and the nodes that reach them. Each is compiled for a basis and, where it matters, a
//! transfer; the stages between them are chosen at run time.

use crate::basis::Basis;
use crate::grid::{Across, Lattice, Node, Stencil, Window};
use crate::points::Points;
use crate::tile::{self, Lanes, Tile};
use grainbench_scene::space::Space;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// How velocities travel between points and nodes.
pub(crate) trait Transfer: Copy + Send + 'static {
    /// Whether points carry the affine part of the velocity, or its spin.
    const AFFINE: bool;
    /// Velocity of a point after the step, from that before, the velocity of the nodes around it and their change.
    fn taken<S: Space>(&self, before: S::Vector, around: S::Vector, change: S::Vector) -> S::Vector;
    /// What of nodes makes the affine part: their velocities or the changes of these.
    fn source<'a>(velocities: &'a Lanes, changes: &'a Lanes) -> &'a Lanes;
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
    fn source<'a>(velocities: &'a Lanes, _changes: &'a Lanes) -> &'a Lanes {
        velocities
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
    fn source<'a>(velocities: &'a Lanes, _changes: &'a Lanes) -> &'a Lanes {
        velocities
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
    fn source<'a>(_velocities: &'a Lanes, changes: &'a Lanes) -> &'a Lanes {
        changes
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

/// The momentum that a point shows to the nodes of a stencil, m (v + A r) with r from the point to the node: by component, in a row
/// whose function across is one, and what is added from one row to the next along y and z.
struct Shown {
    first: [Lanes; 3],
    next: [[Lanes; 3]; 2],
}

impl Shown {
    #[inline(always)]
    fn new<S: Space, T: Transfer>(
        lattice: &Lattice,
        stencil: &Stencil,
        mass: f64,
        velocity: S::Vector,
        affine: S::Matrix,
    ) -> Self {
        let ([values, _], zero) = (stencil.along_x(), [0.0; 4]);
        let mut shown = Self { first: [zero; 3], next: [[zero; 3]; 2] };
        let first = if T::AFFINE { velocity + affine * stencil.arm_of_first::<S>() } else { velocity };
        let first = S::embed(first) * mass;
        let affine = S::embed_gradient(affine) * mass;
        let along = [0.0, values[1], 2.0 * values[2], 0.0];
        for component in 0..S::DIMENSION {
            if T::AFFINE {
                let steps = [0, 1, 2].map(|axis| affine[(component, axis)] * lattice.cell[axis]);
                shown.first[component] = tile::sum(&values, first[component], &along, steps[0]);
                shown.next[0][component] = values.map(|value| value * steps[1]);
                shown.next[1][component] = values.map(|value| value * steps[2]);
            } else {
                shown.first[component] = values.map(|value| value * first[component]);
            }
        }
        shown
    }

    /// Adds a component at the nodes of a row.
    #[inline(always)]
    fn add<S: Space, T: Transfer>(&self, to: &mut Lanes, component: usize, across: &Across) {
        tile::add(to, &self.first[component], across.value);
        if T::AFFINE {
            tile::add(to, &self.next[0][component], across.step[0]);
            if S::DIMENSION == 3 {
                tile::add(to, &self.next[1][component], across.step[1]);
            }
        }
    }
}

/// The gradient with these rows.
#[inline(always)]
fn of_rows<S: Space>(rows: [[f64; 3]; 3]) -> S::Matrix {
    S::restrict_gradient(Matrix3::from_fn(|row, column| rows[row][column]))
}

/// Mass, momentum and internal force, −Vσ∇N, of a body's points to its nodes.
pub(crate) fn scatter<S: Space, B: Basis, T: Transfer>(
    lattice: &Lattice,
    part: &Part,
    points: &Points<S>,
    nodes: &mut [Node<S>],
) {
    let add = |node: &mut Node<S>, [mass, px, py, pz, fx, fy, fz]: [f64; 7]| {
        node.mass += mass;
        node.velocity += S::restrict(Vector3::new(px, py, pz));
        node.change += S::restrict(Vector3::new(fx, fy, fz));
    };
    let mut sums = Tile::<7>::new();
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        if !sums.is_at(stencil.base()) {
            sums.give::<S, B, _>(&part.window, nodes, add);
            sums.empty_at::<S, B>(stencil.base());
        }
        let mass = points.mass[at];
        let shown = Shown::new::<S, T>(lattice, &stencil, mass, points.velocity[at], points.affine[at]);
        let [values, slopes] = stencil.along_x();
        let masses = values.map(|value| value * mass);
        let pull = S::embed_symmetric(points.stress[at]) * -points.volume[at];
        for row in 0..Tile::<7>::count::<S, B>() {
            let across = stencil.across::<S, B>(row);
            let to = sums.row_mut(row);
            tile::add(&mut to[0], &masses, across.value);
            for component in 0..S::DIMENSION {
                shown.add::<S, T>(&mut to[1 + component], component, &across);
                let along = pull[(component, 0)] * across.value;
                let mut rest = pull[(component, 1)] * across.slope[0];
                if S::DIMENSION == 3 {
                    rest += pull[(component, 2)] * across.slope[1];
                }
                tile::add(&mut to[4 + component], &slopes, along);
                tile::add(&mut to[4 + component], &values, rest);
            }
        }
    }
    sums.give::<S, B, _>(&part.window, nodes, add);
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
    let see = |node: &Node<S>| {
        let (velocity, change) = (S::embed(node.velocity), S::embed(node.change));
        [velocity.x, velocity.y, velocity.z, change.x, change.y, change.z]
    };
    let add = |projected: &mut S::Vector, momentum: [f64; 3]| *projected += S::restrict(Vector3::from(momentum));
    let (mut seen, mut sums) = (Tile::<6>::new(), Tile::<3>::new());
    for at in part.points.clone() {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        if !seen.is_at(stencil.base()) {
            seen.fetch::<S, B, _>(&part.window, stencil.base(), nodes, see);
            if PROJECT {
                sums.give::<S, B, _>(&part.window, projected, add);
                sums.empty_at::<S, B>(stencil.base());
            }
        }
        let [values, _] = stencil.along_x();
        let affine = stencil.affine_along_x();
        let (mut around, mut change, mut made) = ([0.0; 3], [0.0; 3], [[0.0; 3]; 3]);
        (0..S::DIMENSION).for_each(|component| {
            let ([mut velocities, mut changes], mut across_y, mut across_z) = ([[0.0; 4]; 2], [0.0; 4], [0.0; 4]);
            for row in 0..Tile::<6>::count::<S, B>() {
                let across = stencil.across::<S, B>(row);
                let (velocity, change) = (&seen.row(row)[component], &seen.row(row)[3 + component]);
                tile::add(&mut velocities, velocity, across.value);
                tile::add(&mut changes, change, across.value);
                if T::AFFINE {
                    let source = T::source(velocity, change);
                    tile::add(&mut across_y, source, across.affine[0]);
                    if S::DIMENSION == 3 {
                        tile::add(&mut across_z, source, across.affine[1]);
                    }
                }
            }
            around[component] = tile::dot(&velocities, &values);
            change[component] = tile::dot(&changes, &values);
            if T::AFFINE {
                let along = tile::dot(T::source(&velocities, &changes), &affine);
                made[component] = [along, tile::dot(&across_y, &values), tile::dot(&across_z, &values)];
            }
        });
        let [around, change] = [around, change].map(|vector| S::restrict(Vector3::from(vector)));
        let velocity = transfer.taken::<S>(points.velocity[at], around, change);
        points.velocity[at] = velocity;
        if T::AFFINE {
            points.affine[at] = T::carried::<S>(points.affine[at], of_rows::<S>(made), &stencil);
        }
        points.next[at] = points.position[at] + around * time_step;
        if PROJECT {
            let shown = Shown::new::<S, T>(lattice, &stencil, points.mass[at], velocity, points.affine[at]);
            for row in 0..Tile::<3>::count::<S, B>() {
                let across = stencil.across::<S, B>(row);
                for (component, to) in sums.row_mut(row).iter_mut().enumerate().take(S::DIMENSION) {
                    shown.add::<S, T>(to, component, &across);
                }
            }
        }
    }
    sums.give::<S, B, _>(&part.window, projected, add);
}

/// Velocity gradients (1/s) at a range of a body's points.
pub(crate) fn gradients<S: Space, B: Basis, N: Copy>(
    lattice: &Lattice,
    part: &Part,
    range: Range<usize>,
    points: &Points<S>,
    nodes: &[N],
    velocity: impl Fn(&N) -> S::Vector,
    gradients: &mut [S::Matrix],
) {
    let mut seen = Tile::<3>::new();
    for (at, gradient) in range.zip(gradients) {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        if !seen.is_at(stencil.base()) {
            seen.fetch::<S, B, _>(&part.window, stencil.base(), nodes, |node| S::embed(velocity(node)).into());
        }
        let [values, slopes] = stencil.along_x();
        let mut rows = [[0.0; 3]; 3];
        for (component, gradient) in rows.iter_mut().enumerate().take(S::DIMENSION) {
            let [mut along, mut across_y, mut across_z] = [[0.0; 4]; 3];
            for row in 0..Tile::<3>::count::<S, B>() {
                let across = stencil.across::<S, B>(row);
                let velocities = &seen.row(row)[component];
                tile::add(&mut along, velocities, across.value);
                tile::add(&mut across_y, velocities, across.slope[0]);
                if S::DIMENSION == 3 {
                    tile::add(&mut across_z, velocities, across.slope[1]);
                }
            }
            *gradient = [tile::dot(&along, &slopes), tile::dot(&across_y, &values), tile::dot(&across_z, &values)];
        }
        *gradient = of_rows::<S>(rows);
    }
}
