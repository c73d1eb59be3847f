//! Which bodies may touch.

use crate::bodies::Body;
use crate::grid::Lattice;
use grainbench_scene::space::Space;
use nalgebra::Vector3;

/// Two bodies whose boxes meet. The tracers of the first are held against the surface of the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<S: Space> {
    pub(crate) first: u32,
    pub(crate) second: u32,
    /// From the second body to its image next to the first (m): whole periods.
    pub(crate) shift: S::Vector,
}

/// Finds pairs by sorting bodies along an axis.
#[derive(Clone, Debug)]
pub(crate) struct Pairs<S: Space> {
    order: Vec<u32>,
    /// Each pair twice, once in each order.
    pub(crate) found: Vec<Pair<S>>,
}

impl<S: Space> Pairs<S> {
    pub(crate) const fn new() -> Self {
        Self { order: Vec::new(), found: Vec::new() }
    }

    /// All pairs whose boxes are closer than `margin` (m).
    pub(crate) fn find(&mut self, bodies: &[Body], lattice: &Lattice, margin: f64) {
        self.found.clear();
        if self.order.len() != bodies.len() {
            self.order = (0..bodies.len() as u32).collect();
        }
        // Sorting helps along an axis on which nothing comes again.
        let axis = (0..S::DIMENSION).find(|&axis| lattice.period[axis].is_none());
        if let Some(axis) = axis {
            let low = |body: u32| bodies[body as usize].bounds[0][axis];
            self.order.sort_by(|&a, &b| low(a).total_cmp(&low(b)).then(a.cmp(&b)));
        }
        for (at, &a) in self.order.iter().enumerate() {
            let bounds = &bodies[a as usize].bounds;
            for &b in &self.order[at + 1..] {
                let others = &bodies[b as usize].bounds;
                if axis.is_some_and(|axis| others[0][axis] > bounds[1][axis] + margin) {
                    break;
                }
                let shift = shift(lattice, bounds, others);
                let apart = (0..S::DIMENSION).any(|axis| {
                    others[0][axis] + shift[axis] > bounds[1][axis] + margin
                        || bounds[0][axis] > others[1][axis] + shift[axis] + margin
                });
                if !apart {
                    let (first, second) = (a.min(b), a.max(b));
                    let shift = S::restrict(if first == a { shift } else { -shift });
                    self.found.push(Pair { first, second, shift });
                }
            }
        }
        self.found.sort_by_key(|pair| (pair.first, pair.second));
    }
}

/// Whole periods that bring the middle of the second box next to that of the first.
fn shift(lattice: &Lattice, first: &[Vector3<f64>; 2], second: &[Vector3<f64>; 2]) -> Vector3<f64> {
    let mut shift = Vector3::zeros();
    for axis in 0..3 {
        if let Some(period) = lattice.period[axis] {
            let length = f64::from(period) * lattice.cell[axis];
            let between = 0.5 * (first[0][axis] + first[1][axis] - second[0][axis] - second[1][axis]);
            shift[axis] = length * (between / length).round();
        }
    }
    shift
}

impl<S: Space> Pair<S> {
    /// The same pair with the bodies exchanged.
    pub(crate) fn exchanged(&self) -> Self {
        Self { first: self.second, second: self.first, shift: -self.shift }
    }
}
