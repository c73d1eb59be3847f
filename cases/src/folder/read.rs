//! Evaluation of an expression on a record: at one time, reduced over the samples, or at each sample.

use super::claims_file::SampleReduction;
use super::expression::Expression;
use super::numbers::{Numbers, TIME};
use super::wrong;
use grainbench_harness::prelude::*;

/// Function that returns time (s) and value of each sample of a run.
type Samples = Arc<dyn Fn(&FinishedRun) -> Result<Points, MissingData> + Send + Sync>;

/// Expression that is evaluated on a record.
pub struct RecordExpression {
    /// Expression over columns of the record and numbers of the scene.
    pub value: Expression,
    /// Numbers of the scene.
    pub numbers: Arc<Numbers>,
    /// Time (s) of the evaluation; the end of the run if `at` and `over` are both absent.
    pub at: Option<f64>,
    /// Reduction over the samples.
    pub over: Option<SampleReduction>,
    /// True if the expected value belongs to the time of the sample. Otherwise it belongs to `at`.
    pub follows_time: bool,
}

impl RecordExpression {
    /// Returns time (s) and value of each sample.
    fn all(&self, done: &FinishedRun) -> Result<Points, MissingData> {
        let series = done.series();
        for name in self.value.names() {
            if self.numbers.is_of_record(name) {
                done.column(name)?;
            }
        }
        let at = |place: usize, t: f64| {
            self.value.value(&|name| match (name, series.column(name)) {
                (TIME, _) => Some(t),
                (_, Some(column)) => column.get(place).copied(),
                (_, None) => self.numbers.get(name),
            })
        };
        let points: Points = series.time.iter().enumerate().map(|(place, &t)| (t, at(place, t))).collect();
        if points.is_empty() { Err("sample".into()) } else { Ok(points) }
    }

    /// Returns the time (s) and the value of the expression. The time of a reduction is the end of the run.
    ///
    /// # Errors
    /// When the record lacks a column, has no samples, or has no sample near the time `at`.
    pub fn one(&self, done: &FinishedRun) -> Result<(f64, f64), MissingData> {
        let points = self.all(done)?;
        let end = points[points.len() - 1];
        let values = || points.iter().map(|point| point.1);
        // NaN in any sample gives NaN.
        let extreme = |better: fn(f64, f64) -> bool| {
            values().reduce(|best, value| if value.is_nan() || better(value, best) { value } else { best })
        };
        let value = match self.over {
            Some(SampleReduction::Max) => extreme(|value, best| value > best),
            Some(SampleReduction::Min) => extreme(|value, best| value < best),
            Some(SampleReduction::Mean) => Some(mean(&points)),
            Some(SampleReduction::Course) | None => None,
        };
        match (value, self.at) {
            (Some(_), _) if values().any(f64::is_nan) => Ok((end.0, f64::NAN)),
            (Some(value), _) => Ok((end.0, value)),
            (None, None) => Ok(end),
            (None, Some(moment)) => {
                // Half the largest sampling interval, or a time step if the expected value belongs to `moment`.
                let apart = points.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max);
                let nearest =
                    points.iter().copied().min_by(|a, b| (a.0 - moment).abs().total_cmp(&(b.0 - moment).abs()));
                let most =
                    if self.follows_time { 0.5 * apart } else { done.record.provenance.time_step.min(0.5 * apart) };
                let nearest = nearest.filter(|point| (point.0 - moment).abs() <= most * (1.0 + 1e-9));
                nearest.ok_or_else(|| MissingData(format!("sample within {most} s of {moment} s")))
            }
        }
    }

    /// Returns a function that reads the value from finished runs, for a claim with a bound.
    pub(super) fn bounded(self) -> Result<impl RunsReader<f64>, String> {
        if self.over == Some(SampleReduction::Course) {
            return Err(wrong("over", "`max`, `min` or `mean` with a bound", "`course`"));
        }
        Ok(move |done: &[FinishedRun]| Ok(self.one(&done[0])?.1))
    }

    /// Returns a function that reads the samples between two times (s).
    pub(super) fn samples(self, [first, last]: [f64; 2]) -> Samples {
        Arc::new(move |done| {
            let mut points = self.all(done)?;
            points.retain(|(t, _)| (first..=last).contains(t));
            if points.is_empty() { Err(MissingData(format!("sample from {first} to {last} s"))) } else { Ok(points) }
        })
    }
}

/// Returns the expectation that each sample follows a curve. Errors are in units of the scale; without a scale, in
/// units of the largest expected value.
pub(super) fn follow(
    quantity: Quantity,
    source: Source,
    samples: Samples,
    exact: impl Fn(f64) -> f64 + Clone + Send + Sync + 'static,
    scale: Option<f64>,
) -> ClaimWithExpectation {
    let (again, expected) = (Arc::clone(&samples), exact.clone());
    let largest = move |points: Points| points.iter().map(|(t, _)| expected(*t).abs()).fold(0.0, f64::max);
    let scale = move |done: &FinishedRun| scale.unwrap_or_else(|| again(done).map_or(f64::NAN, &largest));
    quantity.follows(source, move |done| samples(done), move |_, t| exact(t), scale)
}

/// Returns the time average of samples at unequal intervals, by linear interpolation.
fn mean(points: &Points) -> f64 {
    let [(first, value), .., (last, _)] = points.as_slice() else { return points[0].1 };
    let sum: f64 = points.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum();
    if last > first { sum / (last - first) } else { *value }
}

/// Interpolates linearly between the points of a curve.
pub(super) fn interpolated(course: &Points, t: f64) -> f64 {
    let after = course.partition_point(|point| point.0 < t).clamp(1, course.len() - 1);
    let ((t0, low), (t1, high)) = (course[after - 1], course[after]);
    low + (high - low) * (t - t0) / (t1 - t0)
}
