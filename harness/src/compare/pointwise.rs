//! Comparison of two runs sample by sample.

use crate::expect::Measurement;
use crate::run::{FinishedRun, MissingData};

/// Returns the values of a column in two runs at the steps of the second run. A stored run contains only some of the steps.
///
/// # Errors
/// When a run lacks the column, or the first run lacks a step of the second.
pub fn together(first: &FinishedRun, second: &FinishedRun, column: &str) -> Result<(Vec<f64>, Vec<f64>), MissingData> {
    let of_second = second.column(column)?.to_vec();
    let steps = &second.series().step;
    Ok((steps.iter().map(|&step| first.at_step(column, step)).collect::<Result<_, _>>()?, of_second))
}

/// Returns the largest difference between our run (first) and the run of another program (second) in the given columns.
///
/// The error is the difference divided by `scale`.
///
/// # Errors
/// When a run lacks a column, or our run lacks a step of the other program's run.
pub fn worst(done: &[FinishedRun], columns: &[&str], scale: f64) -> Result<Measurement, MissingData> {
    let [ours, theirs, ..] = done else { return Err(MissingData("second run to compare with".to_owned())) };
    Measurement::worst_read(columns.iter().map(|column| {
        let (values, expected) = together(ours, theirs, column)?;
        Ok(Measurement::worst_of(&theirs.series().time, &values, &expected, scale))
    }))
}

/// Returns the difference of a column between two runs: time (s) and |difference| divided by the largest value of the
/// second run. Samples with equal values are left out. The list is empty if [`together`] fails.
#[must_use]
pub fn difference(first: &FinishedRun, second: &FinishedRun, column: &str) -> Vec<(f64, f64)> {
    let Ok((a, b)) = together(first, second, column) else { return Vec::new() };
    let largest = largest(&b);
    let parted = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / largest);
    second.series().time.iter().copied().zip(parted).filter(|(_, off)| *off > 0.0).collect()
}

/// Returns the largest |value|.
#[must_use]
pub fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}
