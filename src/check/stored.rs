//! Against the stored runs of LAMMPS and LIGGGHTS of the same scene.

use super::ours::is_compared;
use super::{Candidate, widened};
use grainbench_harness::case::Case;
use grainbench_harness::expect::Measured;
use grainbench_cases::stored;
use grainbench_harness::tolerance::Made;
use grainbench_harness::verdict::Verdict;
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::Outputs;
use grainbench_reference::stored::{StoredRun, folder};
use grainbench_reports::number;
use grainbench_scene::record::{Column, Series};

/// How many times what half the time step changes a stored run may be off itself: the grid convergence index of the coarser of
/// two steps, with the factor of safety 3 that two call for and first order, as where contacts begin and end (Roache 1994).
const SAFETY: f64 = 6.0;
/// What a program may be off by beside what is measured: a millionth of the scale.
const FLOOR: f64 = 1e-6;

/// One stored run, and what half its time step changes.
struct Run {
    name: String,
    series: Series,
    half_step: Series,
}

/// A row a column: against the stored run that is nearest as a whole, at the times that both have, within what the stored
/// runs differ by and their own uncertainty.
pub(super) fn compare(
    case: &Case,
    candidate: &Candidate,
    outputs: &Outputs,
    observed: &Observed,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Vec<Verdict> {
    let runs = runs(case, candidate);
    let mut columns: Vec<(usize, &Column)> = observed.series.columns.iter().enumerate().collect();
    columns.retain(|(_, column)| {
        is_compared(&column.name) && runs.iter().all(|run| run.series.column(&column.name).is_some())
    });
    let scale = |run: &Run, unit: &str| -> f64 {
        let of_unit = columns.iter().filter(|(_, column)| column.unit == unit);
        of_unit.filter_map(|(_, column)| Some(extent(run.series.column(&column.name)?, unit))).fold(0.0, f64::max)
    };
    let distance = |run: &Run| -> f64 {
        let parts = columns.iter().filter_map(|&(at, column)| {
            let (_, found, expected) =
                together(&observed.series, &observed.series.values[at], &run.series, &column.name)?;
            Some(largest_difference(&found, &expected) / scale(run, &column.unit).max(f64::MIN_POSITIVE))
        });
        parts.sum()
    };
    let Some(nearest) = runs.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return Vec::new() };
    let mut verdicts = Vec::new();
    for &(at, column) in &columns {
        let scale = scale(nearest, &column.unit);
        let pair = together(&observed.series, &observed.series.values[at], &nearest.series, &column.name);
        let Some((times, found, expected)) = pair.filter(|_| scale > 0.0) else { continue };
        let own = nearest.series.column(&column.name).unwrap_or_default();
        let between = runs
            .iter()
            .filter_map(|run| together(&nearest.series, own, &run.series, &column.name))
            .map(|(_, a, b)| largest_difference(&a, &b))
            .fold(0.0, f64::max)
            / scale;
        let halved = largest_difference(own, nearest.half_step.column(&column.name).unwrap_or_default()) / scale;
        let open = observed.uncertainty[at].iter().copied().fold(0.0, f64::max) / scale;
        let measured = Measured::worst_of(&times, &found, &expected, scale);
        let mut verdict = row(format!("{} at {} stored samples, worst", column.name, times.len()), &column.unit);
        verdict.source.clone_from(&nearest.name);
        verdict.tolerance = Made::Estimated;
        verdict.allowed = FLOOR + between + SAFETY * halved;
        verdict.because = format!(
            "stored runs differ by {}, half the step changes them by {}, taken {SAFETY} times, and {} beside",
            number::fraction(between),
            number::fraction(halved),
            number::fraction(FLOOR)
        );
        verdicts.push(widened(verdict, open, outputs).judged(&measured));
    }
    verdicts
}

/// The stored runs of the scene; those that are stale or damaged judge nothing.
fn runs(case: &Case, candidate: &Candidate) -> Vec<Run> {
    let of_case = stored::all().into_iter().filter(|of| of.case.name == case.name);
    of_case
        .filter_map(|of| {
            let scene = of.scene().ok().filter(|scene| *scene == candidate.scene)?;
            let stored = StoredRun::load(&folder(of.program, &of.id)).ok()?;
            let provenance = stored.is_of(&scene, &of.run.resolution).then(|| stored.provenance())?;
            Some(Run {
                name: format!("{}, stored run of {}", provenance.version, provenance.date),
                series: until(stored.series(&scene), provenance.predictable_steps),
                half_step: until(stored.half_step(&scene), provenance.predictable_steps),
            })
        })
        .collect()
}

/// The samples up to the last one that can be predicted.
fn until(mut series: Series, last: Option<u64>) -> Series {
    let keep = last.map_or(series.step.len(), |last| series.step.partition_point(|&step| step <= last));
    series.step.truncate(keep);
    series.time.truncate(keep);
    series.values.iter_mut().for_each(|values| values.truncate(keep));
    series
}

/// Times that two series share, and the values of a column there; none where fewer than two are shared.
fn together(first: &Series, values: &[f64], second: &Series, name: &str) -> Option<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let others = second.column(name)?;
    let (mut times, mut a, mut b) = (Vec::new(), Vec::new(), Vec::new());
    for (time, value) in first.time.iter().zip(values) {
        let near = 1e-9 * second.time.last().copied().unwrap_or_default();
        let at = second.time.partition_point(|other| *other < time - near);
        if second.time.get(at).is_some_and(|other| (other - time).abs() <= near) {
            times.push(*time);
            a.push(*value);
            b.push(others[at]);
        }
    }
    (times.len() > 1).then_some((times, a, b))
}

/// Coordinates from where they start, all else as it is.
fn extent(values: &[f64], unit: &str) -> f64 {
    let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
    values.iter().map(|value| (value - start).abs()).fold(0.0, f64::max)
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
