//! Tree of bounding boxes around triangles, for searches near a position.

use nalgebra::Vector3;

/// Largest number of triangles in a leaf.
const LEAF: usize = 4;

/// Node of the tree, with the bounding box of a range of triangles.
#[derive(Clone, Debug)]
struct Node {
    low: Vector3<f64>,
    high: Vector3<f64>,
    /// Index in `order` of the first triangle.
    from: u32,
    /// Index in `order` after the last triangle.
    to: u32,
    /// Index of the second child; zero for a leaf. The first child follows its parent.
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

    /// Visits the triangles of all leaves whose bounding box lies within a radius of a position (m). `visit` returns
    /// the radius (m). It is also called with `None` at each node, so that a nearest-neighbour search can reduce the
    /// radius.
    pub(super) fn near(&self, place: Vector3<f64>, mut visit: impl FnMut(Option<u32>) -> f64) {
        let mut at = 0;
        // Nodes are visited in order. The descendants of a distant node are skipped.
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

    /// Returns the index of the node that follows the last descendant of a node.
    fn after(&self, at: usize) -> usize {
        let mut last = at;
        while self.nodes[last].second != 0 {
            last = self.nodes[last].second as usize;
        }
        last + 1
    }
}
