//! One column of two outputs in the making of its difference.

use crate::read::digits::Digits;

/// How one column of the second output differs from that of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The column.
    pub name: String,
    /// Value of the first where they differ most beyond their printed digits.
    pub first: f64,
    /// Value of the second there.
    pub second: f64,
    /// The largest change of a coordinate, the largest magnitude of anything else: of the first output, or of the second
    /// where the first is zero throughout. One where both are.
    pub scale: f64,
    /// How far the printed digits of both there, and interpolation between samples of the second, may have moved the
    /// difference.
    pub open: f64,
    /// Sample by sample.
    pub course: Vec<Sample>,
}

/// The difference of a column at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Step, time (s) or row.
    pub at: f64,
    /// The largest difference of a row.
    pub off: f64,
    /// The largest part of a difference that printed digits do not explain.
    pub beyond_digits: f64,
}

/// With which digits a file prints a column.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Printed {
    pub(super) digits: Digits,
    pub(super) of_file: Digits,
    /// The box length that a scaled coordinate is multiplied by.
    pub(super) scale: Option<f64>,
}

impl Printed {
    /// Half a unit of the last printed place of a value.
    fn half_unit(&self, value: f64) -> f64 {
        match self.scale {
            Some(scale) => scale * self.digits.half_unit(1.0, &self.of_file),
            None => self.digits.half_unit(value, &self.of_file),
        }
    }
}

/// A column in the making.
pub(super) struct Column {
    difference: Difference,
    printed: [Printed; 2],
    is_coordinate: bool,
    starts: [Vec<f64>; 2],
    /// The largest magnitude in each.
    magnitudes: [f64; 2],
    changes: [f64; 2],
    worst: f64,
}

impl Column {
    pub(super) fn new(name: &str, printed: [Printed; 2]) -> Self {
        let (first, second, name) = (f64::NAN, f64::NAN, name.to_owned());
        let is_coordinate = ["x", "y", "z"].contains(&name.as_str());
        let difference = Difference { name, first, second, scale: 0.0, open: 0.0, course: Vec::new() };
        let (magnitudes, changes, worst) = ([0.0; 2], [0.0; 2], f64::NEG_INFINITY);
        Self { difference, printed, is_coordinate, starts: Default::default(), magnitudes, changes, worst }
    }

    /// Takes all rows at one place: a step, a time (s) or a row.
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

    /// The difference, with what interpolation leaves open beside the digits.
    pub(super) fn finish(mut self, interpolated: f64) -> Difference {
        let of = |which: usize| {
            let change = self.changes[which];
            if self.is_coordinate && change > 0.0 { change } else { self.magnitudes[which] }
        };
        let extents = [of(0), of(1)];
        // Zeros throughout are the same, however few digits they have.
        let extent = extents.into_iter().find(|extent| *extent > 0.0);
        self.difference.scale = extent.unwrap_or(1.0);
        self.difference.open = extent.map_or(0.0, |_| self.difference.open + interpolated);
        self.difference
    }
}
