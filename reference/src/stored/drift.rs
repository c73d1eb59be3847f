//! How far a rerun is from what is stored.

use grainbench_scene::record::Series;

/// How one column has drifted.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// The column.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What is stored where they differ most.
    pub stored: f64,
    /// What the rerun has there.
    pub rerun: f64,
    /// The largest magnitude of any column of that unit; of coordinates the largest change.
    pub scale: f64,
    /// The time of it (s).
    pub time: f64,
}

impl Drift {
    /// (rerun − stored)/scale.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.rerun - self.stored) / self.scale
    }
}

/// A drift a column, at the stored steps up to `last_step`; what the rerun lacks is not a number.
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
