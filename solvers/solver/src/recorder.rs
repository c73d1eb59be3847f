//! Recorder of the time series and snapshots of a run, and of the steps at which they are due.

use crate::limits::interval;
use crate::probe;
use crate::record::{Series, Snapshot, StepState};
use crate::reduction::reduce;
use grainbench_scene::scene::Scene;
use serde::{Deserialize, Serialize};

/// Record of a run in progress.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Recorder {
    /// Steps between samples.
    interval: u64,
    /// Steps at which snapshots are due, in order.
    snapshot_steps: Vec<u64>,
    steps: u64,
    series: Series,
    snapshots: Vec<Snapshot>,
}

impl Recorder {
    /// Creates the recorder of a run of `steps` steps of `time_step` (s).
    #[must_use]
    pub fn new(scene: &Scene, time_step: f64, steps: u64) -> Self {
        let interval = interval(scene, time_step, steps);
        // There is at most one snapshot per step, even if the scene requests more.
        let parts = (u128::from(scene.snapshots) + 1).min(u128::from(steps.max(1)));
        let mut snapshot_steps: Vec<u64> = (0..=parts).map(|part| (u128::from(steps) * part / parts) as u64).collect();
        let nearest = |time: &f64| ((time / time_step).round() as u64).min(steps);
        snapshot_steps.extend(scene.snapshot_times.iter().map(nearest));
        snapshot_steps.sort_unstable();
        snapshot_steps.dedup();
        let series = probe::empty_series(scene);
        Self { interval, snapshot_steps, steps, series, snapshots: Vec::new() }
    }

    /// Returns true if all samples are finite. A run ends at the first sample that is not finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.series.time.iter().chain(self.series.values.iter().flatten()).all(|value| value.is_finite())
    }

    /// Returns true if this recorder belongs to the same run as `begun`. Both must record the same quantities at the
    /// same steps, and each column of this recorder must have one value per sample.
    #[must_use]
    pub fn is_of(&self, begun: &Self) -> bool {
        let Series { step, time, columns, values } = &self.series;
        let asks = |recorder: &Self| (recorder.interval, recorder.steps);
        let each = |column: &Vec<f64>| column.len() == time.len();
        asks(self) == asks(begun)
            && self.snapshot_steps == begun.snapshot_steps
            && *columns == begun.series.columns
            && values.len() == columns.len()
            && step.len() == time.len()
            && values.iter().all(each)
    }

    /// Returns the number of steps between samples.
    #[must_use]
    pub const fn interval(&self) -> u64 {
        self.interval
    }

    /// Returns true if a sample of the probes is due at a step: at the start, after every interval, and at the end.
    #[must_use]
    pub fn is_sample(&self, step: u64) -> bool {
        step.is_multiple_of(self.interval) || step == self.steps
    }

    /// Returns true if a snapshot is due at a step.
    #[must_use]
    pub fn is_snapshot(&self, step: u64) -> bool {
        self.snapshot_steps.binary_search(&step).is_ok()
    }

    /// Returns the steps at which snapshots are due, in order.
    #[must_use]
    pub fn snapshot_steps(&self) -> &[u64] {
        &self.snapshot_steps
    }

    /// Returns true if a sample or a snapshot is due at a step.
    #[must_use]
    pub fn is_due(&self, step: u64) -> bool {
        self.is_sample(step) || self.is_snapshot(step)
    }

    /// Returns the next step after `step` at which output is due; the last step if there is none.
    #[must_use]
    pub fn next(&self, step: u64) -> u64 {
        let sample = (step / self.interval + 1).saturating_mul(self.interval);
        let after = self.snapshot_steps.partition_point(|&due| due <= step);
        let snapshot = self.snapshot_steps.get(after).copied().unwrap_or(self.steps);
        sample.min(snapshot).min(self.steps)
    }

    /// Records the sample of a step, if one is due.
    pub fn sample(&mut self, scene: &Scene, look: &StepState) {
        if self.is_sample(look.snapshot.step) {
            probe::sample(&mut self.series, scene, look);
        }
    }

    /// Records the time of a sample (s) for a scene without probes, if a sample is due at the step.
    pub fn sample_nothing(&mut self, step: u64, time: f64) {
        if self.is_sample(step) {
            self.series.step.push(step);
            self.series.time.push(time);
        }
    }

    /// Records the sample at the step of `look`, if one is due. Returns the snapshot with the columns of the scene, if
    /// one is due.
    pub fn take(&mut self, scene: &Scene, look: StepState) -> Option<Snapshot> {
        self.sample(scene, &look);
        self.is_snapshot(look.snapshot.step).then(|| {
            let mut snapshot = look.snapshot;
            reduce(&mut snapshot, &scene.columns);
            snapshot
        })
    }

    /// Returns the step of the last sample.
    #[must_use]
    pub fn last_sample(&self) -> Option<u64> {
        self.series.step.last().copied()
    }

    /// Adds a snapshot to the recorder.
    pub fn keep(&mut self, snapshot: Snapshot) {
        self.snapshots.push(snapshot);
    }

    /// Returns the first column whose last sample is not finite, with the value.
    #[must_use]
    pub fn not_finite(&self) -> Option<(&str, f64)> {
        let last = |at: usize| self.series.values[at].last().copied();
        let columns = self.series.columns.iter().enumerate();
        let mut found = columns.filter_map(|(at, column)| Some((column.name.as_str(), last(at)?)));
        found.find(|(_, value)| !value.is_finite())
    }

    /// Returns the time series and the snapshots.
    #[must_use]
    pub fn finish(self) -> (Series, Vec<Snapshot>) {
        (self.series, self.snapshots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_continued_by_the_run_that_began_it_alone() {
        let begun = Recorder {
            interval: 2,
            snapshot_steps: vec![0, 10],
            steps: 10,
            series: Series::default(),
            snapshots: Vec::new(),
        };
        assert!(begun.is_of(&begun));
        let others = [
            Recorder { interval: 0, ..begun.clone() },
            Recorder { steps: 11, ..begun.clone() },
            Recorder { snapshot_steps: vec![0], ..begun.clone() },
            Recorder { series: Series { values: vec![Vec::new()], ..Series::default() }, ..begun.clone() },
            Recorder { series: Series { time: vec![0.0], ..Series::default() }, ..begun.clone() },
        ];
        assert!(others.iter().all(|other| !other.is_of(&begun)));
    }
}
