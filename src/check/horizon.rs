//! Predictability horizon of a run. After it, means over time are compared, for quantities of the whole system, of walls and for
//! numbers of grains.

use super::ours::{Plan, convention, is_compared, is_count};
use grainbench_harness::compare::peers::{Peer, WIDE, together};
use grainbench_harness::expect::Measurement;
use grainbench_harness::statistics::{BLOCKS, difference};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reports::number;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::perturbed::{PARTED, move_one};
use grainbench_solver::record::Series;

/// Largest accepted difference of two means, in units of half the 99 % confidence interval. It exceeds 1, because
/// several columns are compared at once.
const INTERVALS: f64 = 2.0;

/// Returns the last time (s) at which our run and a perturbed run agree; `None` if they agree to the end, or if the
/// scene has only one grain. In the perturbed run, one position is changed by one unit in the last place.
pub(super) fn find(scene: &Scene, plan: &Plan, ours: &[Peer]) -> Result<Option<f64>, String> {
    let Some(ours) = ours.first().filter(|_| scene.grains.len() > 1) else { return Ok(None) };
    let mut perturbed = scene.clone();
    move_one(&mut perturbed);
    let perturbed = plan.run(&perturbed, convention(ours), 1)?.series;
    Ok(parted(&ours.series, &perturbed, PARTED, false))
}

/// Returns the horizon (s), shortened to the last time at which a run agrees with the run at smaller time steps. In a run
/// that amplifies rounding errors, the error of the time step grows in the same way, and no longer gives a tolerance.
pub(super) fn shortened(horizon: f64, run: &Peer) -> f64 {
    let apart = run.half_step.as_ref().and_then(|half| parted(&run.series, half, WIDE, true));
    apart.map_or(horizon, |time| time.min(horizon))
}

/// Returns the time (s) of the last sample before a compared column of two runs differs by more than a fraction of its
/// largest value, or of its largest displacement if `moved` is true; `None` if none differs.
fn parted(run: &Series, other: &Series, fraction: f64, moved: bool) -> Option<f64> {
    let first = |at: usize| -> Option<usize> {
        let (column, values) = (&run.columns[at], &run.values[at]);
        let start = values.first().copied().filter(|_| moved && column.unit == "m").unwrap_or_default();
        let scale = fraction * values.iter().fold(0.0, |largest: f64, value| largest.max((value - start).abs()));
        values.iter().zip(other.column(&column.name)?).position(|(a, b)| (a - b).abs() > scale)
    };
    let compared = (0..run.columns.len()).filter(|&at| is_compared(&run.columns[at].name));
    let first = compared.filter_map(first).min()?;
    run.time.get(first.saturating_sub(1)).copied()
}

/// Compares means over the time after the horizon (s). Only columns of the whole system and of walls are compared.
pub(super) fn beyond(
    scene: &Scene,
    ours: &[Peer],
    observed: &DumpRecord,
    horizon: f64,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Vec<Verdict> {
    let Some(ours) = ours.first() else { return Vec::new() };
    let columns = observed.series.columns.iter().zip(&observed.series.values);
    let rows = columns.filter(|(column, _)| is_of_all(scene, &column.name)).filter_map(|(column, values)| {
        let (times, mut found, mut expected) = together(&observed.series, values, &ours.series, &column.name)?;
        let mut from = times.partition_point(|&time| time <= horizon);
        let (mut mean, mut unit) = ("mean", column.unit.as_str());
        if is_count(&column.name) {
            (found, expected) = (rates(&times[from..], &found[from..]), rates(&times[from..], &expected[from..]));
            (from, mean, unit) = (0, "mean rate", "1/s");
        }
        let quantity = format!("{}, {mean} after t = {} s", column.name, number::significant(horizon, 6));
        let row = Verdict {
            source: format!("{}, after the predictability horizon", ours.name),
            tolerance: ToleranceOrigin::Interval,
            allowed: INTERVALS,
            because: format!(
                "in units of half the 99 % confidence interval of the difference, from the means over {BLOCKS} blocks \
                 of time; {INTERVALS} units are allowed, because several columns are judged at once"
            ),
            ..row(quantity, unit)
        };
        Some(judged(row, &expected[from..], &found[from..]))
    });
    rows.collect()
}

/// Returns the change between samples divided by the mean time between samples (1/s). The mean of these rates is the flow
/// rate, also if the times between the samples differ.
fn rates(times: &[f64], values: &[f64]) -> Vec<f64> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let step = (last - first) / (times.len() - 1) as f64;
    values.windows(2).map(|value| (value[1] - value[0]) / step).collect()
}

/// Judges a mean. The result is amber if the confidence interval is too wide or there are too few samples.
fn judged(row: Verdict, expected: &[f64], found: &[f64]) -> Verdict {
    let Some(means) = difference(expected, found, BLOCKS) else {
        let reason = format!("fewer than {BLOCKS} samples lie after the horizon");
        return row.left(Outcome::NoReference, reason);
    };
    let largest = expected.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if means.half_width == 0.0 && means.first == means.second {
        let because = format!("all means over {BLOCKS} blocks of time are equal");
        let row = Verdict { allowed: 0.0, because, ..row };
        return row.judged(&Measurement::new(means.second, means.first, largest.max(f64::MIN_POSITIVE)));
    }
    let row = row.judged(&Measurement::new(means.second, means.first, means.half_width));
    // The largest value may be a single impact, or the rate between two samples that lie close together. The mean magnitude
    // is the scale of the mean.
    let magnitude = expected.iter().map(|value| value.abs()).sum::<f64>() / expected.len() as f64;
    if row.outcome == Outcome::Pass && INTERVALS * means.half_width > WIDE * magnitude {
        let open = number::fraction(INTERVALS * means.half_width / magnitude);
        let reason = format!("inconclusive: the confidence interval is {open} of the mean magnitude");
        return row.left(Outcome::NoReference, reason);
    }
    row
}

/// Returns true if a column is compared and belongs to the whole system or to a wall.
fn is_of_all(scene: &Scene, name: &str) -> bool {
    let probe = name.rsplit_once('.').and_then(|(probe, _)| scene.probes.iter().find(|other| other.name == probe));
    let is_of_all = |target: ProbeTarget| {
        matches!(target, ProbeTarget::System | ProbeTarget::Wall(_) | ProbeTarget::Stress | ProbeTarget::Count)
    };
    is_compared(name) && probe.is_some_and(|probe| is_of_all(probe.target))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten grains leave in two seconds, most of them between two close samples.
    #[test]
    fn the_mean_of_the_rates_is_the_flow_rate() {
        let found = rates(&[1.0, 1.5, 1.501, 3.0], &[0.0, 1.0, 9.0, 10.0]);
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        assert!((mean - 5.0).abs() < 1e-12, "{mean} 1/s");
    }

    /// Equal means pass if their confidence interval is narrow. A single peak widens the interval and is far larger than it,
    /// but the mean is not known better because of the peak.
    #[test]
    fn a_peak_leaves_the_mean_inconclusive() {
        let outcome = |peak: f64| {
            let noise = |at: i32, place: i32| 1e-4 * f64::from(at * at * place % 97);
            let values = |place: i32| -> Vec<f64> {
                (0..400).map(|at| if at == place { peak } else { 1.0 + noise(at, place) }).collect()
            };
            let row = Verdict { allowed: INTERVALS, ..Verdict::open("heap", "wall.force_y", "N") };
            judged(row, &values(251), &values(150)).outcome
        };
        assert_eq!([outcome(1.0), outcome(1e4)], [Outcome::Pass, Outcome::NoReference]);
    }
}
