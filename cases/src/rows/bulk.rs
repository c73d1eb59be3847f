//! Rows of a bulk of grains beside a program: a grain until rounding has grown, means over time after it.

use crate::rows::programs::row;
use grainbench_harness::compare::pointwise::{together, worst};
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::{BLOCKS, difference};

/// The place of the probe `one`, in units of the first grain's radius.
pub(crate) fn beginning(quantity: &str, runs: [Run; 2]) -> Claim {
    let allowed = judged(1e-11, "the same cycle: order of sums; in units of its radius");
    let control = Control::ours("E* × 1.00001 in ours", |scene| scene.change_laws(|law| law.scale_normal(1.00001)));
    row(quantity, "m", allowed, runs, control, |done| {
        worst(done, &["one.x", "one.y", "one.z"], done[0].scene.grains[0].radius)
    })
}

/// The mean of a column from a time on (s), in units of half the confidence interval of the difference.
pub(crate) fn mean(
    quantity: &str,
    unit: &'static str,
    (column, from): (&'static str, f64),
    runs: [Run; 2],
    control: Control,
) -> Claim {
    let allowed = one_interval(
        "in units of half the 99 % confidence interval of the difference, from the means over 8 blocks of time",
    );
    row(quantity, unit, allowed, runs, control, move |done| {
        let (ours, theirs) = together(&done[0], &done[1], column)?;
        let first = done[1].series().time.partition_point(|&time| time < from);
        let estimate = difference(&theirs[first..], &ours[first..], BLOCKS);
        let estimate = estimate.ok_or_else(|| Missing(format!("{BLOCKS} samples after {from} s")))?;
        Ok(Measured::new(estimate.second, estimate.first, estimate.half_width))
    })
}
