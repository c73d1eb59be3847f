//! Trails of tracers through a course: what an element goes through on its way, in place of what goes through a cell.

use crate::course::Frame;
use crate::grid::Grid;
use crate::tracers::{Tracer, hencky, tracers};
use grainbench_scene::record::Snapshot;
use nalgebra::Vector3;

/// Tracers on their way, and where they have been.
#[derive(Clone, Debug)]
pub struct Trails {
    /// Cells in whose middles tracers begin, and whose grains are labelled.
    pub boxes: Grid,
    tracers: Vec<Tracer>,
    /// Where they were, frame after frame.
    pub stops: Vec<Stop>,
}

/// A tracer at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Number of the tracer, from 0.
    pub tracer: usize,
    /// Place of the frame in the course.
    pub frame: usize,
    /// Where it is (m).
    pub position: Vector3<f64>,
    /// |E| of Hencky's strain since the start; none where too few of the labelled grains are left.
    pub strain: Option<f64>,
}

impl Trails {
    /// Of tracers that begin in the middles of these cells.
    #[must_use]
    pub const fn new(boxes: Grid) -> Self {
        Self { boxes, tracers: Vec::new(), stops: Vec::new() }
    }

    /// Goes on from the frames so far to a snapshot, by the mean velocities of the last of them. A tracer that nothing moves any
    /// more, for no grains are around it, ends there.
    pub(crate) fn go_on(&mut self, frames: &[Frame], snapshot: &Snapshot, grid: &Grid, dimension: usize) {
        match frames.last() {
            None => self.tracers = tracers(snapshot, &self.boxes),
            Some(before) => {
                let elapsed = snapshot.time - before.time;
                for tracer in self.tracers.iter_mut().filter(|tracer| !tracer.is_lost()) {
                    tracer.carry(&before.elements, grid, snapshot.periodic, elapsed);
                }
            }
        }
        for (tracer, of) in self.tracers.iter().enumerate().filter(|(_, of)| !of.is_lost()) {
            let deformation = of.deformation(snapshot, dimension);
            let strain = deformation.and_then(|deformation| hencky(&deformation)).map(|strain| strain.norm());
            self.stops.push(Stop { tracer, frame: frames.len(), position: of.position, strain });
        }
    }
}
