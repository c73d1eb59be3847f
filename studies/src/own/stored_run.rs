//! Values and times of a finished run, as they are stored.

use crate::chaos::scale_of;
use grainbench_reports::number;
use grainbench_reports::study::point::PointStatus;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::{Column, Record};
use grainbench_solver::resolution::Resolution;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct StoredColumn {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) end: f64,
    pub(super) mean: f64,
    /// Mean over time of the absolute value.
    pub(super) mean_absolute: f64,
    /// Largest absolute value of the column.
    pub(super) largest: f64,
    /// Largest absolute value of the probe in this unit.
    pub(super) scale: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct StoredRun {
    pub(super) status: PointStatus,
    /// Time of the first run (s), start-up included.
    pub(super) seconds: f64,
    /// Times of the stepping loop (s).
    pub(super) walls: Vec<f64>,
    pub(super) steps: u64,
    pub(super) detail: Option<String>,
    pub(super) columns: Vec<StoredColumn>,
}

impl StoredRun {
    /// Returns a column; none if the run has no column with this name.
    pub(super) fn column(&self, name: &str) -> Option<&StoredColumn> {
        self.columns.iter().find(|column| column.name == name)
    }
}

/// Returns the time of the stepping loop (s), or the time of the whole run if the program does not report it.
pub(super) fn wall_seconds(record: &Record, whole: f64) -> f64 {
    Some(record.cost.wall_seconds).filter(|wall| wall.is_finite() && *wall > 0.0).unwrap_or(whole)
}

/// Returns the finite columns of a record. Means over a window of time (s), or over the whole run, are weighted by the time
/// between samples.
pub(super) fn columns(record: &Record, window: Option<(f64, f64)>) -> Vec<StoredColumn> {
    let (from, to) = window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let series = &record.series;
    let column = |(at, column): (usize, &Column)| {
        let values = series.values.get(at)?;
        let (first, last) = (series.time.first()?.max(from), series.time.last()?.min(to));
        let mean = |part: fn(f64) -> f64| {
            let areas = series.time.windows(2).zip(values.windows(2)).map(|(t, v)| {
                let [begin, end] = [t[0].max(first).min(t[1]), t[1].min(last).max(t[0])];
                let value =
                    |time: f64| v[0] + (v[1] - v[0]) * if t[1] > t[0] { (time - t[0]) / (t[1] - t[0]) } else { 0.0 };
                0.5 * (end - begin).max(0.0) * (part(value(begin)) + part(value(end)))
            });
            if last > first {
                areas.sum::<f64>() / (last - first)
            } else if window.is_some() {
                f64::NAN
            } else {
                values.first().map_or(f64::NAN, |v| part(*v))
            }
        };
        let (mean, mean_absolute) = (mean(|value| value), mean(f64::abs));
        let stored = StoredColumn {
            name: column.name.clone(),
            unit: column.unit.clone(),
            end: *values.last()?,
            mean,
            mean_absolute,
            largest: values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())),
            scale: scale_of(record, at),
        };
        (values.iter().all(|value| value.is_finite()) && mean.is_finite()).then_some(stored)
    };
    series.columns.iter().enumerate().filter_map(column).collect()
}

/// Returns the status and the message of a run that did not end.
pub(super) fn failure(
    error: &RunError,
    completed: Option<f64>,
    seconds: f64,
    resolution: &Resolution,
) -> (PointStatus, Option<String>) {
    let status = match error {
        RunError::Unsupported { .. } => PointStatus::Unsupported,
        RunError::NotAvailable { .. } => PointStatus::NotAvailable,
        RunError::Interrupted { .. } => {
            let whole = completed.map(|fraction| number::seconds(seconds / fraction));
            let whole = whole.map_or_else(String::new, |whole| format!(": the whole run takes about {whole}"));
            let detail = format!("the run at {resolution} was ended after {}{whole}", number::seconds(seconds));
            return (PointStatus::OverBudget, Some(detail));
        }
        _ => PointStatus::Failed,
    };
    (status, Some(error.to_string()))
}
