//! Comparing runs that no two machines can repeat for long: moment by moment up to the predictability horizon, by means
//! with confidence intervals after it.
//!
//! The horizon is measured: a twin of the run, one position moved by one unit in the last place, is within [`PARTED`] of it
//! up to there. Two programs that do the same arithmetic in another order differ by many such units at once, which is what
//! [`ALLOWED`] leaves room for.

use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_reference::statistics::{BLOCKS, difference as of_blocks};
use grainbench_reference::twin::PARTED;
use grainbench_scene::scene::Duration;

/// How far two programs may be apart before that, in the same units.
pub const ALLOWED: f64 = 1e-8;
/// The adjustment that makes a twin, by name.
pub const TWIN: &str = "one position moved by 1 ulp";

/// Which columns of the series twins are watched by.
#[derive(Clone, Copy, Debug)]
pub struct Parting {
    /// The columns.
    pub columns: &'static [&'static str],
}

/// A column of two runs at the steps of the first.
///
/// # Errors
/// When the column is missing, or a step of the second.
pub fn together(first: &Done, second: &Done, column: &str) -> Result<(Vec<f64>, Vec<f64>), Missing> {
    let of_first = first.column(column)?.to_vec();
    let steps = &first.series().step;
    Ok((of_first, steps.iter().map(|&step| second.at_step(column, step)).collect::<Result<_, _>>()?))
}

/// Time (s) and |difference| of a column, over its largest value in the first run, where they differ.
#[must_use]
pub fn difference(first: &Done, second: &Done, column: &str) -> Vec<(f64, f64)> {
    let Ok((a, b)) = together(second, first, column) else { return Vec::new() };
    let largest = a.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let parted = a.iter().zip(&b).map(|(a, b)| (a - b).abs() / largest);
    second.series().time.iter().copied().zip(parted).filter(|(_, off)| *off > 0.0).collect()
}

/// The last sample up to which twins are within [`PARTED`].
fn last_together(of: Parting, run: &Done, twin: &Done) -> Result<usize, Missing> {
    let mut last = run.series().step.len();
    for column in of.columns {
        let (a, b) = together(run, twin, column)?;
        let largest = a.iter().map(|value| value.abs()).fold(0.0, f64::max);
        let parted = |(a, b): (&f64, &f64)| (a - b).is_nan() || (a - b).abs() > PARTED * largest;
        last = last.min(a.iter().zip(&b).position(parted).unwrap_or(last));
    }
    last.checked_sub(1).ok_or_else(|| Missing("moment at which twins are together".to_owned()))
}

/// The time of the horizon (s).
///
/// # Errors
/// When a column is missing.
pub fn time_of_horizon(of: Parting, run: &Done, twin: &Done) -> Result<f64, Missing> {
    Ok(run.series().time[last_together(of, run, twin)?])
}

/// The horizon itself, as a case states it in steps.
#[must_use]
pub fn horizon(of: Parting, steps: u64, runs: [Run; 2]) -> Gate {
    Gate {
        quantity: format!("predictability horizon in steps: twins part by {PARTED:e}"),
        unit: "1",
        evidence: Evidence::Convergence,
        scope: Scope::Named,
        source: "a twin of the run, one position moved by one unit in the last place",
        allowed: 0.25,
        because: "growth of a disturbance is exponential: a factor ten in it, or in where it begins, is a quarter of the way",
        runs: runs.into(),
        measure: measure(move |done| {
            let found = done[0].series().step[last_together(of, &done[0], &done[1])?];
            Ok(Measured::new(found as f64, steps as f64, steps as f64))
        }),
        control: Control::scene("a run that ends before twins can part", |scene| {
            scene.duration = Duration::Cycles(400)
        }),
    }
}

/// All watched columns of a program (first run) and ours (second) up to the horizon that the twins (third and fourth) have.
#[must_use]
pub fn pointwise(of: Parting, runs: Vec<Run>, control: Control) -> Gate {
    Gate {
        quantity: format!("energy and stress up to the horizon, worst, against {}", runs[1].solver),
        unit: "1",
        evidence: Evidence::OtherCode,
        scope: Scope::Named,
        source: "the program, run on the deck of the same scene",
        allowed: ALLOWED,
        because: "ten times what the twins have parted by at the horizon, for two programs round every sum otherwise; relative \
                  to the largest value",
        runs,
        measure: measure(move |done| {
            let horizon = done[2].series().step[last_together(of, &done[2], &done[3])?];
            let mut worst: Option<Measured> = None;
            for column in of.columns {
                let (theirs, ours) = together(&done[0], &done[1], column)?;
                let largest = ours.iter().map(|value| value.abs()).fold(0.0, f64::max);
                let until = done[0].series().step.partition_point(|&step| step <= horizon);
                let time = &done[0].series().time[..until];
                let relative =
                    |values: &[f64]| values[..until].iter().map(|value| value / largest).collect::<Vec<f64>>();
                let found = Measured::worst_of(time, &relative(&theirs), &relative(&ours), 1.0);
                let error = |of: &Measured| if of.error().is_nan() { f64::INFINITY } else { of.error().abs() };
                if worst.as_ref().is_none_or(|worst| error(&found) > error(worst)) {
                    worst = Some(found);
                }
            }
            worst.ok_or_else(|| Missing("columns to compare".to_owned()))
        }),
        control,
    }
}

/// What a mean is taken of.
#[derive(Clone, Copy, Debug)]
pub struct Sum {
    /// The column of the series.
    pub column: &'static str,
    /// What it is called.
    pub words: &'static str,
    /// Unit of what the mean is taken of.
    pub unit: &'static str,
    /// Whether the mean is that of the logarithm: of what grows and falls by factors, for its largest values would
    /// otherwise outweigh all others.
    pub logarithm: bool,
}

/// The mean of a column after the horizon, in units of half the confidence interval of the difference.
#[must_use]
pub fn statistics(of: Parting, Sum { column, words, unit, logarithm }: Sum, runs: Vec<Run>, control: Control) -> Gate {
    Gate {
        quantity: format!("mean {words} after the horizon, against {}", runs[1].solver),
        unit,
        evidence: Evidence::OtherCode,
        scope: Scope::Named,
        source: "the program, run on the deck of the same scene",
        allowed: 1.0,
        because: "in units of half the 99 % confidence interval of the difference, from the means over 8 blocks of time",
        runs,
        measure: measure(move |done| {
            let horizon = done[2].series().step[last_together(of, &done[2], &done[3])?];
            let (theirs, ours) = together(&done[0], &done[1], column)?;
            let from = done[0].series().step.partition_point(|&step| step <= horizon);
            let read = |values: &[f64]| -> Vec<f64> {
                values[from..].iter().map(|value| if logarithm { value.ln() } else { *value }).collect()
            };
            let estimate = of_blocks(&read(&ours), &read(&theirs), BLOCKS)
                .ok_or_else(|| Missing(format!("{BLOCKS} samples after the horizon, at step {horizon}")))?;
            Ok(Measured::new(estimate.second, estimate.first, estimate.half_width))
        }),
        control,
    }
}
