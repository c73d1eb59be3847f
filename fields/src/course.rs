//! A course of snapshots as granular elements on one grid, and means over it.

use crate::average::{Mean, mean};
use crate::column::{COLUMNS, Column, Grains};
use crate::contact_stress::{Stress, tells_interval};
use crate::element::{Element, elements_moving, interpolated, mean_grain};
use crate::grid::Grid;
use crate::mask::{Masked, Masks};
use crate::motion::{motion, movers, movers_between};
use crate::trails::Trails;
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::Dimension;
use nalgebra::{Matrix3, Vector3};

/// The elements of one snapshot.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Step.
    pub step: u64,
    /// Time (s); not a number where nobody told it.
    pub time: f64,
    /// The elements, in the order of [`Grid::place`].
    pub elements: Vec<Element>,
    /// Why each of them is left out of means, if it is.
    pub masked: Vec<Masked>,
    /// Grains or points whose centre is in no cell.
    pub outside: usize,
}

impl Frame {
    /// Where it stands on the clock: its time (s), or its step where nobody told that.
    #[must_use]
    pub fn clock(&self) -> f64 {
        if self.time.is_finite() { self.time } else { self.step as f64 }
    }
}

/// A course of snapshots as granular elements.
#[derive(Clone, Debug)]
pub struct Course {
    /// The cells.
    pub grid: Grid,
    /// The plane, where grains are discs to whoever looks, or space.
    pub space: Dimension,
    /// What quantities are found with.
    pub grains: Grains,
    /// What is left out of means.
    pub masks: Masks,
    /// The frames, in order of time.
    pub frames: Vec<Frame>,
    /// Whether velocities are those between a snapshot and the one before it, rather than those of the instant.
    pub between: bool,
    /// Tracers, where they are asked for.
    pub trails: Option<Trails>,
    /// Which stress elements have; where nobody asks, the mean over the time between frames if it is told.
    pub stress: Option<Stress>,
    before: Option<Snapshot>,
}

impl Course {
    /// Of no snapshots yet.
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

    /// Adds a snapshot. Between snapshots there are velocities from the second on: the first then adds no frame.
    pub fn add(&mut self, snapshot: Snapshot) {
        self.grains.mean = self.grains.mean.or_else(|| mean_grain(&snapshot, self.space)).filter(|of| of.1.is_finite());
        if self.stress.is_none() && tells_interval(&snapshot) {
            self.stress = Some(Stress::Interval);
            // One stress or the other: of frames before it the mean is not known.
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
        let masked = self.masks.of(&elements, &self.grid);
        let outside = all.saturating_sub(inside);
        if let Some(trails) = &mut self.trails {
            trails.go_on(&self.frames, &snapshot, &self.grid, self.space.count());
        }
        self.frames.push(Frame { step: snapshot.step, time: snapshot.time, elements, masked, outside });
        if self.between {
            self.before = Some(snapshot);
        }
    }

    /// The value of a quantity in a cell of a frame.
    #[must_use]
    pub fn value(&self, column: &Column, frame: &Frame, cell: usize) -> Option<f64> {
        (column.of)(&frame.elements[cell], &self.grains).filter(|value| value.is_finite())
    }

    /// A quantity at a place of a frame, linear between the middles of the cells around that have it.
    #[must_use]
    pub fn value_at(&self, column: &Column, frame: &Frame, place: Vector3<f64>) -> Option<f64> {
        interpolated(&self.grid, self.masks.periodic, place, |cell| self.value(column, frame, cell))
    }

    /// Mean of a quantity over time in a cell, of frames that have it, with its interval.
    #[must_use]
    pub fn mean_in(&self, column: &Column, cell: usize, blocks: usize) -> Option<Mean> {
        let values: Vec<f64> = self.frames.iter().filter_map(|frame| self.value(column, frame, cell)).collect();
        mean(&values, blocks)
    }

    /// Mean of a quantity over the elements that no mask leaves out, with its interval from blocks of frames; and how many
    /// elements it is of.
    #[must_use]
    pub fn mean_over(&self, column: &Column, blocks: usize) -> Option<(Mean, usize)> {
        let (mut means, mut sum, mut count) = (Vec::new(), 0.0, 0);
        for frame in &self.frames {
            let of = |cell: usize| self.value(column, frame, cell).filter(|_| !frame.masked[cell].any());
            let values: Vec<f64> = (0..frame.elements.len()).filter_map(of).collect();
            if !values.is_empty() {
                let total: f64 = values.iter().sum();
                means.push(total / values.len() as f64);
                (sum, count) = (sum + total, count + values.len());
            }
        }
        // Every element counts as much as any other; frames of few elements do not weigh more.
        mean(&means, blocks).map(|found| (Mean { value: sum / count as f64, ..found }, count))
    }

    /// The element of the mean tensors of a cell: stress, velocity and its gradient are averaged before anything is found from
    /// them. None of a cell in which nothing ever was.
    #[must_use]
    pub fn element_of_means(&self, cell: usize) -> Option<Element> {
        let all = || self.frames.iter().map(|frame| frame.elements[cell]);
        let first = all().next()?;
        let matrices = |of: fn(&Element) -> Option<Matrix3<f64>>| {
            let found: Vec<Matrix3<f64>> = all().filter_map(|element| of(&element)).collect();
            (!found.is_empty()).then(|| found.iter().sum::<Matrix3<f64>>() / found.len() as f64)
        };
        let velocities: Vec<Vector3<f64>> = all().filter_map(|element| element.motion.velocity).collect();
        let mut element = first;
        element.packing_fraction =
            all().map(|element| element.packing_fraction).sum::<f64>() / self.frames.len() as f64;
        element.stress = matrices(|element| element.stress);
        element.motion.gradient = matrices(|element| element.motion.gradient);
        element.motion.velocity =
            (!velocities.is_empty()).then(|| velocities.iter().sum::<Vector3<f64>>() / velocities.len() as f64);
        element.motion.residual = None;
        element.motion.members = all().map(|element| element.motion.members).sum();
        (element.motion.members > 0).then_some(element)
    }
}

/// Quantities that are not linear in what is averaged: they are told of the mean tensors too.
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
