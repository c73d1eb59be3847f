//! Comparison of chaotic runs. Samples are compared up to the predictability horizon, and means with confidence
//! intervals after it.
//!
//! The horizon is measured with a second run, in which one position is perturbed by one unit in the last place. Up to
//! the horizon, the two runs differ by at most [`PARTED`] of the largest value. Two programs that sum in different
//! orders differ by many units in the last place from the first step. [`ALLOWED`] is therefore larger than [`PARTED`].
//!
//! The runs of a claim have a fixed order: our run, the run of another program, our run at the resolution that defines
//! the horizon, and its perturbed run.

use super::pointwise::{largest, together};
use crate::claim::{Claim, claim};
use crate::control::Control;
use crate::expect::Measurement;
use crate::run::{FinishedRun, MissingData, Run};
use crate::source::Source;
use crate::statistics::{BLOCKS, difference as of_blocks};
use crate::tolerance::{computed, one_interval};
use grainbench_scene::scene::Duration;
use grainbench_solver::perturbed::PARTED;

/// Allowed difference between two programs up to the horizon, as a fraction of the largest value of the column.
pub const ALLOWED: f64 = 1e-8;
/// Name of the scene change that makes a perturbed run.
pub const PERTURBED: &str = "one position moved by 1 ulp";

/// Names of the columns of the series in which the divergence of perturbed runs is measured.
pub type DivergenceColumns = &'static [&'static str];

/// Returns the index of the last sample before a run and its perturbed run differ by more than [`PARTED`] of the largest value.
fn last_together(columns: DivergenceColumns, run: &FinishedRun, perturbed: &FinishedRun) -> Result<usize, MissingData> {
    let mut last = run.series().step.len();
    for column in columns {
        let (b, a) = together(perturbed, run, column)?;
        let scale = PARTED * largest(&a);
        let parted = |(a, b): (&f64, &f64)| (a - b).is_nan() || (a - b).abs() > scale;
        last = last.min(a.iter().zip(&b).position(parted).unwrap_or(last));
    }
    last.checked_sub(1).ok_or_else(|| MissingData("moment at which perturbed runs are together".to_owned()))
}

/// Returns the step number at the horizon, from our run and its perturbed run.
fn step_of_horizon(columns: DivergenceColumns, run: &FinishedRun, perturbed: &FinishedRun) -> Result<u64, MissingData> {
    Ok(run.series().step[last_together(columns, run, perturbed)?])
}

/// Returns the time at the horizon (s).
///
/// # Errors
/// When a column or a step is missing, or the two runs differ at the first sample.
pub fn time_of_horizon(
    columns: DivergenceColumns,
    run: &FinishedRun,
    perturbed: &FinishedRun,
) -> Result<f64, MissingData> {
    Ok(run.series().time[last_together(columns, run, perturbed)?])
}

/// Returns the claim that the horizon is at step `steps`. This expected value is a regression value: the result when the
/// case was written.
pub fn horizon(columns: DivergenceColumns, steps: u64, runs: [Run; 2]) -> Claim {
    let expected = steps as f64;
    claim(format!("predictability horizon in steps: perturbed runs part by {PARTED:e}"), "1")
        .runs(runs)
        .equals(
            Source::Regression(
                "number of steps until a run and a perturbed run, with one position changed by one unit in the last \
                 place, differ",
            ),
            move |done| Ok(Measurement::new(step_of_horizon(columns, &done[0], &done[1])? as f64, expected, expected)),
        )
        .within(computed(
            0.25,
            "a disturbance grows exponentially: a factor of ten in its rate or in its initial value changes the \
             horizon by a quarter",
        ))
        .refuses(Control::scene("a run that ends before perturbed runs can part", |scene| {
            scene.duration = Duration::Cycles(400);
        }))
}

/// Returns the claim that compares all `columns` of our run (first) and of another program's run (second) up to the
/// horizon.
///
/// The horizon follows from our run (third) and its perturbed run (fourth).
pub fn pointwise(columns: DivergenceColumns, runs: Vec<Run>, control: Control) -> Claim {
    let program = runs[1].solver;
    claim(format!("energy and stress up to the horizon, worst, against {program}"), "1")
        .runs(runs)
        .agrees(Source::Program, move |done| {
            let horizon = step_of_horizon(columns, &done[2], &done[3])?;
            let series = done[1].series();
            let until = series.step.partition_point(|&step| step <= horizon);
            Measurement::worst_read(columns.iter().map(|column| {
                let (ours, theirs) = together(&done[0], &done[1], column)?;
                let scale = largest(&theirs);
                let relative = |values: &[f64]| values[..until].iter().map(|value| value / scale).collect::<Vec<f64>>();
                Ok(Measurement::worst_of(&series.time[..until], &relative(&ours), &relative(&theirs), 1.0))
            }))
        })
        .within(computed(
            ALLOWED,
            "ten times the difference of perturbed runs at the horizon, because two programs round sums differently; \
             relative to the largest value",
        ))
        .refuses(control)
}

/// Column whose mean values are compared.
#[derive(Clone, Copy, Debug)]
pub struct Sum {
    /// Name of the column in the series.
    pub column: &'static str,
    /// Name of the averaged quantity.
    pub words: &'static str,
    /// Unit of the averaged quantity.
    pub unit: &'static str,
    /// True to average the logarithm. This suits a quantity that changes by factors, whose largest values would
    /// dominate the mean.
    pub logarithm: bool,
}

/// Returns the claim about the mean of a column after the horizon.
///
/// The error is the difference of the two means. It is divided by half the width of its confidence interval.
pub fn statistics(
    columns: DivergenceColumns,
    Sum { column, words, unit, logarithm }: Sum,
    runs: Vec<Run>,
    control: Control,
) -> Claim {
    let program = runs[1].solver;
    claim(format!("mean {words} after the horizon, against {program}"), unit)
        .runs(runs)
        .agrees(Source::Program, move |done| {
            let horizon = step_of_horizon(columns, &done[2], &done[3])?;
            let (ours, theirs) = together(&done[0], &done[1], column)?;
            let from = done[1].series().step.partition_point(|&step| step <= horizon);
            let read = |values: &[f64]| -> Vec<f64> {
                values[from..].iter().map(|value| if logarithm { value.ln() } else { *value }).collect()
            };
            let estimate = of_blocks(&read(&theirs), &read(&ours), BLOCKS)
                .ok_or_else(|| MissingData(format!("{BLOCKS} samples after the horizon, at step {horizon}")))?;
            Ok(Measurement::new(estimate.second, estimate.first, estimate.half_width))
        })
        .within(one_interval(
            "in units of half the 99 % confidence interval of the difference, from the means over 8 blocks of time",
        ))
        .refuses(control)
}
