//! Series of snapshots as granular elements on one grid, and means over time and space.

use crate::column::{COLUMNS, Column, Grains};
use crate::contact_stress::{Stress, lacks_walls, tells_interval};
use crate::element::{Element, elements_moving, interpolated, mean_grain};
use crate::grid::Grid;
pub use crate::mask::Frame;
use crate::mask::Masks;
use crate::motion::{motion, movers, movers_between};
use crate::trails::Trails;
use grainbench_harness::statistics::interval;
use grainbench_scene::dimension::Dimension;
use grainbench_solver::record::Snapshot;
use nalgebra::Vector3;
use serde::Serialize;
use std::iter::Sum;
use std::ops::Div;

/// A series of snapshots as granular elements.
#[derive(Clone, Debug)]
pub struct Course {
    /// Grid of cells.
    pub grid: Grid,
    /// Dimension of space; in two dimensions grains are discs.
    pub space: Dimension,
    /// Mean diameter and density of the grains, and plane in which angles between axes are measured.
    pub grains: Grains,
    /// Masks that exclude elements from means.
    pub masks: Masks,
    /// Frames in order of time.
    pub frames: Vec<Frame>,
    /// True if velocities are displacements between snapshots divided by the time between them. False if they are
    /// instantaneous.
    pub between: bool,
    /// Tracers, if requested.
    pub trails: Option<Trails>,
    /// Kind of stress of the elements. `None` selects the time average between frames if a snapshot contains it, and the
    /// instantaneous stress otherwise.
    pub stress: Option<Stress>,
    before: Option<Snapshot>,
}

impl Course {
    /// Returns an empty series.
    #[must_use]
    pub fn new(grid: Grid, space: Dimension, plane: [usize; 2], masks: Masks, between: bool) -> Self {
        Self {
            grid,
            space,
            grains: Grains { mean: None, plane },
            masks,
            frames: Vec::new(),
            between,
            trails: None,
            stress: None,
            before: None,
        }
    }

    /// Adds a snapshot. If velocities come from displacements between snapshots, the first snapshot adds no frame.
    pub fn add(&mut self, snapshot: Snapshot) {
        self.grains.mean =
            self.grains.mean.or_else(|| mean_grain(&snapshot, self.space)).filter(|grain| grain.1.is_finite());
        if self.stress.is_none() && tells_interval(&snapshot) {
            self.stress = Some(Stress::Interval);
            // All frames must have the same kind of stress. The time average of the stress in earlier frames is
            // unknown, so the stress in these frames becomes `None`.
            self.frames.iter_mut().flat_map(|frame| &mut frame.elements).for_each(|element| element.stress = None);
        }
        let movers = match &self.before {
            Some(before) if self.between => movers_between(before, &snapshot),
            None if self.between => {
                self.before = Some(snapshot);
                return;
            }
            _ => movers(&snapshot),
        };
        let motion = motion(&movers, self.space.count(), &self.grid);
        let elements = elements_moving(&snapshot, motion, self.stress.unwrap_or_default(), self.space, &self.grid);
        let inside: usize = elements.iter().map(|element| element.motion.members).sum();
        let all = if snapshot.points.is_empty() { snapshot.grains.len() } else { snapshot.points.len() };
        let masked = self.masks.apply_with(&elements, &self.grid, lacks_walls(&snapshot));
        let outside = all.saturating_sub(inside);
        if let Some(trails) = &mut self.trails {
            trails.go_on(&self.frames, &snapshot, &self.grid, self.space.count());
        }
        self.frames.push(Frame { step: snapshot.step, time: snapshot.time, elements, masked, outside });
        if self.between {
            self.before = Some(snapshot);
        }
    }

    /// Returns the value of a quantity in a cell of a frame; `None` if it is unknown or not finite.
    #[must_use]
    pub fn value(&self, column: &Column, frame: &Frame, cell: usize) -> Option<f64> {
        (column.of)(&frame.elements[cell], &self.grains).filter(|value| value.is_finite())
    }

    /// Returns a quantity at a position in a frame, interpolated linearly between the centres of cells with a value.
    #[must_use]
    pub fn value_at(&self, column: &Column, frame: &Frame, place: Vector3<f64>) -> Option<f64> {
        interpolated(&self.grid, self.masks.periodic, place, |cell| self.value(column, frame, cell))
    }

    /// Returns the time average of a quantity in a cell over the frames with a value, with its confidence interval.
    #[must_use]
    pub fn mean_in(&self, column: &Column, cell: usize, blocks: usize) -> Option<Mean> {
        let values: Vec<f64> = self.frames.iter().filter_map(|frame| self.value(column, frame, cell)).collect();
        mean(&values, blocks)
    }

    /// Returns the mean of a quantity over all unmasked elements with a value, and the number of these elements.
    ///
    /// The confidence interval is computed from blocks of frames.
    #[must_use]
    pub fn mean_over(&self, column: &Column, blocks: usize) -> Option<(Mean, usize)> {
        let (mut means, mut sum, mut count) = (Vec::new(), 0.0, 0);
        for frame in &self.frames {
            let cell_value = |cell: usize| self.value(column, frame, cell).filter(|_| !frame.masked[cell].any());
            let values: Vec<f64> = (0..frame.elements.len()).filter_map(cell_value).collect();
            if !values.is_empty() {
                let total: f64 = values.iter().sum();
                means.push(total / values.len() as f64);
                (sum, count) = (sum + total, count + values.len());
            }
        }
        // The mean weights all elements equally, whatever the number of elements in their frame.
        mean(&means, blocks).map(|found| (Mean { value: sum / count as f64, ..found }, count))
    }

    /// Returns the element with the time averages of stress, velocity, velocity gradient and packing fraction of a
    /// cell. Other quantities can then be computed from these averages. Returns `None` if the cell was always empty.
    #[must_use]
    pub fn element_of_means(&self, cell: usize) -> Option<Element> {
        let all = || self.frames.iter().map(|frame| frame.elements[cell]);
        let mut element = all().next()?;
        element.packing_fraction = mean_of(all().map(|element| element.packing_fraction))?;
        element.stress = mean_of(all().filter_map(|element| element.stress));
        element.motion.gradient = mean_of(all().filter_map(|element| element.motion.gradient));
        element.motion.velocity = mean_of(all().filter_map(|element| element.motion.velocity));
        element.motion.residual = None;
        element.motion.members = all().map(|element| element.motion.members).sum();
        (element.motion.members > 0).then_some(element)
    }
}

fn mean_of<T: Sum + Div<f64, Output = T>>(values: impl Iterator<Item = T>) -> Option<T> {
    let values: Vec<T> = values.collect();
    let count = values.len();
    (count > 0).then(|| values.into_iter().sum::<T>() / count as f64)
}

/// Returns the quantities that are nonlinear functions of stress and velocity gradient. Reports also give the values of
/// these quantities for the time averages of both tensors.
pub fn of_means() -> impl Iterator<Item = &'static Column> {
    const NAMES: [&str; 7] = [
        "sine_of_friction",
        "drucker_prager",
        "shear_rate",
        "inertial_number",
        "angle_of_largest",
        "angle_of_smallest",
        "turn_in_plane",
    ];
    COLUMNS.iter().filter(|column| NAMES.contains(&column.name))
}

/// A mean with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// Mean of all values.
    pub value: f64,
    /// Half width of the confidence interval with the confidence level [`grainbench_harness::statistics::CONFIDENCE`];
    /// `None` for fewer than two blocks.
    pub half_width: Option<f64>,
    /// Number of blocks.
    pub blocks: usize,
}

/// Returns the mean of a time series, with its confidence interval from the means of `blocks` equal blocks.
///
/// Neighbouring frames are correlated, but blocks longer than the correlation time are independent. If the blocks do
/// not cover the whole series, the first values count only for the mean. Returns `None` for an empty series.
#[must_use]
pub fn mean(values: &[f64], blocks: usize) -> Option<Mean> {
    let average = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let blocks = blocks.clamp(1, values.len());
    let length = values.len() / blocks;
    let means: Vec<f64> = values[values.len() - length * blocks..].chunks(length).map(average).collect();
    Some(Mean { value: average(values), half_width: interval(&means).map(|(_, half_width)| half_width), blocks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_that_of_the_blocks() {
        // The blocks have the means 1, 2, 3 and 4, so their standard deviation is s = √(5/3). Student's t for 3 degrees of
        // freedom at 99 % is 5.840909.
        let values = [0.5, 1.5, 2.0, 2.0, 3.0, 3.0, 4.5, 3.5];
        let found = mean(&values, 4).unwrap();
        assert!((found.value - 2.5).abs() < 1e-15 && found.blocks == 4);
        assert!((found.half_width.unwrap() - 5.840_909 * (5.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-5);
        assert_eq!(mean(&[], 4), None);
        assert_eq!(mean(&[2.0], 4), Some(Mean { value: 2.0, half_width: None, blocks: 1 }));
    }
}
