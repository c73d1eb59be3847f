//! Elements in short: what they are of, what was left out, and means over all that were not.

use grainbench_fields::average::Mean;
use grainbench_fields::column::{COLUMNS, Column};
use grainbench_fields::course::Course;
use grainbench_harness::statistics::CONFIDENCE;
use serde::Serialize;

/// Elements in short.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What they are of.
    pub source: String,
    /// Number of frames, and the times of the first and the last (s).
    pub frames: usize,
    /// Time of the first frame (s).
    pub from: f64,
    /// Time of the last frame (s).
    pub to: f64,
    /// Cells along each axis.
    pub cells: [usize; 3],
    /// Size of a cell (m).
    pub cell: [f64; 3],
    /// Lower corner of the grid (m).
    pub low: [f64; 3],
    /// Which velocities these are.
    pub velocity: &'static str,
    /// Whether there is stress: without contacts there is none.
    pub stress: bool,
    /// Which stress it is.
    pub which_stress: &'static str,
    /// What is left out of the means.
    pub masks: String,
    /// Elements that are left out, of all frames, and how many there are.
    pub left_out: [usize; 2],
    /// Grains or points whose centre is in no cell, the most of a frame.
    pub outside: usize,
    /// Mean diameter (m) and density (kg/m³; kg/m² of discs) that inertial numbers are found with.
    pub grain: Option<(f64, f64)>,
    /// Blocks of frames that intervals are from, and what part of such intervals holds the mean.
    pub blocks: usize,
    /// What part of such intervals holds the mean.
    pub confidence: f64,
    /// Means over all elements that are not left out.
    pub means: Vec<Over>,
}

/// The mean of a quantity over elements.
#[derive(Clone, Debug, Serialize)]
pub struct Over {
    /// The quantity, by its column.
    pub quantity: &'static str,
    /// What it is, in words.
    pub words: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The mean.
    #[serde(flatten)]
    pub mean: Mean,
    /// Number of elements.
    pub elements: usize,
}

impl Summary {
    /// Of a course that has frames.
    #[must_use]
    pub fn of(course: &Course, source: String, blocks: usize) -> Self {
        let over = |column: &Column| {
            let (mean, elements) = course.mean_over(column, blocks)?;
            Some(Over { quantity: column.name, words: column.words, unit: column.unit, mean, elements })
        };
        let masked = || course.frames.iter().flat_map(|frame| &frame.masked);
        let time = |at: Option<&grainbench_fields::course::Frame>| at.map_or(f64::NAN, |frame| frame.time);
        Self {
            source,
            frames: course.frames.len(),
            from: time(course.frames.first()),
            to: time(course.frames.last()),
            cells: course.grid.count,
            cell: course.grid.cell.into(),
            low: course.grid.low.into(),
            velocity: if course.between { "velocities between frames" } else { "velocities of the instant" },
            stress: course.frames.iter().any(|frame| frame.elements.iter().any(|element| element.stress.is_some())),
            which_stress: course.stress.unwrap_or_default().words(),
            masks: course.masks.words(),
            left_out: [masked().filter(|masked| masked.any()).count(), masked().count()],
            outside: course.frames.iter().map(|frame| frame.outside).max().unwrap_or(0),
            grain: course.grains.mean,
            blocks,
            confidence: CONFIDENCE,
            means: COLUMNS.iter().filter_map(over).collect(),
        }
    }

    /// In a sentence or two.
    #[must_use]
    pub fn words(&self) -> String {
        let [x, y, z] = self.cells;
        let [left_out, all] = self.left_out;
        let (which, none) = if self.stress {
            (format!(", {}", self.which_stress), "")
        } else {
            (String::new(), " No contacts were told: there is no stress.")
        };
        let outside = match self.outside {
            0 => String::new(),
            count => format!(" Up to {count} grains or points of a frame are in no cell."),
        };
        format!(
            "{} frames of {x} × {y} × {z} cells, {}{which}; means {} ({left_out} of {all} elements left out).{none}{outside}",
            self.frames, self.velocity, self.masks
        )
    }
}
