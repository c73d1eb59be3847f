//! The nodes around a cell, side by side: material points are kept in the order of their cells, and those that follow each other mostly
//! reach the same nodes, which are then fetched and put back once for all of them.

use crate::basis::Basis;
use crate::grid::Window;
use grainbench_scene::space::Space;

/// One quantity at the nodes of a row along x: as many as the basis reaches, and zeros.
pub(crate) type Lanes = [f64; 4];

/// `to` + `by` × `of`, node by node.
#[inline(always)]
pub(crate) fn add(to: &mut Lanes, of: &Lanes, by: f64) {
    for (to, of) in to.iter_mut().zip(of) {
        *to += of * by;
    }
}

/// Sum over the nodes of a row.
#[inline(always)]
pub(crate) fn dot(a: &Lanes, b: &Lanes) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// Sum of two rows, each times a factor.
#[inline(always)]
pub(crate) fn sum(a: &Lanes, by: f64, b: &Lanes, and: f64) -> Lanes {
    [0, 1, 2, 3].map(|lane| a[lane] * by + b[lane] * and)
}

/// Rows of nodes that reach a point, at most: three by three.
const ROWS: usize = 9;

/// `N` quantities at the nodes of a stencil, row by row.
pub(crate) struct Tile<const N: usize> {
    rows: [[Lanes; N]; ROWS],
    /// The first of its nodes, where it has any.
    base: Option<[i32; 3]>,
}

impl<const N: usize> Tile<N> {
    pub(crate) const fn new() -> Self {
        Self { rows: [[[0.0; 4]; N]; ROWS], base: None }
    }

    /// How many rows a stencil has.
    pub(crate) const fn count<S: Space, B: Basis>() -> usize {
        if S::DIMENSION == 3 { B::WIDTH * B::WIDTH } else { B::WIDTH }
    }

    #[inline(always)]
    pub(crate) const fn row(&self, row: usize) -> &[Lanes; N] {
        &self.rows[row]
    }

    #[inline(always)]
    pub(crate) const fn row_mut(&mut self, row: usize) -> &mut [Lanes; N] {
        &mut self.rows[row]
    }

    /// Whether it holds the nodes from this one on.
    #[inline(always)]
    pub(crate) fn is_at(&self, base: [i32; 3]) -> bool {
        self.base == Some(base)
    }

    /// Empties it, to collect what goes to the nodes from this one on.
    #[inline(always)]
    pub(crate) fn empty_at<S: Space, B: Basis>(&mut self, base: [i32; 3]) {
        self.base = Some(base);
        for row in &mut self.rows[..Self::count::<S, B>()] {
            *row = [[0.0; 4]; N];
        }
    }

    /// Fetches the nodes from this one on.
    #[inline(always)]
    pub(crate) fn fetch<S: Space, B: Basis, T>(
        &mut self,
        window: &Window,
        base: [i32; 3],
        nodes: &[T],
        of: impl Fn(&T) -> [f64; N],
    ) {
        self.base = Some(base);
        window.rows::<S, B>(base, |row, slots| {
            for (lane, &slot) in slots[..B::WIDTH].iter().enumerate() {
                let values = of(&nodes[slot]);
                for (to, value) in self.rows[row].iter_mut().zip(values) {
                    to[lane] = value;
                }
            }
        });
    }

    /// Adds what was collected to the nodes, where anything was.
    #[inline(always)]
    pub(crate) fn give<S: Space, B: Basis, T>(&self, window: &Window, nodes: &mut [T], add: impl Fn(&mut T, [f64; N])) {
        let Some(base) = self.base else { return };
        window.rows::<S, B>(base, |row, slots| {
            for (lane, &slot) in slots[..B::WIDTH].iter().enumerate() {
                let mut values = [0.0; N];
                for (value, from) in values.iter_mut().zip(&self.rows[row]) {
                    *value = from[lane];
                }
                add(&mut nodes[slot], values);
            }
        });
    }
}
