//! Predictability horizon of a run. After it, means over time are compared: of quantities of the whole system, of forces on
//! walls, and of numbers of grains.

use super::covered::CheckedOutput;
use super::ours::{FLOOR, Plan, compare, convention, is_compared, nearest_first, ours, until};
use grainbench_harness::compare::peers::{Peer, WIDE, together};
use grainbench_harness::expect::Measurement;
use grainbench_harness::statistics::{BLOCKS, CONFIDENCE, next_mean, next_value};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reports::number;
use grainbench_scene::scene::{ProbeTarget, Scene};
use grainbench_solver::perturbed::PARTED;
use grainbench_solver::record::{Column, Series, Snapshot};

/// Number of perturbed runs from which the scatter of means is measured.
const PERTURBED: u32 = 3;
/// Fraction of the discharge of our runs at which the measurement of the flow rate ends.
const DISCHARGED: f64 = 0.9;

/// Returns the scene with one grain moved by a multiple of the rounding error of its position. The largest coordinate counts,
/// because a coordinate near zero has a smaller rounding error than the distances to other grains.
fn moved(scene: &Scene, times: u32) -> Scene {
    let (mut scene, middle) = (scene.clone(), scene.grains.len() / 2);
    if let Some(grain) = scene.grains.get_mut(middle) {
        grain.position.x += f64::from(times) * f64::EPSILON * grain.position.amax().max(grain.radius);
    }
    scene
}

/// Returns the horizon (s), shortened to the last time at which a run agrees with the run at smaller time steps. In a run
/// that amplifies rounding errors, the error of the time step grows in the same way, and no longer gives a tolerance.
fn shortened(horizon: f64, run: &Peer) -> f64 {
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

/// Our runs of a scene.
pub(super) struct OwnRuns {
    pub(super) plan: Plan,
    /// Name of the chosen contact convention; `None` for the nearest one.
    choice: Option<&'static str>,
    /// Runs, with the nearest or chosen convention first.
    pub(super) peers: Vec<Peer>,
    /// Last snapshot of the first run.
    pub(super) end: Option<Snapshot>,
    /// Predictability horizon (s); `None` if the run is predictable to its end.
    pub(super) horizon: Option<f64>,
    /// Runs with one grain moved by one or more rounding errors. They are complete if there is a horizon.
    perturbed: Vec<Series>,
}

impl OwnRuns {
    /// Runs a scene with each of our contact conventions, and perturbed scenes in which one grain is moved by rounding
    /// errors. The first perturbed run has the chosen or the default convention. With a chosen convention, all perturbed
    /// runs have it. Otherwise each has another convention.
    pub(super) fn new(
        scene: &Scene,
        plan: Plan,
        observed: &DumpRecord,
        choice: Option<&'static str>,
    ) -> Result<Self, String> {
        let (mut peers, mut ends) = ours(scene, &plan)?;
        let perturbed_run =
            |times: u32, peer: &Peer| plan.run(&moved(scene, times), convention(peer), 1).map(|record| record.series);
        let (mut horizon, mut perturbed) = (None, Vec::new());
        if scene.grains.len() > 1 {
            let own = peers.iter().find(|peer| choice == Some(&peer.name)).unwrap_or(&peers[0]);
            perturbed.push(perturbed_run(1, own)?);
            horizon = parted(&own.series, &perturbed[0], PARTED, false);
        }
        let nearest = nearest_first(scene, &plan, &mut peers, observed, horizon, choice)?;
        if let Some(time) = horizon {
            for times in 2..=PERTURBED {
                let place = if choice.is_none() { times as usize % peers.len() } else { 0 };
                perturbed.push(perturbed_run(times, &peers[place])?);
            }
            horizon = Some(shortened(time, &peers[0]));
        }
        Ok(Self { plan, choice, end: ends.swap_remove(nearest), peers, horizon, perturbed })
    }

    /// Compares the output with our runs, sample by sample up to the horizon and by means after it.
    pub(super) fn compare(&self, output: &CheckedOutput<'_>) -> Vec<Verdict> {
        let (peers, seen) = until(self.horizon, &self.peers, output.observed);
        let mut rows = compare(&peers, self.choice, &output.with(&seen));
        rows.extend(self.horizon.into_iter().flat_map(|horizon| self.beyond(horizon, output)));
        rows
    }
}

/// Column after the horizon: one series of the output and one of each of our runs, with the same times.
struct Tail {
    times: Vec<f64>,
    found: Vec<f64>,
    ours: Vec<Vec<f64>>,
}

impl Tail {
    /// Keeps the samples between two indices.
    fn cut(&mut self, from: usize, to: usize) {
        let cut = |values: &mut Vec<f64>| {
            values.truncate(to);
            values.drain(..from.min(values.len()));
        };
        cut(&mut self.times);
        cut(&mut self.found);
        self.ours.iter_mut().for_each(cut);
    }

    /// Replaces numbers of grains that have left by the rate of each interval between samples (1/s). Only the time of
    /// discharge is kept: from the first grain that leaves one of our runs until one run has reached [`DISCHARGED`] of our
    /// discharge. Later, only stragglers leave an emptying hopper.
    fn become_rates(&mut self) {
        let discharge = |values: &Vec<f64>| Some(values.last()? - values.first()?);
        let least = self.ours.iter().filter_map(discharge).fold(f64::INFINITY, f64::min);
        let reach = |values: &[f64], most: f64| {
            let start = values.first().copied().unwrap_or_default();
            values.iter().position(|value| value - start > 0.0 && value - start >= most).unwrap_or(values.len())
        };
        let begin = self.ours.iter().map(|run| reach(run, 0.0)).min().unwrap_or_default().saturating_sub(1);
        let all = self.ours.iter().chain([&self.found]).map(|run| reach(run, DISCHARGED * least));
        // A discharge that is much faster still has the intervals that its rate needs.
        let end = all.min().unwrap_or_default().max(begin + BLOCKS);
        self.cut(begin, end + 1);
        self.found = rates(&self.times, &self.found);
        self.ours = self.ours.iter().map(|run| rates(&self.times, run)).collect();
    }

    /// Returns true if a mean lies in the prediction interval of one more convention, from the means of the first runs, which
    /// have different conventions.
    fn is_between(&self, conventions: usize, found: f64) -> bool {
        let means: Vec<f64> = self.ours.iter().take(conventions).map(|run| mean(run.iter().copied())).collect();
        next_value(&means).is_some_and(|(mean, half_width)| (found - mean).abs() <= half_width)
    }

    /// Returns the mean of the output, the mean of our runs with their smallest and largest mean, and the mean magnitude of
    /// our runs.
    fn means(&self) -> (f64, [f64; 3], f64) {
        let ours: Vec<f64> = self.ours.iter().map(|run| mean(run.iter().copied())).collect();
        let [low, high] = [f64::min, f64::max].map(|pick| ours.iter().copied().reduce(pick).unwrap_or(f64::NAN));
        let magnitude = mean(self.ours.iter().flatten().map(|value| value.abs()));
        (mean(self.found.iter().copied()), [mean(ours.iter().copied()), low, high], magnitude)
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

impl OwnRuns {
    /// Compares means over the time after the horizon (s). Only columns of the whole system and of walls are compared.
    fn beyond(&self, horizon: f64, output: &CheckedOutput<'_>) -> Vec<Verdict> {
        let (scene, observed) = (&output.candidate.scene, output.observed);
        let conventions = if self.choice.is_none() { &self.peers[..] } else { &self.peers[..1] };
        let half_step = self.peers[0].half_step.as_ref();
        let runs: Vec<&Series> =
            conventions.iter().map(|peer| &peer.series).chain(half_step).chain(&self.perturbed).collect();
        let columns = observed.series.columns.iter().zip(&observed.series.values).zip(&observed.uncertainty);
        let compared: Vec<_> = columns
            .filter(|((column, _), _)| is_of_all(scene, &column.name) && !is_rest(scene, &column.name))
            .filter_map(|((column, values), open)| {
                let together = |run: &&Series| together(&observed.series, values, run, &column.name);
                let all = runs.iter().map(together).collect::<Option<Vec<_>>>()?;
                let (times, found, _) = all.first()?.clone();
                let mut tail = Tail { times, found, ours: all.into_iter().map(|(_, _, ours)| ours).collect() };
                let from = tail.times.partition_point(|&time| time <= horizon);
                if is_rate(&column.name) {
                    tail.cut(from.saturating_sub(1), usize::MAX);
                    tail.become_rates();
                } else {
                    tail.cut(from, usize::MAX);
                }
                Some((column, tail, open.iter().copied().fold(0.0, f64::max)))
            })
            .collect();
        let count = compared.len();
        let judge = |(column, tail, open): &(&Column, Tail, f64)| {
            let (mean, unit) =
                if is_rate(&column.name) { ("mean rate", "1/s") } else { ("mean", column.unit.as_str()) };
            let [from, to] = [tail.times.first(), tail.times.last()]
                .map(|time| number::significant(time.copied().unwrap_or(horizon), 4));
            let row = Verdict {
                source: format!("mean of {} runs of our solver, after the predictability horizon", runs.len()),
                tolerance: ToleranceOrigin::Interval,
                because: format!(
                    "{} % prediction interval for one more run, from the scatter of our runs in {BLOCKS} blocks of time \
                     ({}half the time step, {} perturbed); {count} means are judged together",
                    100.0 * CONFIDENCE,
                    if conventions.len() > 1 { format!("{} conventions, ", conventions.len()) } else { String::new() },
                    self.perturbed.len(),
                ),
                ..output.row(format!("{}, {mean} from t = {from} s to {to} s", column.name), unit)
            };
            // A grain may cross the edge of a box shortly before the last sample in one run and after it in another.
            let span = tail.times.last().zip(tail.times.first()).map_or(0.0, |(last, first)| last - first);
            let floor = if is_rate(&column.name) { (1.0 + 2.0 * open) / span } else { *open };
            judge_mean(row, tail, (count, floor), conventions.len())
        };
        compared.iter().map(judge).collect()
    }
}

/// Returns the change between samples divided by the mean time between samples (1/s). The mean of these rates is the flow
/// rate, also if the times between the samples differ.
fn rates(times: &[f64], values: &[f64]) -> Vec<f64> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let step = (last - first) / (times.len() - 1) as f64;
    values.windows(2).map(|value| (value[1] - value[0]) / step).collect()
}

/// Judges a mean. `count` is the number of means that are judged together, and `floor` a difference of the means that is
/// allowed in addition. The first `conventions` of our runs have different contact conventions. The result is amber if the
/// interval is too wide, if there are too few samples, or if our conventions differ by as much as the output.
fn judge_mean(row: Verdict, tail: &Tail, (count, floor): (usize, f64), conventions: usize) -> Verdict {
    let ours: Vec<&[f64]> = tail.ours.iter().map(Vec::as_slice).collect();
    let Some((_, half_width)) = next_mean(&ours, BLOCKS, count) else {
        return row.left(Outcome::NoReference, format!("fewer than {BLOCKS} samples lie in this time"));
    };
    let (found, [expected, low, high], magnitude) = tail.means();
    // The largest value may be a single impact, or the rate between two samples that lie close together. The mean magnitude
    // is the scale of the mean.
    let scale = if magnitude > 0.0 { magnitude } else { found.abs().max(f64::MIN_POSITIVE) };
    let row = Verdict { allowed: (half_width + floor) / scale + FLOOR, ..row };
    let row = row.judged(&Measurement::new(found, expected, scale));
    match row.outcome {
        Outcome::Fail if tail.is_between(conventions, found) => {
            let reason = "inconclusive: the output lies in the 99 % interval of the means of our conventions \
                          (--convention selects one)";
            row.left(Outcome::NoReference, reason)
        }
        Outcome::Fail if row.error.is_some() => {
            let [low, high] = [low, high].map(|value| number::significant(value, 4));
            let side = if found.abs() > expected.abs() { "larger" } else { "smaller" };
            let off = number::fraction((found - expected).abs() / scale);
            let detail = format!("{off} {side} than the mean of our runs, whose means lie between {low} and {high}");
            Verdict { detail: Some(detail), ..row }
        }
        Outcome::Pass if row.allowed > WIDE => {
            let span = tail.times.last().zip(tail.times.first()).map_or(0.0, |(last, first)| last - first);
            let times = (row.allowed / WIDE).powi(2);
            let begin = tail.times.first().copied().unwrap_or_default();
            let [most, times, begin, end] = [
                number::fraction(row.allowed),
                number::significant(times, 2),
                number::significant(begin, 2),
                number::significant(begin + times * span, 2),
            ];
            let reason = format!(
                "inconclusive: the interval is {most} of the mean magnitude; it narrows to {} % if the time after t = {begin} \
                 s is {times} times as long, to t = {end} s",
                100.0 * WIDE
            );
            row.left(Outcome::NoReference, reason)
        }
        _ => row,
    }
}

/// Returns true if a column counts grains that have left. The mean rate of such a column is the flow rate.
fn is_rate(name: &str) -> bool {
    name.ends_with(".left")
}

/// Returns true if a column follows from the number of grains that have left, because no grain is poured.
fn is_rest(scene: &Scene, name: &str) -> bool {
    name.ends_with(".present") && scene.stays.entries.is_empty() && scene.stays.removal.is_some()
}

/// Returns true if the mean of a column is compared, but not its samples. The height of a packing is its gravitational energy
/// over its weight.
pub(super) fn is_only_mean(name: &str) -> bool {
    name.ends_with(".gravitational_energy")
}

/// Returns true if the mean of a column is compared: of the whole system, of a wall, or of a number of grains.
fn is_of_all(scene: &Scene, name: &str) -> bool {
    let probe = name.rsplit_once('.').and_then(|(probe, _)| scene.probes.iter().find(|other| other.name == probe));
    let is_of_all = |target: ProbeTarget| {
        matches!(target, ProbeTarget::System | ProbeTarget::Wall(_) | ProbeTarget::Stress | ProbeTarget::Count)
    };
    (is_compared(name) || is_only_mean(name)) && probe.is_some_and(|probe| is_of_all(probe.target))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tail(found: Vec<f64>, ours: Vec<Vec<f64>>) -> Tail {
        let times = (0..found.len()).map(|at| 0.01 * at as f64).collect();
        Tail { times, found, ours }
    }

    fn verdict(tail: &Tail) -> Verdict {
        judge_mean(Verdict::open("heap", "wall.force_y", "N"), tail, (1, 0.0), 1)
    }

    /// Ten grains leave in two seconds, most of them between two close samples.
    #[test]
    fn the_mean_of_the_rates_is_the_flow_rate() {
        let found = rates(&[1.0, 1.5, 1.501, 3.0], &[0.0, 1.0, 9.0, 10.0]);
        let mean = found.iter().sum::<f64>() / found.len() as f64;
        assert!((mean - 5.0).abs() < 1e-12, "{mean} 1/s");
    }

    /// Both hoppers are empty at the end. The flow rate is measured while both discharge.
    #[test]
    fn a_faster_discharge_has_a_larger_rate() {
        let discharge = |rate: usize| -> Vec<f64> {
            (0..400).map(|at: usize| (at.saturating_sub(50) * rate).min(900) as f64).collect()
        };
        let mut tail = tail(discharge(6), vec![discharge(5); 3]);
        tail.become_rates();
        let (found, [expected, ..], _) = tail.means();
        assert!((found / expected - 1.2).abs() < 0.02, "{found} {expected}");
        // A jam after 40 grains has less than a third of the rate.
        let jam = discharge(5).into_iter().map(|left| left.min(40.0)).collect();
        let mut tail = super::tests::tail(jam, vec![discharge(5); 3]);
        tail.become_rates();
        let (found, [expected, ..], _) = tail.means();
        assert!(found < 0.1 * expected, "{found} {expected}");
        // A discharge that ends after a few samples has a larger rate, and fails.
        let mut tail = super::tests::tail(discharge(60), vec![discharge(5), discharge(5), discharge(6)]);
        tail.become_rates();
        assert_eq!(verdict(&tail).outcome, Outcome::Fail);
    }

    /// A mean that differs from all our runs fails if our conventions agree, and is inconclusive if they differ by as much.
    #[test]
    fn conventions_that_differ_leave_a_mean_open() {
        let run = |mean: f64, seed: u64| -> Vec<f64> {
            (0..400_u64).map(|at| mean + 1e-2 * ((at * at * 31 + 7 * at * seed) % 97) as f64 / 97.0).collect()
        };
        let outcome = |scatter: f64| {
            let ours =
                (0..8_u64).map(|at| run(1.0 + if at < 4 { scatter * at as f64 } else { 0.0 }, 11 + at)).collect();
            judge_mean(Verdict::open("heap", "wall.force_y", "N"), &tail(run(1.1, 5), ours), (1, 0.0), 4).outcome
        };
        assert_eq!([outcome(1e-4), outcome(1.3e-2)], [Outcome::Fail, Outcome::NoReference]);
    }

    /// Equal means pass if their interval is narrow. A single peak widens the interval, but the mean is not known better
    /// because of the peak. The result says how long a run must be.
    #[test]
    fn a_peak_leaves_the_mean_inconclusive() {
        let values = |place: u64, peak: f64| -> Vec<f64> {
            let noise = |at: u64| 1e-2 * ((at * at * 31 + 7 * at * place) % 97) as f64 / 97.0;
            (0..400).map(|at| if at == place { peak } else { 1.0 + noise(at) }).collect()
        };
        let verdict = |peak: f64| {
            let ours = (1..8).map(|run| values(47 * run, peak)).collect();
            super::tests::verdict(&tail(values(150, peak), ours))
        };
        assert_eq!([verdict(1.0).outcome, verdict(1e4).outcome], [Outcome::Pass, Outcome::NoReference]);
        let detail = verdict(1e4).detail.unwrap_or_default();
        assert!(detail.contains(" times as long, to t = "), "{detail}");
        let wrong = values(150, 1.0).iter().map(|value| 1.1 * value).collect();
        let wrong = super::tests::verdict(&tail(wrong, (1..8).map(|run| values(47 * run, 1.0)).collect()));
        let detail = wrong.detail.unwrap_or_default();
        assert!(wrong.outcome == Outcome::Fail && detail.contains(" larger than the mean of our runs"), "{detail}");
    }
}
