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

    /// A place after all nodes that reach a point, of which `base` is the first: the end of a row.
    pub(crate) fn end_of<S: Space, B: Basis>(&self, base: [i32; 3]) -> usize {
        let slowest = S::DIMENSION - 1;
        let layer = self.len() / self.size[slowest] as usize;
        let end = self.along(slowest, base[slowest]) + B::WIDTH;
        self.start + layer * end.min(self.size[slowest] as usize)
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
}

/// Nodes that follow each other in whole rows, which a thread adds to.
pub(crate) struct Summed<'a, T> {
    /// Place of the first among those of all fields.
    first: usize,
    nodes: &'a mut [T],
}

impl<'a, T: Copy> Summed<'a, T> {
    /// These nodes, the first of which has this place.
    pub(crate) const fn new(first: usize, nodes: &'a mut [T]) -> Self {
        Self { first, nodes }
    }

    /// The same, for a while.
    pub(crate) fn lent(&mut self) -> Summed<'_, T> {
        Summed { first: self.first, nodes: self.nodes }
    }

    /// A row of them, if it is one of these.
    #[inline(always)]
    pub(crate) fn row(&mut self, row: Range<usize>) -> Option<&mut [T]> {
        let start = row.start.wrapping_sub(self.first);
        self.nodes.get_mut(start..start.wrapping_add(row.end - row.start))
    }

    /// Those nodes among them that reach a point, of which `base` is the first, to be added to and then put back; none where
    /// no node that reaches it is among them.
    #[inline(always)]
    pub(crate) fn reached<'b, S: Space, B: Basis>(
        &'b mut self,
        window: &Window,
        base: [i32; 3],
        copies: &'b mut Copies<T>,
    ) -> Option<(Summed<'b, T>, Patch)> {
        match window.patch::<S, B>(base) {
            Some(patch) => {
                let last = patch.row::<S, B>(Patch::rows::<S, B>() - 1).end;
                let is_reached = last > self.first && patch.first < self.first + self.nodes.len();
                is_reached.then_some((Summed { first: self.first, nodes: self.nodes }, patch))
            }
            None => {
                self.copy::<S, B>(window, base, copies);
                Some((Summed { first: 0, nodes: copies }, Patch::COPIES))
            }
        }
    }

    /// Puts copies of nodes back, where they are.
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
