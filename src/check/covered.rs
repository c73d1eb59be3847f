//! Part of a run that the output covers. Claims about the whole run need output to its end.

use super::start::at;
use super::subject::Candidate;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::{Bound, ExpectedValue, Measurement};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;
use grainbench_scene::record::Series;
use grainbench_scene::scene::{Duration, Sampling, Scene};

/// Accepted distance of the last sample from the end, as a fraction of the run, because times are printed with few
/// digits.
const PRINTED: f64 = 1e-6;

/// Longest time between samples, as a fraction of the run. Coarser samples can hide an excursion of a tenth of the run.
const PART: f64 = 0.1;

/// Interval between two consecutive samples (s).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gap {
    from: f64,
    to: f64,
}

impl Gap {
    /// Returns the longest interval between some sample times (s). The run starts at time 0.
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

/// Returns the duration of a run (s) with a time step (s); `None` if it is a number of cycles of unknown length.
fn whole(scene: &Scene, step: Option<f64>) -> Option<f64> {
    match scene.duration {
        Duration::Seconds(seconds) => Some(seconds),
        Duration::Cycles(cycles) => step.map(|step| step * cycles as f64),
    }
}

/// Returns the sampling interval of a scene as a fraction of its run; zero if the time step (s) is needed and unknown.
fn interval(scene: &Scene, step: Option<f64>) -> f64 {
    let Some(whole) = whole(scene, step) else { return 0.0 };
    match scene.sampling {
        Sampling::Seconds(interval) => interval / whole,
        Sampling::Cycles(cycles) => step.map_or(0.0, |step| step * cycles as f64 / whole),
        Sampling::Count(count) => 1.0 / count.max(1) as f64,
    }
}

/// Coverage of a scene's run by the output.
#[derive(Clone, Copy)]
pub(super) struct Coverage {
    /// Time of the last sample (s).
    pub(super) reached: f64,
    /// Duration of the run (s); `None` if it is a number of cycles of unknown length.
    whole: Option<f64>,
    /// Accepted time from the last sample to the end (s).
    slack: f64,
    samples: usize,
    /// Longest interval between samples that a result may depend on (s): the larger of the sampling interval that the
    /// scene has before any `--set`, and a tenth of the run. `None` if the duration of the run is unknown.
    most: Option<f64>,
    /// Longest interval between samples.
    gap: Gap,
    /// True if the output may cover only a part of the run.
    partial: bool,
}

impl Coverage {
    /// Computes the coverage from the time step of the output (s), if it is known. Removes samples after the end of the
    /// scene, because the scene does not define them.
    pub(super) fn new(candidate: &Candidate, step: Option<f64>, observed: &mut DumpRecord, partial: bool) -> Self {
        let whole = whole(&candidate.scene, step);
        // A wrongly reported time step must not make an early sample count as the end.
        let most = 0.01 * whole.unwrap_or_default();
        let slack = (0.5 * step.unwrap_or_default()).min(most) + PRINTED * whole.unwrap_or_default();
        if let Some(whole) = whole {
            observed.keep(observed.series.time.partition_point(|&time| time <= whole + slack));
        }
        let part = candidate.own.as_ref().map_or(0.0, |own| interval(own, step));
        // Samples lie at whole steps.
        let rounding = step.unwrap_or_default().min(most) + PRINTED * whole.unwrap_or_default();
        let most = whole.map(|whole| part.max(PART) * whole + rounding);
        let time = &observed.series.time;
        let reached = time.last().copied().unwrap_or_default();
        let gap = Gap::longest(time.iter().copied());
        Self { reached, whole, slack, samples: time.len(), most, gap, partial }
    }

    /// Returns the coverage by a part of the samples.
    pub(super) fn by(self, observed: &DumpRecord) -> Self {
        let time = &observed.series.time;
        Self { reached: time.last().copied().unwrap_or_default(), samples: time.len(), ..self }
    }

    /// Returns true if the output reaches the end of the run.
    pub(super) fn is_whole(&self) -> bool {
        self.whole.is_some_and(|whole| self.reached >= whole - self.slack)
    }

    /// Returns the number of samples of a comparison, and its end if the output stops early, in words.
    pub(super) fn words(&self) -> String {
        let samples = format!("worst of {} samples", self.samples);
        if self.is_whole() { samples } else { format!("{samples} to t = {} s", number::significant(self.reached, 6)) }
    }

    /// Makes a result amber if some samples were not compared, because our run has none at their times.
    pub(super) fn all(&self, compared: usize, row: Verdict) -> Verdict {
        let missing = self.samples.saturating_sub(compared);
        if missing == 0 || row.outcome != Outcome::Pass {
            return row;
        }
        row.left(Outcome::NoReference, format!("{missing} samples are missing: no step of the run has their times"))
    }

    /// Returns the reason why claims about the whole run have no result; `None` if the output covers the whole run.
    pub(super) fn why_not(&self) -> Option<String> {
        let short = || match self.whole {
            Some(whole) => format!("{} s of {} s", number::significant(self.reached, 6), number::significant(whole, 6)),
            None => "an unknown part, because the time step is unknown (--time-step sets it)".to_owned(),
        };
        (!self.is_whole()).then(|| format!("the files show {}", short()))
    }

    /// Returns the series with a wrong sample in the middle of the longest interval between samples. The values are
    /// wrong by `part` times the sum of 1 and the largest magnitude of the column. Returns `None` if the samples are
    /// dense enough.
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

    /// Adds the longest accepted interval between samples to a result that needs samples of the whole run. The result
    /// is red if samples lie farther apart, and amber if the output is declared partial.
    pub(super) fn dense(&self, row: Verdict) -> Verdict {
        let (Some(most), true) = (self.most, row.value.is_some()) else { return row };
        let [limit, length, from] = [most, self.gap.length(), self.gap.from].map(|time| number::significant(time, 6));
        let because = format!("{}; samples at most {limit} s apart", row.because);
        let row = Verdict { because, ..row };
        if row.outcome != Outcome::Pass || self.gap.length() <= most {
            return row;
        }
        let found = format!("no sample for {length} s from t = {from} s, above {limit} s");
        if self.partial {
            return row.left(Outcome::Known, format!("{found}; a part of the run is meant (--partial)"));
        }
        row.left(Outcome::Fail, format!("{found}; --partial judges the existing samples"))
    }

    /// Checks the interval between the sample times of a comparison (s): the result is amber if they lie too far apart.
    pub(super) fn dense_in(&self, times: impl Iterator<Item = f64>, row: Verdict) -> Verdict {
        let row = self.dense(row);
        let gap = Gap::longest(times);
        if row.outcome != Outcome::Pass || self.most.is_none_or(|most| gap.length() <= most) {
            return row;
        }
        let [length, from] = [gap.length(), gap.from].map(|time| number::significant(time, 6));
        row.left(
            Outcome::NoReference,
            format!("no sample at a time of the stored run for {length} s from t = {from} s"),
        )
    }

    /// Returns the result for the coverage itself. It is red if the output ends early, and amber if the output is
    /// declared partial.
    pub(super) fn row(&self, outputs: &Outputs, row: Verdict) -> Verdict {
        let row = Verdict {
            evidence: Evidence::Invariant,
            source: "duration of the scene".to_owned(),
            tolerance: ToleranceOrigin::Exact,
            because: format!(
                "a run is judged only if its end is known; half a step, plus the digits of the time{}",
                outputs
                    .origin()
                    .map(|origin| format!("; times count from the first sample, {}", at(origin)))
                    .unwrap_or_default()
            ),
            ..row
        };
        let Some(whole) = self.whole else { return row.left(Outcome::NoReference, self.why_not().unwrap_or_default()) };
        let end = ExpectedValue::Bound(Bound::AtLeast(whole));
        let row = Verdict { allowed: self.slack / whole, ..row }.judged(&Measurement::new(self.reached, end, whole));
        if let [cut, ..] = outputs.cuts() {
            return row.left(Outcome::Known, format!("whole frames before a cut are meant (--partial): {cut}"));
        }
        match (row.outcome, self.partial) {
            (Outcome::Fail, true) => row.left(Outcome::Known, "a part of the run is meant (--partial)"),
            (Outcome::Fail, false) => {
                let shown = self.why_not().unwrap_or_default();
                row.left(Outcome::Fail, format!("{shown}; --partial judges the existing samples"))
            }
            _ => row,
        }
    }
}
