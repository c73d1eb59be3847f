//! Claims on many grains. Our solver is compared with LAMMPS or LIGGGHTS: by the position of one grain until rounding
//! errors have grown, and by time averages afterwards. Published results of two codes on one packing are compared with
//! the mean over our own packings.

use crate::rows::programs::row;
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::{BLOCKS, difference, mean_and_variance};
use grainbench_reference::round_robin::Spread;

/// Returns the claim on the position of the grain that the probe `one` records, in units of the first grain's radius.
pub(crate) fn beginning(quantity: &str, runs: [Run; 2]) -> Claim {
    let allowed = judged(
        1e-11,
        "rounding only, because both programs use the same integration cycle with another \
                                 order of sums; in units of the radius",
    );
    let control = Control::our_contact_law("E* × 1.00001 in ours", |law| law.scale_normal(1.00001));
    row(quantity, "m", allowed, runs, control, |done| {
        let axes = &["one.x", "one.y", "one.z"][..done[0].scene.dimension.count()];
        worst(done, axes, done[0].scene.grains[0].radius)
    })
}

/// Returns the claim on the time average of a column from the time `from` (s) to the end. The error is in units of half
/// the 99 % confidence interval of the difference.
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
        let estimate = estimate.ok_or_else(|| format!("{BLOCKS} samples after {from} s"))?;
        Ok(Measurement::new(estimate.second, estimate.first, estimate.half_width))
    })
}

/// Returns the claim that the mean over our own packings, one run each, agrees with the published mean of two codes on
/// one packing. The error is in units of the allowed error 2 √(s_code² + s_own² (1/m + 1)). s_code is half the
/// difference of the two codes, times √2. s_own is the standard deviation between our m packings.
pub(crate) fn of_packings(
    (quantity, unit): (String, &'static str),
    runs: Vec<Run>,
    (cited, half): (CitedNumber, CitedNumber),
    value: impl Fn(&FinishedRun) -> Result<f64, MissingData> + Send + Sync + 'static,
    because: &'static str,
) -> ClaimWithTolerance {
    claim(quantity, unit)
        .runs(runs)
        .equals(cited.source(), move |done| {
            let values = done.iter().map(&value).collect::<Result<Vec<f64>, _>>()?;
            let (own, variance) = mean_and_variance(&values);
            let code = half.value * std::f64::consts::SQRT_2;
            let allowed = Spread { mean: cited.value, code, bed: variance.sqrt() }.allowed(values.len(), 1);
            Ok(Measurement::new(own, cited.value, allowed))
        })
        .within(computed(1.0, because))
}
