//! How a number is read of a record: at a moment, over the samples, or at every one of them.

use super::claims_file::Over;
use super::expression::Expression;
use super::numbers::{Numbers, TIME};
use super::{Wrong, wrong};
use grainbench_harness::claim::{Expecting, Quantity};
use grainbench_harness::course::Points;
use grainbench_harness::run::{Done, Missing};
use grainbench_harness::source::Source;
use std::sync::Arc;

/// Reads time and value of samples.
type Samples = Arc<dyn Fn(&Done) -> Result<Points, Missing> + Send + Sync>;

/// How a number is read of a record.
pub struct Read {
    /// Over columns and numbers of the scene.
    pub value: Expression,
    /// Those numbers.
    pub numbers: Arc<Numbers>,
    /// At this moment (s),
    pub at: Option<f64>,
    /// or over the samples; else in the end.
    pub over: Option<Over>,
}

impl Read {
    /// Time and value of every sample.
    fn all(&self, done: &Done) -> Result<Points, Missing> {
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
        if points.is_empty() { Err(Missing("sample".to_owned())) } else { Ok(points) }
    }

    /// Its time and one value.
    ///
    /// # Errors
    /// When the record has no such column.
    pub fn one(&self, done: &Done) -> Result<(f64, f64), Missing> {
        let points = self.all(done)?;
        let end = points[points.len() - 1];
        let values = || points.iter().map(|point| point.1);
        // What is not a number anywhere is none in the whole.
        let extreme = |better: fn(f64, f64) -> bool| {
            values().reduce(|best, value| if value.is_nan() || better(value, best) { value } else { best })
        };
        let value = match self.over {
            Some(Over::Max) => extreme(|value, best| value > best),
            Some(Over::Min) => extreme(|value, best| value < best),
            Some(Over::Mean) => Some(mean(&points)),
            Some(Over::Course) | None => None,
        };
        match (value, self.at) {
            (Some(_), _) if values().any(f64::is_nan) => Ok((end.0, f64::NAN)),
            (Some(value), _) => Ok((end.0, value)),
            (None, None) => Ok(end),
            (None, Some(moment)) => {
                // A sample is at the moment where none could be nearer.
                let apart = points.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max);
                let nearest =
                    points.iter().copied().min_by(|a, b| (a.0 - moment).abs().total_cmp(&(b.0 - moment).abs()));
                let nearest = nearest.filter(|point| (point.0 - moment).abs() <= 0.5 * apart * (1.0 + 1e-9));
                nearest.ok_or_else(|| Missing(format!("sample at {moment} s")))
            }
        }
    }

    /// As a bound wants it.
    pub(super) fn bounded(self) -> Result<impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static, Wrong> {
        if self.over == Some(Over::Course) {
            return Err(wrong("over", "`max`, `min` or `mean` with a bound", "`course`"));
        }
        Ok(move |done: &[Done]| Ok(self.one(&done[0])?.1))
    }

    /// Every sample, or those between two times.
    pub(super) fn samples(self, within: Option<[f64; 2]>) -> Samples {
        Arc::new(move |done| {
            let mut points = self.all(done)?;
            let [first, last] = within.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            points.retain(|(t, _)| (first..=last).contains(t));
            if points.is_empty() { Err(Missing(format!("sample from {first} to {last} s"))) } else { Ok(points) }
        })
    }
}

/// Every sample against a course, in units of the scale or of the largest that is expected.
pub(super) fn follow(
    quantity: Quantity,
    source: Source,
    samples: Samples,
    exact: impl Fn(f64) -> f64 + Clone + Send + Sync + 'static,
    scale: Option<f64>,
) -> Expecting {
    let (again, expected) = (Arc::clone(&samples), exact.clone());
    let largest = move |points: Points| points.iter().map(|(t, _)| expected(*t).abs()).fold(0.0, f64::max);
    let scale = move |done: &Done| scale.unwrap_or_else(|| again(done).map_or(f64::NAN, &largest));
    quantity.series(move |done| samples(done)).follows(source, move |_, t| exact(t), scale)
}

/// The mean over the time of the samples, which need not stand equally far apart: on straight lines between them.
fn mean(points: &Points) -> f64 {
    let [(first, value), .., (last, _)] = points.as_slice() else { return points[0].1 };
    let sum: f64 = points.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum();
    if last > first { sum / (last - first) } else { *value }
}

/// Between the points of a course, on a straight line.
pub(super) fn interpolated(course: &Points, t: f64) -> f64 {
    let after = course.partition_point(|point| point.0 < t).clamp(1, course.len() - 1);
    let ((t0, low), (t1, high)) = (course[after - 1], course[after]);
    low + (high - low) * (t - t0) / (t1 - t0)
}
