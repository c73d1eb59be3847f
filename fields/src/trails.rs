//! Tracer trajectories through a series of snapshots. They give quantities along the path of an element instead of in a
//! fixed cell.

use crate::frame::Frame;
use crate::grid::Grid;
use crate::tracers::{Tracer, hencky, tracers};
use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;

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
