//! Grid of nodes. All velocity fields use a common lattice, and every field stores the nodes of its own window of the
//! lattice.
//!
//! A field belongs to one body, or to all bodies if they share one velocity field. The window is the box of nodes that
//! the points of the field influence. Memory and time therefore grow with the bodies and not with the space between
//! them. A node shared by three bodies is stored three times, once in each window.

use crate::grid::basis::{Axis, Basis};
use grainbench_lanes::Number;
use grainbench_solver::space::Space;
use nalgebra::Vector3;
use std::ops::Range;

/// Node of a velocity field. The order of the struct fields is fixed, so that the contributions of a point are added
/// contiguously.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Node<S: Space> {
    /// Mass (kg).
    pub(crate) mass: f64,
    /// Momentum (kg m/s) while points are scattered; velocity (m/s) afterwards.
    pub(crate) velocity: S::Vector,
    /// Force (N) while points are scattered; change of velocity in the step (m/s) afterwards.
    pub(crate) change: S::Vector,
}

impl<S: Space> Node<S> {
    pub(crate) const EMPTY: Self = Self { mass: 0.0, velocity: S::ORIGIN, change: S::ORIGIN };
}

/// Box of lattice nodes that a field stores.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Window {
    /// First node along each axis.
    pub(crate) low: [i32; 3],
    /// Number of nodes along each axis.
    pub(crate) size: [i32; 3],
    /// Slot of the first node in the common node array.
    pub(crate) start: usize,
    /// Axes along which the window covers the whole period, so that node indices wrap around.
    pub(crate) whole: [bool; 3],
}

impl Window {
    pub(crate) const fn len(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize * self.size[2] as usize
    }

    /// Returns the slots of the window's nodes in the common node array.
    pub(crate) const fn slots(&self) -> Range<usize> {
        self.start..self.start + self.len()
    }

    /// Returns the index of a node within the window along an axis.
    #[inline(always)]
    pub(crate) fn along(&self, axis: usize, node: i32) -> usize {
        let place = node - self.low[axis];
        (if self.whole[axis] { place.rem_euclid(self.size[axis]) } else { place }) as usize
    }

    /// Returns the slot of a node in the common node array. The node must be in the window.
    #[inline(always)]
    pub(crate) fn slot(&self, node: [i32; 3]) -> usize {
        let [x, y, z] = [0, 1, 2].map(|axis| self.along(axis, node[axis]));
        self.start + (z * self.size[1] as usize + y) * self.size[0] as usize + x
    }

    /// Returns true if all nodes of a stencil of `width` nodes from `base` are in the window.
    #[inline(always)]
    pub(crate) fn holds(&self, dimensions: usize, base: [i32; 3], width: i32) -> bool {
        (0..dimensions).all(|axis| {
            let place = base[axis] - self.low[axis];
            self.whole[axis] || (place >= 0 && place + width <= self.size[axis])
        })
    }

    /// Returns the node with a given index within the window.
    pub(crate) fn node(&self, place: usize) -> [i32; 3] {
        let place = place as i32;
        let [nx, ny, _] = self.size;
        [self.low[0] + place % nx, self.low[1] + place / nx % ny, self.low[2] + place / (nx * ny)]
    }
}

/// Lattice of all possible nodes, with its cell lengths, origin and periods.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Length of a cell along each axis (m).
    pub(crate) cell: [f64; 3],
    /// Inverse cell length along each axis (1/m).
    pub(crate) inverse: [f64; 3],
    /// Position of node zero (m).
    pub(crate) origin: [f64; 3],
    /// Number of cells in a period, along periodic axes.
    pub(crate) period: [Option<i32>; 3],
}

impl Lattice {
    /// Returns a position along an axis, in units of the cell length.
    #[inline(always)]
    pub(crate) fn cells<S: Space>(&self, position: S::Vector, axis: usize) -> f64 {
        (S::component(position, axis) - self.origin[axis]) * self.inverse[axis]
    }

    /// Returns the first node that influences a position.
    #[inline(always)]
    pub(crate) fn first<S: Space, B: Basis>(&self, position: S::Vector) -> [i32; 3] {
        [0, 1, 2].map(|axis| if axis < S::DIMENSION { B::first(self.cells::<S>(position, axis)) } else { 0 })
    }

    /// Returns the position of a node (m).
    pub(crate) fn place<S: Space>(&self, node: [i32; 3]) -> S::Vector {
        let at = |axis: usize| self.origin[axis] + f64::from(node[axis]) * self.cell[axis];
        S::restrict(Vector3::new(at(0), at(1), at(2)))
    }

    /// Returns the shortest cell length (m).
    pub(crate) fn shortest(&self, dimensions: usize) -> f64 {
        self.cell[..dimensions].iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Returns the window of nodes for a box of positions (m). The start slot of the window is not set.
    pub(crate) fn window<S: Space>(&self, low: S::Vector, high: S::Vector) -> Window {
        let mut window = Window { size: [1; 3], ..Window::default() };
        for axis in 0..S::DIMENSION {
            // `SharedNodes::smooth_normals` needs one node more at the lower end than any basis function.
            let first = (self.cells::<S>(low, axis) - 0.5).floor() as i32 - 1;
            let last = (self.cells::<S>(high, axis) - 0.5).floor() as i32 + 2;
            window.low[axis] = first;
            window.size[axis] = last - first + 1;
            if let Some(period) = self.period[axis].filter(|&period| window.size[axis] >= period) {
                (window.low[axis], window.size[axis], window.whole[axis]) = (0, period, true);
            }
        }
        window
    }

    /// Returns the image of the node within the first period.
    pub(crate) fn wrapped(&self, mut node: [i32; 3]) -> [i32; 3] {
        for (node, period) in node.iter_mut().zip(self.period) {
            if let Some(period) = period {
                *node = node.rem_euclid(period);
            }
        }
        node
    }
}

/// Nodes that influence a point (or four points with the same nodes), with their basis functions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stencil<N> {
    /// First node along each axis.
    pub(crate) base: [i32; 3],
    pub(crate) axes: [Axis<N>; 3],
    inverse: [f64; 3],
    /// Distance from the first node to the point (cells).
    at: [N; 3],
    cell: [f64; 3],
}

/// Basis functions of a row of nodes along x, without the factors along x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowBasis<N> {
    /// Product of the functions along y and z at the point.
    pub(crate) value: N,
    /// Products with the slope instead of the value: first the slope along y, then the slope along z (1/m).
    pub(crate) slope: [N; 2],
    /// Products with the affine weight instead of the value: first the weight along y, then the weight along z (1/m).
    pub(crate) affine: [N; 2],
}

/// Node of a stencil, with index and weight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StencilNode {
    /// Slot of the node in the common node array.
    pub(crate) slot: usize,
    /// Value of the node's basis function at the point.
    pub(crate) weight: f64,
    /// Index of the node within the stencil along each axis.
    pub(crate) axes: [usize; 3],
}

impl<N: Number> Stencil<N> {
    /// Computes the stencil of points at positions (m) with first node `base` and half extents `half` (cells).
    #[inline(always)]
    pub(crate) fn around<S: Space, B: Basis>(
        lattice: &Lattice,
        base: [i32; 3],
        position: [N; 3],
        half: [N; 3],
    ) -> Self {
        let Lattice { inverse, cell, origin, .. } = *lattice;
        let zero = position[0].like(0.0);
        let none = Axis { value: [zero; 3], slope: [zero; 3], affine: [zero; 3], spread: zero };
        let mut stencil = Self { base, axes: [none; 3], inverse, at: [zero; 3], cell };
        for axis in 0..S::DIMENSION {
            let at = (position[axis] - origin[axis]) * inverse[axis] - f64::from(base[axis]);
            stencil.axes[axis] = B::axis(at, half[axis]);
            stencil.at[axis] = at;
        }
        stencil
    }

    /// Returns the functions along x: values, and slopes (1/m).
    #[inline(always)]
    pub(crate) fn along_x(&self) -> [[N; 3]; 2] {
        let [a, b, c] = self.axes[0].slope;
        [self.axes[0].value, [a * self.inverse[0], b * self.inverse[0], c * self.inverse[0]]]
    }

    /// Returns the affine weights along x, for each node (1/m).
    #[inline(always)]
    pub(crate) fn affine_along_x(&self) -> [N; 3] {
        let [a, b, c] = self.axes[0].affine;
        [a * self.inverse[0], b * self.inverse[0], c * self.inverse[0]]
    }

    /// Returns the product of the functions along y and z for a row of nodes along x.
    #[inline(always)]
    pub(crate) fn across<S: Space, B: Basis>(&self, row: usize) -> RowBasis<N> {
        let (j, k) = (row % B::WIDTH, row / B::WIDTH);
        let [_, y, z] = &self.axes;
        let [slope, affine] = [y.slope[j] * self.inverse[1], y.affine[j] * self.inverse[1]];
        if S::DIMENSION == 2 {
            let zero = slope.like(0.0);
            return RowBasis { value: y.value[j], slope: [slope, zero], affine: [affine, zero] };
        }
        let deep = z.value[k];
        let deep_slope = y.value[j] * (z.slope[k] * self.inverse[2]);
        let deep_affine = y.value[j] * (z.affine[k] * self.inverse[2]);
        RowBasis { value: y.value[j] * deep, slope: [slope * deep, deep_slope], affine: [affine * deep, deep_affine] }
    }

    /// Returns the component along an axis of the vector from the point to the first node (m).
    #[inline(always)]
    pub(crate) fn arm_of_first(&self, axis: usize) -> N {
        self.at[axis] * -self.cell[axis]
    }

    /// Returns Σ w r² along an axis, with r from the point to the node (m²).
    #[inline(always)]
    pub(crate) fn spread(&self, axis: usize) -> N {
        self.axes[axis].spread * (self.cell[axis] * self.cell[axis])
    }
}

impl Stencil<f64> {
    /// Computes the stencil of a point at a position (m) with half extents `half` (cells).
    #[inline(always)]
    pub(crate) fn new<S: Space, B: Basis>(lattice: &Lattice, position: S::Vector, half: [f64; 3]) -> Self {
        Self::around::<S, B>(lattice, lattice.first::<S, B>(position), S::embed(position).into(), half)
    }

    /// Calls `visit` for every node of the stencil.
    #[inline(always)]
    pub(crate) fn each<S: Space, B: Basis>(&self, window: &Window, mut visit: impl FnMut(StencilNode)) {
        let solid = S::DIMENSION == 3;
        let row = window.size[0] as usize;
        let layer = row * window.size[1] as usize;
        let mut x = [0; 3];
        for (i, x) in x.iter_mut().enumerate().take(B::WIDTH) {
            *x = window.start + window.along(0, self.base[0] + i as i32);
        }
        for k in 0..if solid { B::WIDTH } else { 1 } {
            let (z, across) = if solid {
                (window.along(2, self.base[2] + k as i32) * layer, self.axes[2].value[k])
            } else {
                (0, 1.0)
            };
            for j in 0..B::WIDTH {
                let y = z + window.along(1, self.base[1] + j as i32) * row;
                let weight = across * self.axes[1].value[j];
                for (i, x) in x.into_iter().enumerate().take(B::WIDTH) {
                    visit(StencilNode { slot: y + x, weight: weight * self.axes[0].value[i], axes: [i, j, k] });
                }
            }
        }
    }

    /// Returns the gradient of the node's basis function at the point (1/m).
    #[inline(always)]
    pub(crate) fn gradient<S: Space>(&self, node: &StencilNode) -> S::Vector {
        let [i, j, k] = node.axes;
        let [a, b, c] = &self.axes;
        let (x, y) = (a.value[i], b.value[j]);
        let z = if S::DIMENSION == 3 { c.value[k] } else { 1.0 };
        S::restrict(Vector3::new(
            a.slope[i] * y * z * self.inverse[0],
            x * b.slope[j] * z * self.inverse[1],
            x * y * c.slope[k] * self.inverse[2],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::basis::{Gimp, Linear, Quadratic};
    use grainbench_solver::space::Solid;

    /// Checks that a field that is linear in position has the same gradient everywhere, with cells of 1, 2 and 3 m. The
    /// gradient is evaluated node by node and row by row.
    fn keeps_a_gradient<B: Basis>() {
        let inverse = [1.0, 1.0 / 2.0, 1.0 / 3.0];
        let lattice = Lattice { cell: [1.0, 2.0, 3.0], inverse, origin: [0.3, -0.2, 0.1], period: [None; 3] };
        let slope = Vector3::new(2.0, -3.0, 5.0);
        for position in [Vector3::new(4.1, 7.3, -2.2), Vector3::new(0.35, -0.9, 3.6)] {
            let stencil = Stencil::new::<Solid, B>(&lattice, position, [0.2; 3]);
            let field = |node: [i32; 3]| slope.dot(&lattice.place::<Solid>(node));
            let window = Window { low: stencil.base, size: [3; 3], ..Window::default() };
            let mut by_nodes = Vector3::zeros();
            stencil.each::<Solid, B>(&window, |node| {
                by_nodes += stencil.gradient::<Solid>(&node) * field(window.node(node.slot));
            });
            assert!((by_nodes - slope).norm() < 1e-12, "{by_nodes}");
            let [values, slopes] = stencil.along_x();
            let mut by_rows = Vector3::zeros();
            for row in 0..B::WIDTH * B::WIDTH {
                let across = stencil.across::<Solid, B>(row);
                for i in 0..B::WIDTH {
                    let offset = [i, row % B::WIDTH, row / B::WIDTH].map(|place| place as i32);
                    let value = field([0, 1, 2].map(|axis| stencil.base[axis] + offset[axis]));
                    let [y, z] = across.slope;
                    by_rows += Vector3::new(slopes[i] * across.value, values[i] * y, values[i] * z) * value;
                }
            }
            assert!((by_rows - slope).norm() < 1e-12, "{by_rows}");
        }
    }

    #[test]
    fn gradients_are_divided_by_the_cell_along_their_axis() {
        keeps_a_gradient::<Linear>();
        keeps_a_gradient::<Quadratic>();
        keeps_a_gradient::<Gimp>();
    }
}
