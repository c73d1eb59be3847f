//! Time series of the ball. A table has one column of heights (m) for each code and bed, `CODE_ICn`, and the time `t`
//! (s).

use super::spread::Spread;
use crate::read::read_error::{ReadError, quoted};
use crate::read::table::Table;

/// Gravity (m/s²) and initial velocity of the ball (m/s).
pub(super) const GRAVITY: f64 = 9.81;
pub(super) const RELEASED: f64 = -5.0;

/// Time series of the ball for one code and one bed.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Name of the code.
    pub code: String,
    /// Number of the bed, from 1.
    pub bed: usize,
    /// Heights (m).
    pub heights: Vec<f64>,
}

/// All time series of one table.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Times (s), without repetitions.
    pub times: Vec<f64>,
    /// Time series in the order of the columns.
    pub courses: Vec<Course>,
    /// Number of skipped rows that repeat the time of the row before.
    pub repeated: usize,
}

impl Impact {
    /// Reads a table whose first column is the time.
    pub(super) fn from_table(table: &Table, file: &str) -> Result<Self, ReadError> {
        let mut times: Vec<f64> = Vec::new();
        let mut kept = Vec::new();
        for (row, time) in table.values(0).enumerate() {
            if times.last().is_some_and(|&last| time < last) {
                let expected = format!("times that do not fall, in row {} below the names", row + 1);
                return Err(ReadError::at(file, row as u64 + 2, expected, format!("{time}")));
            }
            if times.last().is_none_or(|&last| time > last) {
                times.push(time);
                kept.push(row);
            }
        }
        let mut courses = Vec::new();
        for (place, column) in table.columns.iter().enumerate().skip(1) {
            let named = column.name.rsplit_once("_IC").and_then(|(code, bed)| Some((code, bed.parse().ok()?)));
            let Some((code, bed)) = named.filter(|&(code, bed)| !code.is_empty() && (1..1000).contains(&bed)) else {
                let expected = "columns CODE_ICn of a code and the number of its bed";
                return Err(ReadError::at(file, 1, expected, quoted(&column.name)));
            };
            let all: Vec<f64> = table.values(place).collect();
            let heights = kept.iter().map(|&row| all[row]).collect();
            courses.push(Course { code: code.to_owned(), bed, heights });
        }
        Ok(Self { repeated: table.rows() - times.len(), times, courses })
    }

    /// Returns the height at a time (m), interpolated linearly between samples. Returns `None` beyond the samples.
    #[must_use]
    pub fn height(&self, course: &Course, time: f64) -> Option<f64> {
        let after = self.times.partition_point(|&sampled| sampled < time - 1e-9);
        let (next, there) = (*self.times.get(after)?, *course.heights.get(after)?);
        if (next - time).abs() < 1e-9 {
            return Some(there);
        }
        let before = after.checked_sub(1)?;
        let part = (time - self.times[before]) / (next - self.times[before]);
        Some(course.heights[before] + part * (there - course.heights[before]))
    }

    /// Returns the height above free flight with an initial velocity of −5 m/s at a time (m).
    pub(super) fn held_up(&self, course: &Course, time: f64) -> Option<f64> {
        const START: f64 = 0.06;
        Some(self.height(course, time)? - (START + RELEASED * time - 0.5 * GRAVITY * time * time))
    }

    /// Returns the clock error of the first sample (s). It is positive if the ball has already fallen in this sample.
    #[must_use]
    pub fn ahead(&self, course: &Course) -> f64 {
        let fallen = self.times.first().and_then(|&first| self.held_up(course, first));
        fallen.map_or(0.0, |up| up / RELEASED)
    }

    /// Returns the mean velocity between two times (m/s).
    #[must_use]
    pub fn velocity(&self, course: &Course, [from, to]: [f64; 2]) -> Option<f64> {
        Some((self.height(course, to)? - self.height(course, from)?) / (to - from))
    }

    /// Returns the lowest position (m).
    #[must_use]
    pub fn deepest(course: &Course) -> f64 {
        course.heights.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Returns the mean and the standard deviations of a quantity over those time series for which `kept` returns
    /// true.
    pub fn spread(
        &self,
        kept: impl Fn(&Course) -> bool,
        value: impl Fn(&Self, &Course) -> Option<f64>,
    ) -> Option<Spread> {
        let kept: Vec<&Course> = self.courses.iter().filter(|course| kept(course)).collect();
        let values: Option<Vec<(&str, f64)>> =
            kept.iter().map(|course| Some((course.code.as_str(), value(self, course)?))).collect();
        Spread::from_values(values?)
    }
}
