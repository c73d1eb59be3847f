//! Coverage of a run by the output. Claims about the whole run need output to its end.

use super::start::at;
use super::subject::Candidate;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::{Bound, ExpectedValue, Measurement};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_solver::record::Series;

/// Output of a program, and the scene to which it belongs.
pub(super) struct CheckedOutput<'c> {
    pub(super) candidate: &'c Candidate,
    pub(super) outputs: &'c Outputs,
    pub(super) observed: &'c DumpRecord,
    pub(super) covered: Coverage,
    /// Result without a quantity. It names the scene, the variant, the files and their time step.
    pub(super) open: Verdict,
}

impl CheckedOutput<'_> {
    /// Returns a result about a quantity before it is judged.
    pub(super) fn row(&self, quantity: impl Into<String>, unit: &str) -> Verdict {
        Verdict { quantity: quantity.into(), unit: unit.to_owned(), ..self.open.clone() }
    }

    /// Returns the same output with other samples.
    pub(super) fn with<'o>(&'o self, observed: &'o DumpRecord) -> CheckedOutput<'o> {
        CheckedOutput { observed, covered: self.covered.by(observed), open: self.open.clone(), ..*self }
    }
}

/// Accepted rounding error of a time that a program prints with few digits, as a fraction of the duration of the run.
const PRINTED: f64 = 1e-6;

/// Longest accepted time between samples, as a fraction of the duration of the run, unless the scene samples less
/// often. Samples farther apart can hide an excursion.
const PART: f64 = 0.1;

/// First words of the detail of a result whose samples are too far apart.
pub(super) const SPARSE: &str = "no sample for ";

/// Interval between two consecutive samples (s).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gap {
    from: f64,
    to: f64,
}

impl Gap {
    /// Returns the longest interval between sample times (s). The first interval begins at time 0.
    fn longest(times: impl Iterator<Item = f64>) -> Self {
        let (mut longest, mut from) = (Self { from: 0.0, to: 0.0 }, 0.0);
        for to in times {
            if to - from > longest.to - longest.from {
                longest = Self { from, to };
            }
            from = to;
        }
        longest
    }

    fn length(self) -> f64 {
        self.to - self.from
    }
}

/// Returns the duration of a run (s). `None` if the duration is a number of cycles and the time step (s) is unknown.
fn whole(scene: &Scene, step: Option<f64>) -> Option<f64> {
    match scene.duration {
        Duration::Seconds(seconds) => Some(seconds),
        Duration::Cycles(cycles) => step.map(|step| step * cycles as f64),
    }
}

/// Returns the sampling interval of a scene as a fraction of the run; zero if it depends on an unknown time step (s).
fn interval(scene: &Scene, step: Option<f64>) -> f64 {
    let Some(whole) = whole(scene, step) else { return 0.0 };
    match scene.sampling {
        Sampling::Seconds(interval) => interval / whole,
        Sampling::Cycles(cycles) => step.map_or(0.0, |step| step * cycles as f64 / whole),
        Sampling::Count(count) => 1.0 / count.max(1) as f64,
    }
}

/// Coverage of a run by the samples of the output.
#[derive(Clone, Copy)]
pub(super) struct Coverage {
    /// Time of the last sample (s).
    pub(super) reached: f64,
    /// Duration of the run (s); `None` if it depends on an unknown time step.
    whole: Option<f64>,
    /// Accepted time from the last sample to the end (s).
    slack: f64,
    samples: usize,
    /// Longest accepted interval between samples (s). It is the larger of a tenth of the run and the scene's sampling
    /// interval without `--set`, plus one step for rounding. `None` if the duration is unknown.
    most: Option<f64>,
    /// Longest interval between samples.
    gap: Gap,
    /// True if the output may cover only a part of the run.
    partial: bool,
}

impl Coverage {
    /// Computes the coverage. `step` is the time step of the output (s), if it is known. Samples after the end of the
    /// scene are removed, because the scene does not define them.
    pub(super) fn new(candidate: &Candidate, step: Option<f64>, observed: &mut DumpRecord, partial: bool) -> Self {
        let whole = whole(&candidate.scene, step);
        // A wrong time step in the output must not make an early sample count as the end.
        let most = 0.01 * whole.unwrap_or_default();
        let slack = (0.5 * step.unwrap_or_default()).min(most) + PRINTED * whole.unwrap_or_default();
        if let Some(whole) = whole {
            observed.keep(observed.series.time.partition_point(|&time| time <= whole + slack));
        }
        let part = candidate.own.as_ref().map_or(0.0, |own| interval(own, step));
        // Samples can only be taken at whole steps.
        let rounding = step.unwrap_or_default().min(most) + PRINTED * whole.unwrap_or_default();
        let most = whole.map(|whole| part.max(PART) * whole + rounding);
        let time = &observed.series.time;
        let reached = time.last().copied().unwrap_or_default();
        let gap = Gap::longest(time.iter().copied());
        Self { reached, whole, slack, samples: time.len(), most, gap, partial }
    }

    /// Returns the coverage of the run by part of the samples.
    fn by(self, observed: &DumpRecord) -> Self {
        let time = &observed.series.time;
        Self { reached: time.last().copied().unwrap_or_default(), samples: time.len(), ..self }
    }

    /// Returns true if the output reaches the end of the run.
    fn is_whole(&self) -> bool {
        self.whole.is_some_and(|whole| self.reached >= whole - self.slack)
    }

    /// Returns the number of compared samples and, if the output ends early, the time of the last sample.
    pub(super) fn words(&self) -> String {
        let samples = match self.samples {
            1 => "one sample".to_owned(),
            samples => format!("worst of {samples} samples"),
        };
        if self.is_whole() { samples } else { format!("{samples} to t = {} s", number::significant(self.reached, 6)) }
    }

    /// Makes a passed result amber if some samples were not compared, because no step of our run has their time.
    pub(super) fn all(&self, compared: usize, row: Verdict) -> Verdict {
        let missing = self.samples.saturating_sub(compared);
        if missing == 0 || row.outcome != Outcome::Pass {
            return row;
        }
        let reason = format!("{missing} samples are not compared, because no step of the run has their times");
        row.left(Outcome::NoReference, reason)
    }

    /// Returns the reason why claims about the whole run cannot be judged; `None` if the output covers the whole run.
    pub(super) fn why_not(&self) -> Option<String> {
        let short = || match self.whole {
            Some(whole) => format!("{} s of {} s", number::significant(self.reached, 6), number::significant(whole, 6)),
            None => "an unknown part of the run, because the time step is unknown (--time-step sets it)".to_owned(),
        };
        (!self.is_whole()).then(|| format!("the files cover {}", short()))
    }

    /// Returns the series with an additional, wrong sample in the middle of the longest interval between samples. Its
    /// values are wrong by `part` times (1 + the largest magnitude of the column). Returns `None` if the interval is
    /// short enough, or if the duration of the run is unknown.
    pub(super) fn with_wrong_sample(&self, series: &Series, part: f64) -> Option<Series> {
        self.most.filter(|most| self.gap.length() > *most)?;
        let mut series = series.clone();
        let at = series.time.partition_point(|&time| time < self.gap.to);
        let before = at.saturating_sub(1);
        let step = series.step.get(before).zip(series.step.get(at)).map_or(0, |(a, b)| a + (b - a) / 2);
        series.step.insert(at.min(series.step.len()), step);
        series.time.insert(at, 0.5 * (self.gap.from + self.gap.to));
        for values in &mut series.values {
            let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
            let wrong = values.get(before).copied().unwrap_or_default() + part * (1.0 + largest);
            values.insert(at.min(values.len()), wrong);
        }
        Some(series)
    }

    /// Adds the longest accepted interval between samples to the reason of a result. The result is red if the samples
    /// are farther apart, and amber if the output is declared partial.
    pub(super) fn dense(&self, row: Verdict) -> Verdict {
        let (Some(most), true) = (self.most, row.value.is_some()) else { return row };
        let [limit, length, from] = [most, self.gap.length(), self.gap.from].map(|time| number::significant(time, 6));
        let because = format!("{}; samples at most {limit} s apart", row.because);
        let row = Verdict { because, ..row };
        if row.outcome != Outcome::Pass || self.gap.length() <= most {
            return row;
        }
        let found = format!("{SPARSE}{length} s from t = {from} s; at most {limit} s is allowed");
        if self.partial {
            return row.left(Outcome::Known, format!("{found}; accepted because of --partial"));
        }
        row.left(Outcome::Fail, format!("{found}; --partial judges the existing samples"))
    }

    /// Checks the interval between samples, as [`Self::dense`] does. In addition, a passed result becomes amber if the
    /// compared samples, at `times` (s), are too far apart.
    pub(super) fn dense_in(&self, times: impl Iterator<Item = f64>, row: Verdict) -> Verdict {
        let row = self.dense(row);
        let gap = Gap::longest(times);
        if row.outcome != Outcome::Pass || self.most.is_none_or(|most| gap.length() <= most) {
            return row;
        }
        let [length, from] = [gap.length(), gap.from].map(|time| number::significant(time, 6));
        let reason = format!("no sample at the times of the stored run for {length} s from t = {from} s");
        row.left(Outcome::NoReference, reason)
    }

    /// Returns the result about the coverage itself. It is red if the output ends early (amber if the output is
    /// declared partial), and amber if the duration of the run is unknown.
    pub(super) fn row(&self, outputs: &Outputs, row: Verdict) -> Verdict {
        let origin = outputs.origin().map(|origin| format!("; times count from the first sample, {}", at(origin)));
        let row = Verdict {
            evidence: Evidence::Invariant,
            source: "duration of the scene".to_owned(),
            tolerance: ToleranceOrigin::Exact,
            because: format!(
                "a run is judged only if its end is known; the tolerance is half a step plus the digits of the time{}",
                origin.unwrap_or_default()
            ),
            ..row
        };
        let Some(whole) = self.whole else { return row.left(Outcome::NoReference, self.why_not().unwrap_or_default()) };
        let end = ExpectedValue::Bound(Bound::AtLeast(whole));
        let row = Verdict { allowed: self.slack / whole, ..row }.judged(&Measurement::new(self.reached, end, whole));
        if let [cut, ..] = &outputs.cuts[..] {
            return row.left(Outcome::Known, format!("only the complete frames are judged (--partial): {cut}"));
        }
        match (row.outcome, self.partial) {
            (Outcome::Fail, true) => row.left(Outcome::Known, "accepted because of --partial"),
            (Outcome::Fail, false) => {
                let shown = self.why_not().unwrap_or_default();
                row.left(Outcome::Fail, format!("{shown}; --partial judges the existing samples"))
            }
            _ => row,
        }
    }
}
