//! Difference of a rerun from a stored run.

use grainbench_solver::record::Series;

/// Largest difference of one column between a rerun and a stored run.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// Name of the column.
    pub name: String,
    /// Unit of the column.
    pub unit: String,
    /// Stored value at the time of the largest difference.
    pub stored: f64,
    /// Value of the rerun at the time of the largest difference.
    pub rerun: f64,
    /// Scale by which the difference is divided: the largest magnitude in all columns with this unit; for lengths (m),
    /// the largest change since the start.
    pub scale: f64,
    /// Time of the largest difference (s).
    pub time: f64,
}

impl Drift {
    /// Returns the relative difference (rerun − stored)/scale.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.rerun - self.stored) / self.scale
    }
}

/// Returns the largest difference of each column at the stored steps up to `last_step`. If the rerun lacks a value,
/// [`Drift::rerun`] is NaN, which counts as the largest difference.
#[must_use]
pub fn drift(stored: &Series, rerun: &Series, last_step: u64) -> Vec<Drift> {
    let moved = |values: &[f64], unit: &str| -> f64 {
        let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
        values.iter().map(|value| (value - start).abs()).fold(0.0, f64::max)
    };
    let all = || stored.columns.iter().zip(&stored.values);
    let mut found = Vec::new();
    for (column, values) in all() {
        let same_unit = all().filter(|(other, _)| other.unit == column.unit);
        let scale = same_unit.map(|(other, values)| moved(values, &other.unit)).fold(0.0, f64::max);
        let mut worst = Drift {
            name: column.name.clone(),
            unit: column.unit.clone(),
            stored: values.first().copied().unwrap_or(f64::NAN),
            rerun: values.first().copied().unwrap_or(f64::NAN),
            scale: if scale > 0.0 { scale } else { 1.0 },
            time: 0.0,
        };
        let of_rerun = rerun.column(&column.name);
        for ((step, time), value) in stored.step.iter().zip(&stored.time).zip(values) {
            if *step > last_step {
                break;
            }
            let place = rerun.step.binary_search(step).ok();
            let again = place.and_then(|at| of_rerun?.get(at)).copied().unwrap_or(f64::NAN);
            let is_worse = again.is_nan() || (again - value).abs() > (worst.rerun - worst.stored).abs();
            if is_worse && !worst.rerun.is_nan() {
                (worst.stored, worst.rerun, worst.time) = (*value, again, *time);
            }
        }
        found.push(worst);
    }
    found
}
