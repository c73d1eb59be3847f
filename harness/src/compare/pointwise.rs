//! Two runs sample by sample.

use crate::expect::Measured;
use crate::run::{Done, Missing};

/// A column of two runs at the steps of the second, of which a stored run keeps only some.
///
/// # Errors
/// When the column is missing, or a step of the second in the first.
pub fn together(first: &Done, second: &Done, column: &str) -> Result<(Vec<f64>, Vec<f64>), Missing> {
    let of_second = second.column(column)?.to_vec();
    let steps = &second.series().step;
    Ok((steps.iter().map(|&step| first.at_step(column, step)).collect::<Result<_, _>>()?, of_second))
}

/// The worst difference in some columns between ours (first) and what another program gave (second), in units of
/// `scale`.
///
/// # Errors
/// When a column is missing, or a sample of the program in ours.
pub fn worst(done: &[Done], columns: &[&str], scale: f64) -> Result<Measured, Missing> {
    let [ours, theirs, ..] = done else { return Err(Missing("second run to compare with".to_owned())) };
    let found: Result<Vec<Measured>, Missing> = columns
        .iter()
        .map(|column| {
            let (values, expected) = together(ours, theirs, column)?;
            Ok(Measured::worst_of(&theirs.series().time, &values, &expected, scale))
        })
        .collect();
    Measured::worst_among(found?).ok_or_else(|| Missing("columns to compare".to_owned()))
}

/// Time (s) and |difference| of a column, over its largest value in the second run, where they differ.
#[must_use]
pub fn difference(first: &Done, second: &Done, column: &str) -> Vec<(f64, f64)> {
    let Ok((a, b)) = together(first, second, column) else { return Vec::new() };
    let largest = largest(&b);
    let parted = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / largest);
    second.series().time.iter().copied().zip(parted).filter(|(_, off)| *off > 0.0).collect()
}

/// The largest magnitude of some values.
#[must_use]
pub fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}
