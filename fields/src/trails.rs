//! Tracers: elements that deform and move with the flow (Rycroft, Kamrin and Bazant 2009, §5), and their trajectories
//! through a series of snapshots. They give quantities along the path of an element instead of in a fixed cell.
//!
//! A tracer starts at the centre of a box of labelled grains. It moves with the mean velocity of the grains around it.
//! Its deformation is the best affine map from the initial to the current positions of the labelled grains:
//!
//! ```text
//! x = F x₀ + a                        least squares over the labelled grains that still exist
//! F = R U,   E = ln U,   |E| = √(E:E)  polar decomposition and Hencky's strain
//! ```

use crate::element::{Element, velocity_at};
use crate::grid::{Grid, inside, nearest_image};
use crate::mask::Frame;
use grainbench_solver::record::Snapshot;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Element that moves with the flow: its position and its labelled grains.
#[derive(Clone, Debug, PartialEq)]
pub struct Tracer {
    /// Current position (m).
    pub position: Vector3<f64>,
    /// Ids of the labelled grains with their initial positions (m).
    labelled: Vec<(u32, Vector3<f64>)>,
    /// True if the tracer has stopped because there were no grains around it.
    pub lost: bool,
}

/// Creates a tracer at the centre of each non-empty cell of a grid. The grains in the cell are its labelled grains.
#[must_use]
pub fn tracers(snapshot: &Snapshot, grid: &Grid) -> Vec<Tracer> {
    let mut labelled = vec![Vec::new(); grid.cells()];
    for grain in &snapshot.grains {
        let position = inside(snapshot, grain.position);
        if let Some(cell) = grid.find(position) {
            labelled[cell].push((grain.id, position));
        }
    }
    let tracer = |(cell, labelled)| Tracer { position: grid.middle(cell), labelled, lost: false };
    labelled.into_iter().enumerate().filter(|(_, labelled)| !labelled.is_empty()).map(tracer).collect()
}

impl Tracer {
    /// Moves the tracer for a time (s) with the mean velocities of `elements`, by the midpoint rule.
    ///
    /// The tracer is lost if there is no velocity at its position or at the midpoint of its path.
    pub fn carry(&mut self, elements: &[Element], grid: &Grid, periodic: [bool; 3], time: f64) {
        let at = |place: Vector3<f64>| velocity_at(elements, grid, periodic, place);
        let velocity = at(self.position).and_then(|first| at(self.position + first * (0.5 * time)));
        match velocity {
            Some(velocity) => self.position += velocity * time,
            None => self.lost = true,
        }
    }

    /// Returns the deformation gradient F of the labelled grains that still exist, or `None` if they are too few or
    /// coplanar (collinear in two dimensions).
    ///
    /// Across periodic sides, the displacement of each grain is that to the image nearest to its initial position.
    #[must_use]
    pub fn deformation(&self, snapshot: &Snapshot, dimension: usize) -> Option<Matrix3<f64>> {
        let moved = |&(id, before): &(u32, Vector3<f64>)| {
            Some((before, before + nearest_image(snapshot, snapshot.grain(id)?.position - before)))
        };
        let pairs: Vec<(Vector3<f64>, Vector3<f64>)> = self.labelled.iter().filter_map(moved).collect();
        if pairs.len() <= dimension {
            return None;
        }
        let count = pairs.len() as f64;
        let sum = pairs.iter().fold((Vector3::zeros(), Vector3::zeros()), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
        let (before, after): (Vector3<f64>, Vector3<f64>) = (sum.0 / count, sum.1 / count);
        let (mut spread, mut carried) = (Matrix3::zeros(), Matrix3::zeros());
        for &(from, to) in &pairs {
            spread += (from - before) * (from - before).transpose();
            carried += (to - after) * (from - before).transpose();
        }
        if dimension == 2 {
            (spread.m33, carried.m33) = (count, count);
        }
        let size: f64 = (0..dimension).map(|axis| spread[(axis, axis)]).product();
        let size = if dimension == 2 { size * count } else { size };
        if spread.determinant() <= 1e-9 * size {
            return None;
        }
        spread.try_inverse().map(|inverse| carried * inverse)
    }
}

/// Returns Hencky's strain E = ln U of F = R U, or `None` if det F is not positive.
#[must_use]
pub fn hencky(deformation: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    if deformation.determinant() <= 0.0 {
        return None;
    }
    let eigen = SymmetricEigen::new(deformation.transpose() * deformation);
    let logarithms = eigen.eigenvalues.map(|square| 0.5 * square.ln());
    Some(eigen.eigenvectors * Matrix3::from_diagonal(&logarithms) * eigen.eigenvectors.transpose())
}

/// Tracers with their past positions.
#[derive(Clone, Debug)]
pub struct Trails {
    /// Grid of the initial cells. The grains in each non-empty cell are the labelled grains of a tracer that starts at
    /// the centre of this cell.
    pub boxes: Grid,
    tracers: Vec<Tracer>,
    /// Past positions, frame by frame.
    pub stops: Vec<Stop>,
}

/// State of a tracer at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Index of the tracer, from 0.
    pub tracer: usize,
    /// Index of the frame in the series.
    pub frame: usize,
    /// Position (m).
    pub position: Vector3<f64>,
    /// Norm |E| of Hencky's strain since the start. `None` if the deformation is unknown, for example because too few
    /// labelled grains exist.
    pub strain: Option<f64>,
}

impl Trails {
    /// Creates trajectories of tracers that start at the centres of the cells of `boxes`.
    #[must_use]
    pub const fn new(boxes: Grid) -> Self {
        Self { boxes, tracers: Vec::new(), stops: Vec::new() }
    }

    /// Continues the trajectories to a snapshot, with the mean velocities of the last frame. If there is no frame yet,
    /// the tracers are created.
    ///
    /// The trajectory of a tracer ends if there are no grains around the tracer.
    pub(crate) fn go_on(&mut self, frames: &[Frame], snapshot: &Snapshot, grid: &Grid, dimension: usize) {
        match frames.last() {
            None => self.tracers = tracers(snapshot, &self.boxes),
            Some(before) => {
                let elapsed = snapshot.time - before.time;
                for tracer in self.tracers.iter_mut().filter(|tracer| !tracer.lost) {
                    tracer.carry(&before.elements, grid, snapshot.periodic, elapsed);
                }
            }
        }
        for (tracer, trail) in self.tracers.iter().enumerate().filter(|(_, trail)| !trail.lost) {
            let deformation = trail.deformation(snapshot, dimension);
            let strain = deformation.and_then(|deformation| hencky(&deformation)).map(|strain| strain.norm());
            self.stops.push(Stop { tracer, frame: frames.len(), position: trail.position, strain });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    fn size(deformation: Matrix3<f64>) -> f64 {
        hencky(&deformation).unwrap().norm()
    }

    #[test]
    fn strains_that_are_known() {
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.0).into_inner();
        for amount in [0.01, 0.3, 1.0_f64] {
            let stretch = Matrix3::from_diagonal(&Vector3::new(amount.exp(), 1.0, (-amount).exp()));
            assert!((size(turn * stretch) - 2.0_f64.sqrt() * amount).abs() < 1e-12);
        }
        for (shear, known) in [(0.5_f64, 0.349_97), (1.0, 0.680_54), (2.0, 1.246_45)] {
            let mut simple = Matrix3::identity();
            simple.m13 = shear;
            let exact = 2.0_f64.sqrt() * (0.5 * shear).asinh();
            assert!((size(turn * simple) - exact).abs() < 1e-12 && (exact - known).abs() < 1e-5);
        }
        assert!(size(turn) < 1e-12);
        assert_eq!(hencky(&-Matrix3::identity()), None);
    }
}
