//! Stencil blocks. A block contains the nodes that influence a particle batch, in rows along x. It is used in place in
//! the node array, or copied if a periodic boundary cuts through it.

use crate::grid::basis::Basis;
use crate::grid::lattice::Window;
use grainbench_solver::space::Space;
use std::ops::Range;

/// Maximum number of nodes that influence a point.
const MOST: usize = 27;

/// Contiguous copies of nodes that a periodic boundary separates.
pub(crate) type Copies<T> = [T; MOST];

/// Position of a stencil block in the node array: its first node, and the strides to the next row and layer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StencilBlock {
    first: usize,
    row: usize,
    layer: usize,
}

impl StencilBlock {
    /// Position of the block in an array of copies.
    const COPIES: Self = Self { first: 0, row: 3, layer: 9 };

    /// Returns the number of rows along x.
    pub(crate) const fn rows<S: Space, B: Basis>() -> usize {
        if S::DIMENSION == 3 { B::WIDTH * B::WIDTH } else { B::WIDTH }
    }

    /// Returns the range of a row of nodes in the array of the block.
    #[inline(always)]
    pub(crate) fn row<S: Space, B: Basis>(&self, row: usize) -> Range<usize> {
        let (j, k) = if S::DIMENSION == 3 { (row % B::WIDTH, row / B::WIDTH) } else { (row, 0) };
        let start = self.first + j * self.row + k * self.layer;
        start..start + B::WIDTH
    }
}

impl Window {
    /// Returns an array for reading, and the position of the block with first node `base` in this array. The array is
    /// the node array, or an array of copies.
    #[inline(always)]
    pub(crate) fn seen<'a, S: Space, B: Basis, T: Copy>(
        &self,
        base: [i32; 3],
        nodes: &'a [T],
        copies: &'a mut Copies<T>,
    ) -> (&'a [T], StencilBlock) {
        match self.patch::<S, B>(base) {
            Some(patch) => (nodes, patch),
            None => {
                self.copy::<S, B, T>(base, nodes, copies);
                (copies, StencilBlock::COPIES)
            }
        }
    }

    /// Returns a slot after all nodes of the block with first node `base`. It is the end of a row, in three dimensions of
    /// a layer.
    pub(crate) fn end_of<S: Space, B: Basis>(&self, base: [i32; 3]) -> usize {
        let slowest = S::DIMENSION - 1;
        let layer = self.len() / self.size[slowest] as usize;
        let end = self.along(slowest, base[slowest]) + B::WIDTH;
        self.start + layer * end.min(self.size[slowest] as usize)
    }

    /// Returns the position of the block with first node `base`, or `None` if a periodic boundary cuts through it.
    #[inline(always)]
    fn patch<S: Space, B: Basis>(&self, base: [i32; 3]) -> Option<StencilBlock> {
        let [length, rows, _] = self.size.map(|size| size as usize);
        let [x, y, z] = [self.along(0, base[0]), self.along(1, base[1]), self.along(2, base[2])];
        let cut = |axis: usize, first: usize| self.whole[axis] && first + B::WIDTH > self.size[axis] as usize;
        if cut(0, x) || cut(1, y) || (S::DIMENSION == 3 && cut(2, z)) {
            return None;
        }
        Some(StencilBlock { first: self.start + (z * rows + y) * length + x, row: length, layer: length * rows })
    }

    /// Iterates over the nodes of a block, with the slot of each node and the index of its copy.
    fn places<S: Space, B: Basis>(&self, base: [i32; 3]) -> impl Iterator<Item = (usize, usize)> {
        let depth = if S::DIMENSION == 3 { B::WIDTH } else { 1 };
        (0..depth * B::WIDTH * B::WIDTH).map(move |number| {
            let offsets = [number % B::WIDTH, number / B::WIDTH % B::WIDTH, number / (B::WIDTH * B::WIDTH)];
            let node = [0, 1, 2].map(|axis| base[axis] + offsets[axis] as i32);
            (
                self.slot(node),
                offsets[0] + StencilBlock::COPIES.row * offsets[1] + StencilBlock::COPIES.layer * offsets[2],
            )
        })
    }

    #[cold]
    fn copy<S: Space, B: Basis, T: Copy>(&self, base: [i32; 3], nodes: &[T], copies: &mut Copies<T>) {
        self.places::<S, B>(base).for_each(|(slot, copy)| copies[copy] = nodes[slot]);
    }
}

/// Mutable view of consecutive nodes in whole rows, to which one thread adds.
pub(crate) struct NodeRows<'a, T> {
    /// Slot of the first node in the common node array.
    first: usize,
    nodes: &'a mut [T],
}

impl<'a, T: Copy> NodeRows<'a, T> {
    /// Creates the view of nodes that start at slot `first`.
    pub(crate) const fn new(first: usize, nodes: &'a mut [T]) -> Self {
        Self { first, nodes }
    }

    /// Returns a row, if the view contains it.
    #[inline(always)]
    pub(crate) fn row(&mut self, row: Range<usize>) -> Option<&mut [T]> {
        let start = row.start.wrapping_sub(self.first);
        self.nodes.get_mut(start..start.wrapping_add(row.end - row.start))
    }

    /// Returns the view to which contributions to the block with first node `base` are added, and the position of the
    /// block in this view. Returns `None` if the view contains no node of the block. [`NodeRows::put_back`] must be
    /// called after the additions.
    #[inline(always)]
    pub(crate) fn reached<'b, S: Space, B: Basis>(
        &'b mut self,
        window: &Window,
        base: [i32; 3],
        copies: &'b mut Copies<T>,
    ) -> Option<(NodeRows<'b, T>, StencilBlock)> {
        match window.patch::<S, B>(base) {
            Some(patch) => {
                let last = patch.row::<S, B>(StencilBlock::rows::<S, B>() - 1).end;
                let is_reached = last > self.first && patch.first < self.first + self.nodes.len();
                is_reached.then_some((NodeRows { first: self.first, nodes: self.nodes }, patch))
            }
            None => {
                self.copy::<S, B>(window, base, copies);
                Some((NodeRows { first: 0, nodes: copies }, StencilBlock::COPIES))
            }
        }
    }

    /// Writes copied nodes back to their slots.
    #[inline(always)]
    pub(crate) fn put_back<S: Space, B: Basis>(&mut self, window: &Window, base: [i32; 3], copies: &Copies<T>) {
        if window.patch::<S, B>(base).is_none() {
            self.paste::<S, B>(window, base, copies);
        }
    }

    #[cold]
    fn copy<S: Space, B: Basis>(&self, window: &Window, base: [i32; 3], copies: &mut Copies<T>) {
        for (slot, copy) in window.places::<S, B>(base) {
            if let Some(&node) = self.nodes.get(slot.wrapping_sub(self.first)) {
                copies[copy] = node;
            }
        }
    }

    #[cold]
    fn paste<S: Space, B: Basis>(&mut self, window: &Window, base: [i32; 3], copies: &Copies<T>) {
        for (slot, copy) in window.places::<S, B>(base) {
            if let Some(node) = self.nodes.get_mut(slot.wrapping_sub(self.first)) {
                *node = copies[copy];
            }
        }
    }
}
