//! How much of the run some outputs cover: what was not seen to its end is not judged.

use super::at;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::{Bound, Expected, Measured};
use grainbench_harness::tolerance::Made;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;
use grainbench_scene::scene::{Duration, Scene};

/// Part of the run that a time printed with few digits may be short of its end.
const PRINTED: f64 = 1e-6;

/// How far outputs reach into the run of a scene.
#[derive(Clone, Copy)]
pub(super) struct Covered {
    /// Time of the last sample (s).
    pub(super) reached: f64,
    /// Time of the run (s); none where it is a number of cycles of unknown length.
    whole: Option<f64>,
    /// Most that the last sample may be short of the end (s).
    slack: f64,
    samples: usize,
}

impl Covered {
    /// Of outputs with a time step (s), where that is known. Samples after the end of the scene are taken away: it says
    /// nothing of them.
    pub(super) fn of(scene: &Scene, step: Option<f64>, observed: &mut Observed) -> Self {
        let whole = match scene.duration {
            Duration::Seconds(seconds) => Some(seconds),
            Duration::Cycles(cycles) => step.map(|step| step * cycles as f64),
        };
        // A step that was told wrongly must not make an end of anything.
        let most = 0.01 * whole.unwrap_or_default();
        let slack = (0.5 * step.unwrap_or_default()).min(most) + PRINTED * whole.unwrap_or_default();
        if let Some(whole) = whole {
            observed.keep(observed.series.time.partition_point(|&time| time <= whole + slack));
        }
        let time = &observed.series.time;
        Self { reached: time.last().copied().unwrap_or_default(), whole, slack, samples: time.len() }
    }

    /// The same of a part of the samples.
    pub(super) fn by(self, observed: &Observed) -> Self {
        let time = &observed.series.time;
        Self { reached: time.last().copied().unwrap_or_default(), samples: time.len(), ..self }
    }

    /// Whether the end was seen.
    pub(super) fn is_whole(&self) -> bool {
        self.whole.is_some_and(|whole| self.reached >= whole - self.slack)
    }

    /// What a row says of the samples that it judged.
    pub(super) fn words(&self) -> String {
        let samples = format!("worst of {} samples", self.samples);
        if self.is_whole() { samples } else { format!("{samples} to t = {} s", number::significant(self.reached, 6)) }
    }

    /// Why a claim of the whole run is not judged; none where all of it was seen.
    pub(super) fn why_not(&self) -> Option<String> {
        let short = || match self.whole {
            Some(whole) => format!("{} s of {} s", number::significant(self.reached, 6), number::significant(whole, 6)),
            None => "an unknown part, for nothing tells the time step (--dt gives it)".to_owned(),
        };
        (!self.is_whole()).then(|| format!("the files show {}", short()))
    }

    /// The row that says it: red where less than the whole was seen, amber where that is meant.
    pub(super) fn row(&self, partial: bool, outputs: &Outputs, row: Verdict) -> Verdict {
        let row = Verdict {
            evidence: Evidence::Invariant,
            source: "duration of the scene".to_owned(),
            tolerance: Made::Exact,
            because: format!(
                "what was not seen to its end is not judged; half a step, and digits of the time{}",
                outputs
                    .origin()
                    .map(|origin| format!("; times count from the first sample, {}", at(origin)))
                    .unwrap_or_default()
            ),
            ..row
        };
        let Some(whole) = self.whole else { return row.left(Outcome::NoReference, self.why_not().unwrap_or_default()) };
        let end = Expected::Bound(Bound::AtLeast(whole));
        let row = Verdict { allowed: self.slack / whole, ..row }.judged(&Measured::new(self.reached, end, whole));
        if let [cut, ..] = outputs.cuts() {
            return row.left(Outcome::Known, format!("whole frames before a cut are meant (--partial): {cut}"));
        }
        match (row.outcome, partial) {
            (Outcome::Fail, true) => row.left(Outcome::Known, "a part of the run is meant (--partial)"),
            (Outcome::Fail, false) => {
                let shown = self.why_not().unwrap_or_default();
                row.left(Outcome::Fail, format!("{shown}; --partial judges what is there"))
            }
            _ => row,
        }
    }
}
