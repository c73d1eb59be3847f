//! One column of two outputs in the making of its difference.

/// How one column of the second output differs from that of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The column.
    pub name: String,
    /// What the first has where they differ most.
    pub first: f64,
    /// What the second has there.
    pub second: f64,
    /// The largest change of a coordinate, the largest magnitude of anything else: of the first output, or of the second
    /// where the first is zero throughout. One where both are.
    pub scale: f64,
    /// How far the printed digits of both, and interpolation between samples of the second, may have moved the
    /// difference.
    pub open: f64,
    /// Step, time (s) or row, and largest difference there.
    pub course: Vec<(f64, f64)>,
}

/// A column in the making.
pub(super) struct Column {
    pub(super) difference: Difference,
    is_coordinate: bool,
    starts: [Vec<f64>; 2],
    /// The largest magnitude in each.
    pub(super) magnitudes: [f64; 2],
    changes: [f64; 2],
}

impl Column {
    pub(super) fn new(name: &str) -> Self {
        let (first, second, name) = (f64::NAN, f64::NAN, name.to_owned());
        let is_coordinate = ["x", "y", "z"].contains(&name.as_str());
        let difference = Difference { name, first, second, scale: 0.0, open: 0.0, course: Vec::new() };
        Self { difference, is_coordinate, starts: Default::default(), magnitudes: [0.0; 2], changes: [0.0; 2] }
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
        let mut largest = 0.0_f64;
        for (a, b) in values[0].iter().zip(values[1]) {
            let off = (b - a).abs();
            largest = if off.is_nan() { f64::INFINITY } else { largest.max(off) };
            let worst = (self.difference.second - self.difference.first).abs();
            if self.difference.first.is_nan() || off.is_nan() || off > worst {
                (self.difference.first, self.difference.second) = (*a, *b);
            }
        }
        self.difference.course.push((at, largest));
    }

    pub(super) fn finish(mut self, open: f64) -> Difference {
        let of = |which: usize| {
            let change = self.changes[which];
            if self.is_coordinate && change > 0.0 { change } else { self.magnitudes[which] }
        };
        let extents = [of(0), of(1)];
        // Zeros throughout are the same, however few digits they have.
        let extent = extents.into_iter().find(|extent| *extent > 0.0);
        self.difference.scale = extent.unwrap_or(1.0);
        self.difference.open = extent.map_or(0.0, |_| open);
        self.difference
    }
}
