//! Predictability horizon of a run. After it, means over time are compared, for quantities of the whole system and of walls.

use super::ours::{Plan, is_compared};
use grainbench_dem::convention::Convention;
use grainbench_harness::compare::peers::{Peer, WIDE, together};
use grainbench_harness::expect::Measurement;
use grainbench_harness::statistics::{BLOCKS, difference};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reports::number;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::perturbed::{PARTED, move_one};

/// Largest accepted difference of two means, in units of half the 99 % confidence interval. It exceeds 1, because
/// several columns are compared at once.
const INTERVALS: f64 = 2.0;

/// Returns the last time (s) at which our run and a perturbed run agree; `None` if they agree to the end, or if the
/// scene has only one grain. In the perturbed run, one position is changed by one unit in the last place.
pub(super) fn find(scene: &Scene, plan: &Plan, ours: &[Peer]) -> Result<Option<f64>, String> {
    let Some(ours) = ours.first().filter(|_| scene.grains.len() > 1) else { return Ok(None) };
    let mut perturbed = scene.clone();
    move_one(&mut perturbed);
    let perturbed = plan.run(&perturbed, Convention::DEFAULT, 1)?.series;
    let parted = |at: &usize| -> Option<usize> {
        let values = &ours.series.values[*at];
        let others = perturbed.column(&ours.series.columns[*at].name)?;
        let scale = PARTED * values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        values.iter().zip(others).position(|(a, b)| (a - b).abs() > scale)
    };
    let compared = (0..ours.series.columns.len()).filter(|&at| is_compared(&ours.series.columns[at].name));
    let first = compared.filter_map(|at| parted(&at)).min();
    Ok(first.and_then(|first| ours.series.time.get(first.saturating_sub(1)).copied()))
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
        let (times, found, expected) = together(&observed.series, values, &ours.series, &column.name)?;
        let from = times.partition_point(|&time| time <= horizon);
        let quantity = format!("{}, mean after t = {} s", column.name, number::significant(horizon, 6));
        let row = Verdict {
            source: format!("{}, after the predictability horizon", ours.name),
            tolerance: ToleranceOrigin::Interval,
            allowed: INTERVALS,
            because: format!(
                "in units of half the 99 % confidence interval of the difference, from the means over {BLOCKS} blocks \
                 of time; {INTERVALS} units are allowed, because several columns are judged at once"
            ),
            ..row(quantity, &column.unit)
        };
        Some(judged(row, &expected[from..], &found[from..]))
    });
    rows.collect()
}

/// Judges a mean. The result is amber if the confidence interval is too wide or there are too few samples.
fn judged(row: Verdict, expected: &[f64], found: &[f64]) -> Verdict {
    let Some(means) = difference(expected, found, BLOCKS) else {
        let reason = format!("fewer than {BLOCKS} samples lie after the horizon");
        return row.left(Outcome::NoReference, reason);
    };
    let largest = expected.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if means.half_width == 0.0 && means.first == means.second {
        return row.judged(&Measurement::new(means.second, means.first, largest.max(f64::MIN_POSITIVE)));
    }
    let row = row.judged(&Measurement::new(means.second, means.first, means.half_width));
    if row.outcome == Outcome::Pass && INTERVALS * means.half_width > WIDE * largest {
        let open = number::fraction(INTERVALS * means.half_width / largest);
        return row.left(
            Outcome::NoReference,
            format!("inconclusive: the confidence interval is {open} of the largest value"),
        );
    }
    row
}

/// Returns true if a column is compared and belongs to the whole system or to a wall.
fn is_of_all(scene: &Scene, name: &str) -> bool {
    let probe = name.rsplit_once('.').and_then(|(probe, _)| scene.probes.iter().find(|other| other.name == probe));
    let is_of_all = |target: ProbeTarget| matches!(target, ProbeTarget::System | ProbeTarget::Wall(_));
    is_compared(name) && probe.is_some_and(|probe| is_of_all(probe.target))
}
