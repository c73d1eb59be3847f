//! The nodes that reach a run of points, row by row: where their field keeps them, or copied where a period cuts
//! through them.

use crate::basis::Basis;
use crate::grid::Window;
use grainbench_scene::space::Space;
use std::ops::Range;

/// Nodes that reach a point, at most.
const MOST: usize = 27;

/// Nodes that a period cuts apart, side by side.
pub(crate) type Copies<T> = [T; MOST];

/// Where the nodes that reach a point are: the first one, and how far it is to the next row and the next layer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    first: usize,
    row: usize,
    layer: usize,
}

impl Patch {
    /// Where copies are.
    const COPIES: Self = Self { first: 0, row: 3, layer: 9 };

    /// How many rows along x reach a point.
    pub(crate) const fn rows<S: Space, B: Basis>() -> usize {
        if S::DIMENSION == 3 { B::WIDTH * B::WIDTH } else { B::WIDTH }
    }

    /// The places of a row of nodes.
    #[inline(always)]
    pub(crate) fn row<S: Space, B: Basis>(&self, row: usize) -> Range<usize> {
        let (j, k) = if S::DIMENSION == 3 { (row % B::WIDTH, row / B::WIDTH) } else { (row, 0) };
        let start = self.first + j * self.row + k * self.layer;
        start..start + B::WIDTH
    }
}

impl Window {
    /// The nodes that reach a point, of which `base` is the first, to be read.
    #[inline(always)]
    pub(crate) fn seen<'a, S: Space, B: Basis, T: Copy>(
        &self,
        base: [i32; 3],
        nodes: &'a [T],
        copies: &'a mut Copies<T>,
    ) -> (&'a [T], Patch) {
        match self.patch::<S, B>(base) {
            Some(patch) => (nodes, patch),
            None => {
                self.copy::<S, B, T>(base, nodes, copies);
                (copies, Patch::COPIES)
            }
        }
    }

    /// The same, to be changed and then put back.
    #[inline(always)]
    pub(crate) fn reached<'a, S: Space, B: Basis, T: Copy>(
        &self,
        base: [i32; 3],
        nodes: &'a mut [T],
        copies: &'a mut Copies<T>,
    ) -> (&'a mut [T], Patch) {
        match self.patch::<S, B>(base) {
            Some(patch) => (nodes, patch),
            None => {
                self.copy::<S, B, T>(base, nodes, copies);
                (copies, Patch::COPIES)
            }
        }
    }

    /// Puts copies of nodes back, where they are.
    #[inline(always)]
    pub(crate) fn put_back<S: Space, B: Basis, T: Copy>(&self, base: [i32; 3], nodes: &mut [T], copies: &Copies<T>) {
        if self.patch::<S, B>(base).is_none() {
            self.paste::<S, B, T>(base, nodes, copies);
        }
    }

    /// Where the nodes are, unless a period cuts through them.
    #[inline(always)]
    fn patch<S: Space, B: Basis>(&self, base: [i32; 3]) -> Option<Patch> {
        let [length, rows, _] = self.size.map(|size| size as usize);
        let [x, y, z] = [self.along(0, base[0]), self.along(1, base[1]), self.along(2, base[2])];
        let cut = |axis: usize, first: usize| self.whole[axis] && first + B::WIDTH > self.size[axis] as usize;
        if cut(0, x) || cut(1, y) || (S::DIMENSION == 3 && cut(2, z)) {
            return None;
        }
        Some(Patch { first: self.start + (z * rows + y) * length + x, row: length, layer: length * rows })
    }

    /// The places of the nodes and of their copies, one by one.
    fn places<S: Space, B: Basis>(&self, base: [i32; 3]) -> impl Iterator<Item = (usize, usize)> {
        let depth = if S::DIMENSION == 3 { B::WIDTH } else { 1 };
        (0..depth * B::WIDTH * B::WIDTH).map(move |number| {
            let of = [number % B::WIDTH, number / B::WIDTH % B::WIDTH, number / (B::WIDTH * B::WIDTH)];
            let node = [0, 1, 2].map(|axis| base[axis] + of[axis] as i32);
            (self.slot(node), of[0] + Patch::COPIES.row * of[1] + Patch::COPIES.layer * of[2])
        })
    }

    #[cold]
    fn copy<S: Space, B: Basis, T: Copy>(&self, base: [i32; 3], nodes: &[T], copies: &mut Copies<T>) {
        self.places::<S, B>(base).for_each(|(slot, copy)| copies[copy] = nodes[slot]);
    }

    #[cold]
    fn paste<S: Space, B: Basis, T: Copy>(&self, base: [i32; 3], nodes: &mut [T], copies: &Copies<T>) {
        self.places::<S, B>(base).for_each(|(slot, copy)| nodes[slot] = copies[copy]);
    }
}
