//! Summary of granular elements: source, masks, and averages over all elements that are not left out.

use grainbench_fields::column::{COLUMNS, Column};
use grainbench_fields::course::{Course, Frame, Mean};
use grainbench_harness::statistics::CONFIDENCE;
use serde::Serialize;

/// Summary of granular elements.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Directory or file from which the elements were computed.
    pub source: String,
    /// Number of frames.
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
    /// Description of the velocities: instantaneous, or from displacements.
    pub velocity: &'static str,
    /// True if the stress is known. Stress needs recorded contacts.
    pub stress: bool,
    /// Definition of the stress.
    pub which_stress: &'static str,
    /// Rules by which elements are left out of averages, in words.
    pub masks: String,
    /// Number of elements that are left out of averages, and number of all elements, each summed over all frames.
    pub left_out: [usize; 2],
    /// Number of grains or material points whose centre is in no cell, in the frame with the most of them.
    pub outside: usize,
    /// Mean diameter (m) and mean density (kg/m³; kg/m² for discs) for inertial numbers.
    pub grain: Option<(f64, f64)>,
    /// Number of time blocks from which the confidence intervals are computed.
    pub blocks: usize,
    /// Confidence level of the intervals.
    pub confidence: f64,
    /// Averages over all elements that are not left out.
    pub means: Vec<ElementMean>,
}

/// Average of a quantity over elements.
#[derive(Clone, Debug, Serialize)]
pub struct ElementMean {
    /// Column name of the quantity.
    pub quantity: &'static str,
    /// Quantity in words.
    pub words: &'static str,
    /// Unit of the quantity; `1` for a pure number.
    pub unit: &'static str,
    /// Average with its confidence interval.
    #[serde(flatten)]
    pub mean: Mean,
    /// Number of averaged elements.
    pub elements: usize,
}

impl Summary {
    /// Returns the summary of a series of frames. Without frames, the times are NaN.
    #[must_use]
    pub fn new(course: &Course, source: String, blocks: usize) -> Self {
        let over = |column: &Column| {
            let (mean, elements) = course.mean_over(column, blocks)?;
            Some(ElementMean { quantity: column.name, words: column.words, unit: column.unit, mean, elements })
        };
        let masked = || course.frames.iter().flat_map(|frame| &frame.masked);
        let time = |at: Option<&Frame>| at.map_or(f64::NAN, |frame| frame.time);
        Self {
            source,
            frames: course.frames.len(),
            from: time(course.frames.first()),
            to: time(course.frames.last()),
            cells: course.grid.count,
            cell: course.grid.cell.into(),
            low: course.grid.low.into(),
            velocity: if course.between { "velocities between frames" } else { "instantaneous velocities" },
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

    /// Returns the summary in one or two sentences.
    #[must_use]
    pub fn words(&self) -> String {
        let [x, y, z] = self.cells;
        let [left_out, all] = self.left_out;
        let (which, none) = if self.stress {
            (format!(", {}", self.which_stress), "")
        } else {
            (String::new(), " No contacts were recorded, so there is no stress.")
        };
        let outside = match self.outside {
            0 => String::new(),
            count => format!(" Up to {count} grains or points of a frame are in no cell."),
        };
        format!(
            "{} frames of {x} × {y} × {z} cells, {}{which}; means {} ({left_out} of {all} elements \
             omitted).{none}{outside}",
            self.frames, self.velocity, self.masks
        )
    }
}
