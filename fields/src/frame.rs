//! Elements of one snapshot.

use crate::element::Element;
use crate::mask::MaskReasons;

/// Elements of one snapshot.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Step number of the frame.
    pub step: u64,
    /// Time (s); NaN if unknown.
    pub time: f64,
    /// Elements in the order of [`crate::grid::Grid::place`].
    pub elements: Vec<Element>,
    /// For each element, the reasons for its exclusion from means, if any.
    pub masked: Vec<MaskReasons>,
    /// Number of grains or points whose centre is in no cell.
    pub outside: usize,
}

impl Frame {
    /// Returns the time (s), or the step if the time is unknown.
    #[must_use]
    pub fn clock(&self) -> f64 {
        if self.time.is_finite() { self.time } else { self.step as f64 }
    }
}
