//! Comparison of two sessions of the cost study. Counts must be equal; times may differ within their uncertainty.
//!
//! The time of a point is the median of its repetitions. Each repetition is divided by the reference time measured
//! before and after it ([`crate::clock`]), so that the speed of the machine cancels. Let xᵢ =
//! ln(tᵢ,new/tᵢ,old) for the n points i of a solver in a case. The standard error of their median m is
//!
//! ```text
//! s = max(1.2533 · 1.4826 · median|xᵢ − m|, √mean(σᵢ²))/√n
//! ```
//!
//! Here σᵢ is the standard error of xᵢ from the median deviations of the repetitions of both sessions, computed in the
//! same way. The second term is larger if some points are uncertain. Then all points are uncertain, because they were
//! measured in alternation. A solver counts as slower if m − 3s > ln 1.1 for at least three points. The margin of 10 %
//! covers differences between sessions that repetitions do not show, such as memory layout and other programs. In 36
//! pairs of sessions such differences shifted all points of a case by up to 6 % more than 3s.

use grainbench_harness::statistics::median;
use grainbench_reports::study::point::{Change, Point, PointStatus};
use std::collections::{BTreeMap, BTreeSet};

/// Relative change of time that occurs between sessions of the same code.
const SESSIONS: f64 = 0.1;
/// Number of standard errors by which a change must exceed [`SESSIONS`].
const SURE: f64 = 3.0;
/// Smallest number of points for a comparison.
const FEWEST: usize = 3;
/// Shortest run that is compared (s). The clock dominates the time of shorter runs.
const TOO_SHORT: f64 = 2e-4;

/// Name that replaces the case name in the comparison of all points of a solver.
const ALL: &str = "all cases";

/// Returns the number of points that are in both sessions.
#[must_use]
pub fn shared(old: &[Point], new: &[Point]) -> usize {
    let before: BTreeSet<[&str; 6]> = old.iter().map(Point::key).collect();
    new.iter().filter(|point| before.contains(&point.key())).count()
}

/// Returns the changes from one session to another. Points that only the old session has are counted by case, variant
/// and solver. Sessions without a common point cannot be compared, which counts as a change for the worse.
#[must_use]
pub fn compare(old: &[Point], new: &[Point]) -> Vec<Change> {
    let before: BTreeMap<[&str; 6], &Point> = old.iter().map(|point| (point.key(), point)).collect();
    let mut changes = Vec::new();
    let mut ratios: BTreeMap<(&str, &str), Vec<(f64, f64)>> = BTreeMap::new();
    for point in new {
        let Some(old) = before.get(&point.key()) else { continue };
        changes.extend(counts(old, point));
        if let Some(ratio) = ratio(old, point) {
            ratios.entry((&point.solver, &point.case)).or_default().push(ratio);
            ratios.entry((&point.solver, ALL)).or_default().push(ratio);
        }
    }
    changes.extend(ratios.iter().filter_map(|((solver, case), ratios)| time(solver, case, ratios)));
    changes.extend(lost(old, new));
    if shared(old, new) == 0 {
        let how =
            format!("expected points that are in both sessions, found none among {} and {}", old.len(), new.len());
        changes.insert(0, Change { what: "nothing compared".to_owned(), how, worse: true });
    }
    changes
}

/// Returns the numbers of points that only the old session has, by case, variant and solver. They are not a change for
/// the worse, because a selection of cases or solvers omits points on purpose.
fn lost(old: &[Point], new: &[Point]) -> Vec<Change> {
    let now: BTreeSet<[&str; 6]> = new.iter().map(Point::key).collect();
    let mut counts: BTreeMap<[&str; 3], usize> = BTreeMap::new();
    for point in old.iter().filter(|point| !now.contains(&point.key())) {
        *counts.entry([&point.case, &point.variant, &point.solver]).or_default() += 1;
    }
    let change = |([case, variant, solver], count): ([&str; 3], usize)| Change {
        what: format!("{case}/{variant} · {solver}"),
        how: format!("{count} points of the old session were not measured again"),
        worse: false,
    };
    counts.into_iter().map(change).collect()
}

/// Returns the changes of counts, errors and outcome of a point, by exact comparison.
fn counts(old: &Point, new: &Point) -> Option<Change> {
    let mut how = Vec::new();
    if old.standing != new.standing {
        how.push(format!("was {:?}, is {:?}", old.standing, new.standing).to_lowercase());
    }
    let both = old.counts.named().into_iter().zip(new.counts.named());
    let count = |count: Option<u64>| count.map_or("unknown".to_owned(), |count| count.to_string());
    how.extend(
        both.filter(|(a, b)| a.1 != b.1).map(|((name, was), (_, is))| format!("{name} {} → {}", count(was), count(is))),
    );
    if old.error != new.error {
        let word = |error: Option<f64>| error.map_or("none".to_owned(), |error| format!("{error:e}"));
        how.push(format!("error {} → {}", word(old.error), word(new.error)));
    }
    let what = format!("{}/{} · {} {}", new.case, new.variant, new.solver, new.setting());
    (!how.is_empty()).then(|| Change { what, how: how.join(", "), worse: true })
}

/// Returns the logarithm of the ratio of the new to the old time of a point, and its standard error.
fn ratio(old: &Point, new: &Point) -> Option<(f64, f64)> {
    let measured = |point: &Point| point.standing == PointStatus::Measured && point.wall_seconds >= Some(TOO_SHORT);
    if !(measured(old) && measured(new)) {
        return None;
    }
    let (was, is) = (MedianEstimate::of_repetitions(old)?, MedianEstimate::of_repetitions(new)?);
    Some((is.value - was.value, is.error.hypot(was.error)))
}

/// Median and its standard error, for a normal distribution.
struct MedianEstimate {
    value: f64,
    error: f64,
}

impl MedianEstimate {
    /// Computes the median of at least one number, and its standard error from the median absolute deviation.
    ///
    /// The median absolute deviation is robust against a few outliers. The error of a single number is unknown and set
    /// to zero.
    fn from_values(values: &[f64]) -> Self {
        let value = median(values);
        let distance = median(&values.iter().map(|other| (other - value).abs()).collect::<Vec<_>>());
        Self { value, error: 1.2533 * 1.4826 * distance / (values.len() as f64).sqrt() }
    }

    /// Computes the median of the logarithms of a point's times in units of the reference time.
    fn of_repetitions(point: &Point) -> Option<Self> {
        let times = point.repetitions.iter().map(|timing| (timing.cpu / timing.reference).ln());
        let times: Vec<f64> = times.filter(|time| time.is_finite()).collect();
        (!times.is_empty()).then(|| Self::from_values(&times))
    }
}

/// Returns the change of the times of a solver in a case if it is significant.
fn time(solver: &str, case: &str, ratios: &[(f64, f64)]) -> Option<Change> {
    if ratios.len() < FEWEST {
        return None;
    }
    let logarithms: Vec<f64> = ratios.iter().map(|(ratio, _)| *ratio).collect();
    let MedianEstimate { value: middle, error: scatter } = MedianEstimate::from_values(&logarithms);
    let doubt = ratios.iter().map(|(_, error)| error * error).sum::<f64>().sqrt() / ratios.len() as f64;
    let error = scatter.max(doubt);
    let worse = middle > 0.0;
    if middle.abs() - SURE * error <= SESSIONS.ln_1p() {
        return None;
    }
    let how = format!(
        "{} by a factor {:.2} (between {:.2} and {:.2} at {SURE} standard errors, {} points)",
        if worse { "slower" } else { "faster" },
        middle.abs().exp(),
        (middle.abs() - SURE * error).exp(),
        (middle.abs() + SURE * error).exp(),
        ratios.len()
    );
    Some(Change { what: format!("{case} · {solver}"), how, worse })
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_reports::study::point::{Counts, Timing};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Returns a session of one solver in one case, on a machine with varying load.
    ///
    /// Noise lengthens each time by up to 30 %. Varying machine speed lengthens each time and its reference time by up
    /// to 50 %. The session as a whole is slower by up to 4 %.
    fn session(seed: u64, slower: f64, points: usize, repetitions: usize) -> Vec<Point> {
        let mut dice = Pcg64Mcg::seed_from_u64(seed);
        let mut unit = move || dice.random::<f64>();
        let own = 1.0 + 0.04 * unit();
        (0..points)
            .map(|at| {
                let true_time = 1e-3 * (1.0 + at as f64);
                let timing = |_| {
                    let drift = 1.0 + 0.5 * unit();
                    let noise = 1.0 + 0.3 * unit() * unit() * unit();
                    let cpu = true_time * slower * own * drift * noise;
                    Timing { wall: cpu, cpu, start_up: 0.0, reference: 1e-3 * drift }
                };
                let timings: Vec<Timing> = (0..repetitions).map(timing).collect();
                point(&format!("dt={at}"), timings)
            })
            .collect()
    }

    fn point(resolution: &str, repetitions: Vec<Timing>) -> Point {
        Point {
            case: "squash".to_owned(),
            variant: "plain".to_owned(),
            solver: "dem".to_owned(),
            resolution: resolution.to_owned(),
            quantity: "x".to_owned(),
            unit: "m".to_owned(),
            standing: PointStatus::Measured,
            value: Some(1.0),
            expected: Some(1.0),
            error: Some(0.0),
            wall_seconds: Some(1e-3),
            cpu_seconds: Some(1e-3),
            start_up_seconds: Some(0.0),
            repetitions,
            counts: Counts { steps: 100, ..Counts::default() },
            ..Point::default()
        }
    }

    #[test]
    fn reruns_of_the_same_code_show_nothing() {
        for seed in 0..200 {
            let old = session(2 * seed, 1.0, 8, 5);
            for rerun in 0..5 {
                let new = session(10_000 + 5 * seed + rerun, 1.0, 8, 5);
                assert_eq!(compare(&old, &new), [], "seed {seed}, rerun {rerun}");
            }
        }
    }

    #[test]
    fn a_kernel_slower_by_a_quarter_shows() {
        for seed in 0..200 {
            let changes = compare(&session(2 * seed, 1.0, 8, 5), &session(2 * seed + 1, 1.25, 8, 5));
            let slower = changes.iter().all(|change| change.worse && change.how.starts_with("slower"));
            assert!(!changes.is_empty() && slower, "seed {seed}: {changes:?}");
        }
    }

    /// Times of the case `squash` in two sessions of the same code (µs). In the first session the processor was
    /// temporarily 1.5 times as fast.
    #[test]
    fn a_moment_at_another_clock_shows_nothing() {
        const OLD: [[f64; 5]; 5] = [
            [225.0, 238.0, 236.0, 298.0, 317.0],
            [172.0, 198.0, 262.0, 342.0, 333.0],
            [231.0, 394.0, 413.0, 446.0, 454.0],
            [317.0, 529.0, 524.0, 609.0, 607.0],
            [907.0, 1002.0, 1129.0, 1111.0, 1128.0],
        ];
        const NEW: [[f64; 5]; 5] = [
            [264.0, 266.0, 323.0, 329.0, 290.0],
            [287.0, 280.0, 358.0, 339.0, 361.0],
            [424.0, 415.0, 465.0, 466.0, 459.0],
            [588.0, 541.0, 644.0, 645.0, 654.0],
            [1082.0, 1070.0, 1140.0, 1119.0, 979.0],
        ];
        let session = |times: [[f64; 5]; 5]| -> Vec<Point> {
            let timing = |cpu: f64| Timing { wall: cpu, cpu, start_up: 0.0, reference: 400.0 };
            times.iter().enumerate().map(|(at, times)| point(&format!("dt={at}"), times.map(timing).to_vec())).collect()
        };
        assert_eq!(compare(&session(OLD), &session(NEW)), []);
    }

    #[test]
    fn a_faster_one_shows_and_is_not_worse() {
        let changes = compare(&session(1, 1.5, 8, 5), &session(2, 1.0, 8, 5));
        assert!(changes.len() == 2 && !changes[0].worse, "{changes:?}");
    }

    #[test]
    fn one_repetition_of_two_points_decides_no_time() {
        assert_eq!(compare(&session(1, 1.0, 2, 1), &session(2, 1.25, 2, 1)), []);
    }

    #[test]
    fn sessions_without_a_common_point_are_red() {
        let (old, new) = (session(1, 1.0, 3, 5), session(2, 1.0, 8, 5));
        let changes = compare(&[], &new);
        assert!(changes.len() == 1 && changes[0].worse && changes[0].what == "nothing compared", "{changes:?}");
        let other: Vec<Point> = old.iter().map(|old| Point { solver: "mpm".to_owned(), ..old.clone() }).collect();
        let changes = compare(&other, &new);
        assert!(changes.len() == 2 && changes[0].worse && !changes[1].worse, "{changes:?}");
        assert_eq!(changes[1].what, "squash/plain · mpm");
        let changes = compare(&new, &old);
        assert_eq!(changes.len(), 1, "{changes:?}");
        assert!(!changes[0].worse && changes[0].how == "5 points of the old session were not measured again");
        assert_eq!((shared(&new, &old), shared(&old, &new), shared(&other, &new)), (3, 3, 0));
    }

    #[test]
    fn counts_are_compared_exactly() {
        let old = session(1, 1.0, 3, 5);
        let mut new = session(2, 1.0, 3, 5);
        new[1].counts.steps += 1;
        let changes = compare(&old, &new);
        assert_eq!(changes.len(), 1);
        assert!(changes[0].worse && changes[0].how == "steps 100 → 101", "{changes:?}");
    }
}
