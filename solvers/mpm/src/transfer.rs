//! Loops over material points and the nodes that reach them. Each is compiled for a basis and, where it matters, a
//! transfer; the stages between them are chosen at run time.

use crate::basis::Basis;
use crate::grid::{Lattice, Node, Row, Stencil, Window};
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
    fn source<S: Space>(velocity: S::Vector, change: S::Vector) -> S::Vector;
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
    fn source<S: Space>(_velocity: S::Vector, _change: S::Vector) -> S::Vector {
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
    fn source<S: Space>(velocity: S::Vector, _change: S::Vector) -> S::Vector {
        velocity
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
    fn source<S: Space>(_velocity: S::Vector, change: S::Vector) -> S::Vector {
        change
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

/// A column of a gradient.
#[inline(always)]
fn column<S: Space>(gradient: &nalgebra::Matrix3<f64>, axis: usize) -> S::Vector {
    S::restrict(Vector3::new(gradient[(0, axis)], gradient[(1, axis)], gradient[(2, axis)]))
}

/// The gradient with these columns.
#[inline(always)]
fn of_columns<S: Space>(columns: [S::Vector; 3]) -> S::Matrix {
    let [x, y, z] = columns;
    S::restrict_gradient(nalgebra::Matrix3::from_columns(&[S::embed(x), S::embed(y), S::embed(z)]))
}

/// The momentum that a point shows to the nodes of a stencil: m (v + A r), r from the point to the node.
struct Shown<S: Space> {
    /// At the first node.
    first: S::Vector,
    /// More of it from one node to the next along each axis.
    steps: [S::Vector; 3],
}

impl<S: Space> Shown<S> {
    #[inline(always)]
    fn new<T: Transfer>(
        lattice: &Lattice,
        stencil: &Stencil,
        mass: f64,
        velocity: S::Vector,
        affine: S::Matrix,
    ) -> Self {
        if !T::AFFINE {
            return Self { first: velocity * mass, steps: [S::ORIGIN; 3] };
        }
        let gradient = S::embed_gradient(affine);
        let step = |axis| column::<S>(&gradient, axis) * (lattice.cell[axis] * mass);
        Self { first: (velocity + affine * stencil.arm_of_first::<S>()) * mass, steps: [step(0), step(1), step(2)] }
    }

    /// At the first node of a row, times the functions across it; and more of it from one node to the next.
    #[inline(always)]
    fn along<T: Transfer>(&self, row: &Row) -> [S::Vector; 2] {
        if !T::AFFINE {
            return [self.first * row.value, S::ORIGIN];
        }
        let mut first = self.first + self.steps[1] * row.across[0] as f64;
        if S::DIMENSION == 3 {
            first += self.steps[2] * row.across[1] as f64;
        }
        [first * row.value, self.steps[0] * row.value]
    }

    /// At a node of a row.
    #[inline(always)]
    fn at<T: Transfer>([first, step]: [S::Vector; 2], node: usize, value: f64) -> S::Vector {
        if T::AFFINE { (first + step * node as f64) * value } else { first * value }
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
        let mass = points.mass[at];
        let shown = Shown::<S>::new::<T>(lattice, &stencil, mass, points.velocity[at], points.affine[at]);
        let stress = S::embed_symmetric(points.stress[at]);
        let volume = -points.volume[at];
        let pull =
            [column::<S>(&stress, 0) * volume, column::<S>(&stress, 1) * volume, column::<S>(&stress, 2) * volume];
        let (values, slopes) = stencil.along_x();
        stencil.rows::<S, B>(&part.window, |row| {
            let momentum = shown.along::<T>(&row);
            let share = mass * row.value;
            let along = pull[0] * row.value;
            let mut across = pull[1] * row.slope[0];
            if S::DIMENSION == 3 {
                across += pull[2] * row.slope[1];
            }
            row.add::<B, _>(nodes, Node::EMPTY, Node::add, |nodes| {
                for (i, node) in nodes.iter_mut().enumerate() {
                    node.mass += share * values[i];
                    node.velocity += Shown::<S>::at::<T>(momentum, i, values[i]);
                    node.change += along * slopes[i] + across * values[i];
                }
            });
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
        let (mut around, mut change, mut made) = (S::ORIGIN, S::ORIGIN, [S::ORIGIN; 3]);
        let (values, _) = stencil.along_x();
        let [x, y, z] = [stencil.affine_along(0), stencil.affine_along(1), stencil.affine_along(2)];
        stencil.rows::<S, B>(&part.window, |row| {
            let (mut row_around, mut row_change, mut row_made) = (S::ORIGIN, S::ORIGIN, S::ORIGIN);
            row.see::<B, _>(nodes, |nodes| {
                for (i, node) in nodes.iter().enumerate() {
                    row_around += node.velocity * values[i];
                    row_change += node.change * values[i];
                    if T::AFFINE {
                        row_made += T::source::<S>(node.velocity, node.change) * x[i];
                    }
                }
            });
            around += row_around * row.value;
            change += row_change * row.value;
            if T::AFFINE {
                let source = T::source::<S>(row_around, row_change);
                let [j, k] = row.across;
                made[0] += row_made * row.value;
                let deep = if S::DIMENSION == 3 { stencil.value_along(2, k) } else { 1.0 };
                made[1] += source * (y[j] * deep);
                if S::DIMENSION == 3 {
                    made[2] += source * (stencil.value_along(1, j) * z[k]);
                }
            }
        });
        let velocity = transfer.taken::<S>(points.velocity[at], around, change);
        points.velocity[at] = velocity;
        if T::AFFINE {
            points.affine[at] = T::carried::<S>(points.affine[at], of_columns::<S>(made), &stencil);
        }
        points.next[at] = points.position[at] + around * time_step;
        if PROJECT {
            let shown = Shown::<S>::new::<T>(lattice, &stencil, points.mass[at], velocity, points.affine[at]);
            stencil.rows::<S, B>(&part.window, |row| {
                let momentum = shown.along::<T>(&row);
                row.add::<B, _>(
                    projected,
                    S::ORIGIN,
                    |to, share| *to += *share,
                    |projected| {
                        for (i, projected) in projected.iter_mut().enumerate() {
                            *projected += Shown::<S>::at::<T>(momentum, i, values[i]);
                        }
                    },
                );
            });
        }
    }
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
    for (at, gradient) in range.zip(gradients) {
        let stencil = Stencil::new::<S, B>(lattice, points.position[at], part.extent::<S, B>(points.deformation[at]));
        let (values, slopes) = stencil.along_x();
        let mut columns = [S::ORIGIN; 3];
        stencil.rows::<S, B>(&part.window, |row| {
            let (mut along, mut across) = (S::ORIGIN, S::ORIGIN);
            row.see::<B, _>(nodes, |nodes| {
                for (i, node) in nodes.iter().enumerate() {
                    let velocity = velocity(node);
                    along += velocity * slopes[i];
                    across += velocity * values[i];
                }
            });
            columns[0] += along * row.value;
            columns[1] += across * row.slope[0];
            if S::DIMENSION == 3 {
                columns[2] += across * row.slope[1];
            }
        });
        *gradient = of_columns::<S>(columns);
    }
}
