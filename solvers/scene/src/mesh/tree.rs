//! Tree of bounding boxes around triangles, for searches near a position.

use nalgebra::Vector3;

/// Largest number of triangles in a leaf.
const LEAF: usize = 4;

/// Bounding box of triangles that are consecutive in the order of the tree.
#[derive(Clone, Debug)]
struct Node {
    low: Vector3<f64>,
    high: Vector3<f64>,
    /// Range in `order`.
    from: u32,
    to: u32,
    /// Second child; the first child follows its parent. Zero for a leaf.
    second: u32,
}

/// Hierarchy of bounding boxes around triangles.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    pub(super) fn new(triangles: &[[Vector3<f64>; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..triangles.len() as u32).collect() };
        tree.add(triangles, 0, triangles.len());
        tree
    }

    fn add(&mut self, triangles: &[[Vector3<f64>; 3]], from: usize, to: usize) {
        let start = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        let corners = self.order[from..to].iter().flat_map(|&number| &triangles[number as usize]);
        let (low, high) = corners.fold(start, |(low, high), corner| (low.inf(corner), high.sup(corner)));
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, from: from as u32, to: to as u32, second: 0 });
        if to - from <= LEAF {
            return;
        }
        let axis = (high - low).imax();
        let middle = |number: &u32| triangles[*number as usize].iter().map(|corner| corner[axis]).sum::<f64>();
        let half = (to - from) / 2;
        self.order[from..to]
            .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then_with(|| a.cmp(b)));
        self.add(triangles, from, from + half);
        self.nodes[at].second = self.nodes.len() as u32;
        self.add(triangles, from + half, to);
    }

    /// Visits the triangles of all leaves whose bounding box lies within a radius (m) of a position. The radius is read
    /// again at each node, by a visit without a triangle, so that a nearest-neighbour search can reduce it.
    pub(super) fn near(&self, place: Vector3<f64>, mut visit: impl FnMut(Option<u32>) -> f64) {
        let mut at = 0;
        // Nodes are visited in order; the children of a distant node are skipped.
        while let Some(node) = self.nodes.get(at) {
            let away = (node.low - place).sup(&(place - node.high)).sup(&Vector3::zeros());
            let is_leaf = node.second == 0;
            if away.norm() > visit(None) {
                at = self.after(at);
                continue;
            }
            if is_leaf {
                for &number in &self.order[node.from as usize..node.to as usize] {
                    visit(Some(number));
                }
            }
            at += 1;
        }
    }

    /// Returns the node after all descendants of a node.
    fn after(&self, at: usize) -> usize {
        let mut last = at;
        while self.nodes[last].second != 0 {
            last = self.nodes[last].second as usize;
        }
        last + 1
    }
}
