//! Comparison of an observed series with several runs of the same scene.
//!
//! All columns are compared with the run that is nearest to the whole series. The allowed error can depend on the
//! difference between the runs and on the change due to half the time step.

use super::pointwise::largest;
use crate::expect::{Measurement, larger, weight};
use grainbench_solver::record::Series;
use std::collections::VecDeque;

/// A run to compare with.
pub struct Peer {
    /// Name of the run.
    pub name: String,
    /// Time series of its probes.
    pub series: Series,
    /// Time series of the same scene with half the time step; none if there is no such run.
    pub half_step: Option<Series>,
}

/// Column of the observed series, compared with the nearest run.
pub struct ColumnComparison<'a> {
    /// Name of the column.
    pub name: &'a str,
    /// Unit of the column, such as `m/s`.
    pub unit: &'a str,
    /// Scale that differences are divided by.
    pub scale: f64,
    /// Samples at the times that occur in both series.
    pub samples: Vec<Sample>,
    /// Largest uncertainty of the observed values, as a fraction of the scale.
    pub open: f64,
}

/// Sample of an observed column, compared with the nearest run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time (s).
    pub time: f64,
    /// Observed value.
    pub found: f64,
    /// Value of the nearest run.
    pub expected: f64,
    /// Largest difference between the nearest run and any other run over all times, as a fraction of the scale.
    pub between: f64,
    /// Largest change of the column around this time if the time step is halved, as a fraction of the scale.
    pub halved: f64,
}

/// Sample that decides the result of a column.
pub struct DecisiveSample {
    /// Time, observed value and expected value.
    pub sample: Sample,
    /// Largest |error| that passes at the sample.
    pub allowed: f64,
    /// Number of samples whose allowed error is larger than [`WIDE`].
    pub wide: usize,
    /// Time of the first sample outside the allowed error (s).
    pub first_outside: Option<f64>,
}

/// Allowed error, as a fraction of the scale, above which a sample is too uncertain to decide a result.
pub const WIDE: f64 = 0.05;

impl ColumnComparison<'_> {
    /// Returns the sample with the largest ratio of error to allowed error. `allowed` returns the allowed error of a
    /// sample as a fraction of the scale.
    ///
    /// If no error exceeds the allowed error, samples that allow more than [`WIDE`] are skipped, unless all samples allow more.
    #[must_use]
    pub fn decisive(&self, allowed: impl Fn(&Sample) -> f64) -> Option<DecisiveSample> {
        let ratio = |sample: &Sample| weight((sample.found - sample.expected) / self.scale) / allowed(sample);
        let is_wide = |sample: &Sample| allowed(sample) > WIDE;
        let worst = |samples: &mut dyn Iterator<Item = &Sample>| {
            samples.max_by(|a, b| weight(ratio(a)).total_cmp(&weight(ratio(b)))).copied()
        };
        let outside = |sample: &&Sample| weight(ratio(sample)) > 1.0;
        let first_outside = self.samples.iter().find(outside).map(|sample| sample.time);
        let sample = match first_outside {
            Some(_) => worst(&mut self.samples.iter()),
            None => worst(&mut self.samples.iter().filter(|sample| !is_wide(sample)))
                .or_else(|| worst(&mut self.samples.iter())),
        }?;
        let wide = self.samples.iter().filter(|sample| is_wide(sample)).count();
        Some(DecisiveSample { sample, allowed: allowed(&sample), wide, first_outside })
    }

    /// Returns the observed value at a sample, with the expected value and the scale.
    pub fn measured(&self, sample: &Sample) -> Measurement {
        Measurement::new(sample.found, sample.expected, self.scale)
    }
}

/// Compares the observed columns that `is_compared` selects and that all runs contain. With `only`, the columns are
/// compared with the run of this name, otherwise with the nearest run.
///
/// `scale` computes the scale of a unit from the largest extent of the columns with that unit. Columns with a scale of
/// zero are left out. Returns the name of the nearest run and one comparison per column; none if there are no runs.
pub fn against<'a>(
    observed: &'a Series,
    uncertainty: &[Vec<f64>],
    peers: &'a [Peer],
    only: Option<&str>,
    is_compared: impl Fn(&str) -> bool,
    scale: impl Fn(&dyn Fn(&str) -> f64, &str) -> f64,
) -> Option<(&'a str, Vec<ColumnComparison<'a>>)> {
    let mut columns: Vec<_> = observed.columns.iter().enumerate().collect();
    let known = |name: &str| peers.iter().all(|peer| peer.series.column(name).is_some());
    columns.retain(|(_, column)| is_compared(&column.name) && known(&column.name));
    let scale_in = |peer: &Peer, unit: &str| {
        // Columns with the same unit share one scale. Rounding errors along an axis without motion then stay small fractions.
        let of_unit = |unit: &str| {
            let extents = columns.iter().filter(|(_, column)| column.unit == unit);
            extents.filter_map(|(_, column)| Some(extent(peer.series.column(&column.name)?, unit))).fold(0.0, f64::max)
        };
        scale(&of_unit, unit)
    };
    let distance = |peer: &Peer| -> f64 {
        let parts = columns.iter().filter_map(|&(at, column)| {
            let (_, found, expected) = together(observed, &observed.values[at], &peer.series, &column.name)?;
            Some(apart(&found, &expected) / scale_in(peer, &column.unit).max(f64::MIN_POSITIVE))
        });
        parts.sum()
    };
    let candidates = peers.iter().filter(|peer| only.is_none_or(|name| peer.name == name));
    let nearest = candidates.min_by(|a, b| weight(distance(a)).total_cmp(&weight(distance(b))))?;
    // If the nearest run has no half-step run, the first other run with one is used.
    let with_half = [nearest].into_iter().chain(peers).find_map(|peer| Some((peer, peer.half_step.as_ref()?)));
    let compared = columns.iter().filter_map(|&(at, column)| {
        let scale = scale_in(nearest, &column.unit);
        let (times, found, expected) = together(observed, &observed.values[at], &nearest.series, &column.name)?;
        let own = nearest.series.column(&column.name)?;
        let others = peers.iter().filter_map(|peer| together(&nearest.series, own, &peer.series, &column.name));
        // Contact conventions differ in free vibration and in drift. The difference at one time is therefore not
        // representative, and the largest difference over time is used.
        let between = others.map(|(_, a, b)| apart(&a, &b)).fold(0.0, larger) / scale;
        let halved = with_half.map(|(peer, half)| {
            let values_of = |series: &Series| series.column(&column.name).unwrap_or_default().to_vec();
            Envelope::new(peer.series.time.clone(), &values_of(&peer.series), &values_of(half))
        });
        let sample = |((time, found), expected): ((&f64, &f64), &f64)| Sample {
            time: *time,
            found: *found,
            expected: *expected,
            between,
            halved: halved.as_ref().map_or(0.0, |envelope| envelope.at(*time)) / scale,
        };
        (scale > 0.0).then(|| ColumnComparison {
            name: &column.name,
            unit: &column.unit,
            scale,
            samples: times.iter().zip(&found).zip(&expected).map(sample).collect(),
            open: largest(&uncertainty[at]) / scale,
        })
    });
    Some((&nearest.name, compared.collect()))
}

/// Bound on the difference between two runs, as a function of time.
struct Envelope {
    times: Vec<f64>,
    values: Vec<f64>,
}

/// Half-width of the window of an envelope, as a fraction of the number of samples.
const WINDOW: f64 = 0.01;

impl Envelope {
    /// Computes the envelope of the difference of two runs with the same sample times (s).
    ///
    /// Each value is the larger of two numbers: the largest difference within a window around the sample, and the 90th
    /// percentile of all differences. The percentile is close to the amplitude of an oscillation. A difference that
    /// occurs only at an impact therefore increases the allowed error only around that impact.
    fn new(times: Vec<f64>, a: &[f64], b: &[f64]) -> Self {
        let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
        let mut sorted = off.clone();
        sorted.sort_by(|a, b| weight(*a).total_cmp(&weight(*b)));
        let mostly = sorted.get(sorted.len().saturating_sub(1) * 9 / 10).copied().unwrap_or_default();
        let half = ((WINDOW * off.len() as f64) as usize).max(1);
        let values = windowed(&off, half).into_iter().map(|largest| larger(largest, mostly)).collect();
        Self { times, values }
    }

    /// Returns the value at the sample nearest to a time (s).
    fn at(&self, time: f64) -> f64 {
        let next = self.times.partition_point(|other| *other < time).min(self.values.len().saturating_sub(1));
        let before = next.saturating_sub(1);
        let is_nearer = |a: usize, b: usize| (self.times[a] - time).abs() < (self.times[b] - time).abs();
        match self.values.len() {
            0 => 0.0,
            _ if is_nearer(before, next) => self.values[before],
            _ => self.values[next],
        }
    }
}

/// Returns, for each value, the largest value in a window from `half` places before it to `half` places after it. A
/// window with a NaN gives NaN.
fn windowed(values: &[f64], half: usize) -> Vec<f64> {
    let mut queue: VecDeque<usize> = VecDeque::new();
    let mut found = Vec::with_capacity(values.len());
    for at in 0..values.len() + half {
        if at < values.len() {
            while queue.back().is_some_and(|&last| weight(values[last]) <= weight(values[at])) {
                queue.pop_back();
            }
            queue.push_back(at);
        }
        if let Some(middle) = at.checked_sub(half) {
            while queue.front().is_some_and(|&first| first + half < middle) {
                queue.pop_front();
            }
            found.push(queue.front().map_or(0.0, |&first| values[first]));
        }
    }
    found
}

/// Returns the times (s) that occur in both series, and the values of a column at these times in each series. Returns
/// none for fewer than two times.
#[must_use]
pub fn together(first: &Series, values: &[f64], second: &Series, name: &str) -> Option<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let others = second.column(name)?;
    // Times printed by a program have few digits. The tolerance exceeds their rounding and is smaller than the spacing of
    // samples.
    let interval = second.time.get(1).zip(second.time.first()).map_or(0.0, |(next, first)| next - first);
    let near = (1e-6 * second.time.last().copied().unwrap_or_default()).min(0.01 * interval);
    let (mut times, mut a, mut b) = (Vec::new(), Vec::new(), Vec::new());
    for (time, value) in first.time.iter().zip(values) {
        let at = second.time.partition_point(|other| *other < time - near);
        if second.time.get(at).is_some_and(|other| (other - time).abs() <= near) {
            times.push(*time);
            a.push(*value);
            b.push(others[at]);
        }
    }
    (times.len() > 1).then_some((times, a, b))
}

/// Returns the largest |value|. Coordinates (unit m) are taken relative to the first value.
fn extent(values: &[f64], unit: &str) -> f64 {
    let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
    values.iter().map(|value| (value - start).abs()).fold(0.0, f64::max)
}

/// Returns the largest |difference|; NaN if a difference is NaN.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::record::Column;

    /// Builds a series with one column of lengths (m).
    fn series(values: [f64; 3]) -> Series {
        let column = Column { name: "a.x".to_owned(), unit: "m".to_owned() };
        Series { step: vec![0, 1, 2], time: vec![0.0, 1.0, 2.0], columns: vec![column], values: vec![values.to_vec()] }
    }

    fn peer(name: &str, values: [f64; 3], half_step: Option<[f64; 3]>) -> Peer {
        Peer { name: name.to_owned(), series: series(values), half_step: half_step.map(series) }
    }

    /// A run with a NaN is the nearest run only if it is the only run, and its error is then NaN. The differences from a
    /// run with a NaN are NaN.
    #[test]
    fn what_is_not_a_number_is_far_from_everything() {
        let observed = series([0.0, 1.0, 2.0]);
        let against_all = |peers: &[Peer]| {
            let scale = |largest: &dyn Fn(&str) -> f64, unit: &str| largest(unit);
            let (nearest, compared) = against(&observed, &[vec![0.0; 3]], peers, None, |_| true, scale)?;
            let column = compared.first()?;
            let worst = column.decisive(|_| 1e-6)?.sample;
            let last = column.samples.last()?;
            Some((nearest.to_owned(), column.measured(&worst).error(), last.between, last.halved))
        };
        let peers =
            [peer("lost", [0.0, f64::NAN, 2.0], None), peer("sound", [0.0, 1.5, 2.0], Some([0.0, f64::NAN, 2.0]))];
        let found = against_all(&peers);
        assert!(found.is_some_and(|(nearest, error, between, halved)| {
            nearest == "sound" && (error + 0.25).abs() < 1e-15 && between.is_nan() && halved.is_nan()
        }));
        assert!(against_all(&peers[..1]).is_some_and(|(_, error, ..)| error.is_nan()));
    }

    /// If the half-step run differs only at an impact, the allowed error is not larger long after the impact.
    #[test]
    fn what_is_allowed_follows_the_course() {
        let mut off = vec![0.0; 1000];
        off[300] = 1.0;
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let envelope = Envelope::new(times, &off, &vec![0.0; 1000]);
        assert_eq!((envelope.at(0.0), envelope.at(280.0)), (0.0, 0.0));
        assert!([291.0, 300.0, 309.0].iter().all(|&at| envelope.at(at) == 1.0));
        assert!(envelope.at(400.0) < 0.08 && envelope.at(999.0) < 0.05);
        let windowed = windowed(&[0.0, f64::NAN, 0.0, 0.0], 1);
        assert!(windowed[2].is_nan() && windowed[3] == 0.0);
    }
}
