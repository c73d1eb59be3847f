//! Difference of one column between two outputs, accumulated over all samples.

use crate::read::digits::Digits;

/// Difference of one column between two outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Name of the column.
    pub name: String,
    /// Value of the first output at the largest difference. The largest difference is found after subtraction of the
    /// uncertainty of printed digits.
    pub first: f64,
    /// Value of the second output at the largest difference.
    pub second: f64,
    /// Reference magnitude of the column in the first output. For a coordinate that changes, it is the largest change
    /// since the first sample. Otherwise it is the largest magnitude of the column.
    ///
    /// If this magnitude is zero, the second output is used; if both are zero, the scale is 1.
    pub scale: f64,
    /// Uncertainty of the largest difference. It contains half a unit of the last printed digit in each output, and the
    /// interpolation error of the second output.
    pub open: f64,
    /// Difference at each sample.
    pub course: Vec<Sample>,
}

/// Difference of a column at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Step, time (s) or row number of the sample.
    pub at: f64,
    /// Largest absolute difference of all rows of the sample.
    pub off: f64,
    /// Largest absolute difference after subtraction of the uncertainty of printed digits.
    pub beyond_digits: f64,
}

/// Printed digits of a column in a file.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PrintedDigits {
    pub(super) digits: Digits,
    pub(super) of_file: Digits,
    /// Box length by which a scaled coordinate is multiplied; `None` for other columns.
    pub(super) scale: Option<f64>,
}

impl PrintedDigits {
    /// Returns half a unit of the last printed digit of `value`, in the unit of the column.
    fn half_unit(&self, value: f64) -> f64 {
        match self.scale {
            Some(scale) => scale * self.digits.half_unit(1.0, &self.of_file),
            None => self.digits.half_unit(value, &self.of_file),
        }
    }
}

/// Column whose difference is accumulated.
pub(super) struct Column {
    difference: Difference,
    printed: [PrintedDigits; 2],
    is_coordinate: bool,
    starts: [Vec<f64>; 2],
    /// Largest magnitude of the column in each output.
    magnitudes: [f64; 2],
    changes: [f64; 2],
    worst: f64,
}

impl Column {
    pub(super) fn new(name: &str, printed: [PrintedDigits; 2]) -> Self {
        let (first, second, name) = (f64::NAN, f64::NAN, name.to_owned());
        let is_coordinate = ["x", "y", "z"].contains(&name.as_str());
        let difference = Difference { name, first, second, scale: 0.0, open: 0.0, course: Vec::new() };
        let (magnitudes, changes, worst) = ([0.0; 2], [0.0; 2], f64::NEG_INFINITY);
        Self { difference, printed, is_coordinate, starts: Default::default(), magnitudes, changes, worst }
    }

    /// Adds the values of all rows of both outputs at one step, time (s) or row number.
    pub(super) fn take(&mut self, at: f64, values: [&[f64]; 2]) {
        for (which, values) in values.into_iter().enumerate() {
            if self.starts[which].is_empty() {
                self.starts[which] = values.to_vec();
            }
            for (value, start) in values.iter().zip(&self.starts[which]) {
                self.magnitudes[which] = self.magnitudes[which].max(value.abs());
                self.changes[which] = self.changes[which].max((value - start).abs());
            }
        }
        let mut sample = Sample { at, off: 0.0, beyond_digits: 0.0 };
        for (a, b) in values[0].iter().zip(values[1]) {
            let open = self.printed[0].half_unit(*a) + self.printed[1].half_unit(*b);
            let off = (b - a).abs();
            let off = if off.is_nan() { f64::INFINITY } else { off };
            sample.off = sample.off.max(off);
            sample.beyond_digits = sample.beyond_digits.max(off - open);
            if off - open > self.worst {
                self.worst = off - open;
                (self.difference.first, self.difference.second, self.difference.open) = (*a, *b, open);
            }
        }
        self.difference.course.push(sample);
    }

    /// Returns the difference. The interpolation error `interpolated` is added to the uncertainty of the difference.
    pub(super) fn finish(mut self, interpolated: f64) -> Difference {
        let column_extent = |which: usize| {
            let change = self.changes[which];
            if self.is_coordinate && change > 0.0 { change } else { self.magnitudes[which] }
        };
        let extents = [column_extent(0), column_extent(1)];
        let extent = extents.into_iter().find(|extent| *extent > 0.0);
        self.difference.scale = extent.unwrap_or(1.0);
        // If all printed numbers and formats are equal, the uncertainty is zero even if few digits are printed.
        let [a, b] = self.printed;
        let is_alike = a.digits == b.digits && a.scale == b.scale && interpolated == 0.0;
        let is_equal = extent.is_none() || is_alike && self.difference.course.iter().all(|sample| sample.off == 0.0);
        self.difference.open = if is_equal { 0.0 } else { self.difference.open + interpolated };
        self.difference
    }
}
