//! A series against several runs of the same scene: the one that is nearest as a whole, column by column, within what
//! these runs differ by and what half their time step changes.

use super::pointwise::largest;
use crate::expect::{Measured, larger, weight};
use grainbench_scene::record::Series;
use std::collections::VecDeque;

/// One of the runs.
pub struct Peer {
    /// What it is called.
    pub name: String,
    /// Its series.
    pub series: Series,
    /// The same with half the time step, where that was run.
    pub half_step: Option<Series>,
}

/// A column beside the nearest run.
pub struct Compared<'a> {
    /// Name of the column.
    pub name: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Scale that differences are divided by.
    pub scale: f64,
    /// Samples that both have.
    pub samples: Vec<Sample>,
    /// Largest uncertainty of what was observed, as a part of the scale.
    pub open: f64,
}

/// One sample of a column beside the nearest run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time (s).
    pub time: f64,
    /// Value that was observed.
    pub found: f64,
    /// Value of the nearest run.
    pub expected: f64,
    /// By how much the runs differ, as a part of the scale.
    pub between: f64,
    /// Change by half the time step around this time, as a part of the scale.
    pub halved: f64,
}

/// The sample that decides on a column.
pub struct Decisive {
    /// The sample.
    pub sample: Sample,
    /// Largest |error| that passes there.
    pub allowed: f64,
    /// Number of samples that allow more than [`WIDE`].
    pub wide: usize,
    /// Time of the first sample outside (s).
    pub first_outside: Option<f64>,
}

/// Largest allowed error, as a part of the scale, by which a sample can be judged.
pub const WIDE: f64 = 0.05;

impl Compared<'_> {
    /// The sample with the largest error in units of what is allowed. Where none is outside, samples that allow more than
    /// [`WIDE`] are passed over as long as there are others.
    #[must_use]
    pub fn decisive(&self, allowed: impl Fn(&Sample) -> f64) -> Option<Decisive> {
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
        Some(Decisive { sample, allowed: allowed(&sample), wide, first_outside })
    }

    /// Measured value at a sample.
    #[must_use]
    pub fn measured(&self, sample: &Sample) -> Measured {
        Measured::new(sample.found, sample.expected, self.scale)
    }
}

/// Compares the columns of an observed series that `is_compared` takes and that every run has. `scale` says what
/// differences of a unit are divided by, from the largest extent of that unit; a column whose scale is zero is left
/// out. The name of the nearest run, and a comparison a column; none where there are no runs.
pub fn against<'a>(
    observed: &'a Series,
    uncertainty: &[Vec<f64>],
    peers: &'a [Peer],
    is_compared: impl Fn(&str) -> bool,
    scale: impl Fn(&dyn Fn(&str) -> f64, &str) -> f64,
) -> Option<(&'a str, Vec<Compared<'a>>)> {
    let mut columns: Vec<_> = observed.columns.iter().enumerate().collect();
    let known = |name: &str| peers.iter().all(|peer| peer.series.column(name).is_some());
    columns.retain(|(_, column)| is_compared(&column.name) && known(&column.name));
    let scale_in = |peer: &Peer, unit: &str| {
        // One scale for all columns of a unit: what does not move along one axis is not judged by its rounding there.
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
    let nearest = peers.iter().min_by(|a, b| weight(distance(a)).total_cmp(&weight(distance(b))))?;
    // Of runs that are alike, one with half the step stands for all.
    let with_half = [nearest].into_iter().chain(peers).find_map(|peer| Some((peer, peer.half_step.as_ref()?)));
    let compared = columns.iter().filter_map(|&(at, column)| {
        let scale = scale_in(nearest, &column.unit);
        let (times, found, expected) = together(observed, &observed.values[at], &nearest.series, &column.name)?;
        let own = nearest.series.column(&column.name)?;
        let others = peers.iter().filter_map(|peer| together(&nearest.series, own, &peer.series, &column.name));
        // Conventions ring and drift otherwise: how far they are apart at one time says little of another program there.
        let between = others.map(|(_, a, b)| apart(&a, &b)).fold(0.0, larger) / scale;
        let halved = with_half.map(|(peer, half)| {
            let of = |series: &Series| series.column(&column.name).unwrap_or_default().to_vec();
            Envelope::of(peer.series.time.clone(), &of(&peer.series), &of(half))
        });
        let sample = |((time, found), expected): ((&f64, &f64), &f64)| Sample {
            time: *time,
            found: *found,
            expected: *expected,
            between,
            halved: halved.as_ref().map_or(0.0, |envelope| envelope.at(*time)) / scale,
        };
        (scale > 0.0).then(|| Compared {
            name: &column.name,
            unit: &column.unit,
            scale,
            samples: times.iter().zip(&found).zip(&expected).map(sample).collect(),
            open: largest(&uncertainty[at]) / scale,
        })
    });
    Some((&nearest.name, compared.collect()))
}

/// How far two runs are apart in the course of time.
struct Envelope {
    times: Vec<f64>,
    values: Vec<f64>,
}

/// Half the width of the window of an envelope, as a part of the course.
const WINDOW: f64 = 0.01;

impl Envelope {
    /// Of two runs at times they share (s): at each time the largest difference of the samples around it, or what nine in ten
    /// samples are within, which is nearly the amplitude of what oscillates. What differs at impacts alone does not widen what is
    /// allowed between them.
    fn of(times: Vec<f64>, a: &[f64], b: &[f64]) -> Self {
        let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
        let mut sorted = off.clone();
        sorted.sort_by(|a, b| weight(*a).total_cmp(&weight(*b)));
        let mostly = sorted.get(sorted.len().saturating_sub(1) * 9 / 10).copied().unwrap_or_default();
        let half = ((WINDOW * off.len() as f64) as usize).max(1);
        let values = windowed(&off, half).into_iter().map(|largest| larger(largest, mostly)).collect();
        Self { times, values }
    }

    /// The value at the sample nearest to a time (s).
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

/// The largest of the values from `half` places before each to `half` behind it; not a number where one is not.
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

/// Times (s) that two series share, and the values of a column there; none where fewer than two are shared.
#[must_use]
pub fn together(first: &Series, values: &[f64], second: &Series, name: &str) -> Option<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let others = second.column(name)?;
    // Times are printed with few digits; samples lie farther apart than that.
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

/// Coordinates from where they start, all else as it is.
fn extent(values: &[f64], unit: &str) -> f64 {
    let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
    values.iter().map(|value| (value - start).abs()).fold(0.0, f64::max)
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::record::Column;

    /// A column of a length.
    fn series(values: [f64; 3]) -> Series {
        let column = Column { name: "a.x".to_owned(), unit: "m".to_owned() };
        Series { step: vec![0, 1, 2], time: vec![0.0, 1.0, 2.0], columns: vec![column], values: vec![values.to_vec()] }
    }

    fn peer(name: &str, values: [f64; 3], half_step: Option<[f64; 3]>) -> Peer {
        Peer { name: name.to_owned(), series: series(values), half_step: half_step.map(series) }
    }

    /// A run that is not a number somewhere is no nearer than any other, and is not taken for one that agrees.
    #[test]
    fn what_is_not_a_number_is_far_from_everything() {
        let observed = series([0.0, 1.0, 2.0]);
        let against_all = |peers: &[Peer]| {
            let scale = |largest: &dyn Fn(&str) -> f64, unit: &str| largest(unit);
            let (nearest, compared) = against(&observed, &[vec![0.0; 3]], peers, |_| true, scale)?;
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

    /// A run whose half step differs at an impact alone is not judged as loosely long after it.
    #[test]
    fn what_is_allowed_follows_the_course() {
        let mut off = vec![0.0; 1000];
        off[300] = 1.0;
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let envelope = Envelope::of(times, &off, &vec![0.0; 1000]);
        assert_eq!((envelope.at(0.0), envelope.at(280.0)), (0.0, 0.0));
        assert!([291.0, 300.0, 309.0].iter().all(|&at| envelope.at(at) == 1.0));
        assert!(envelope.at(400.0) < 0.08 && envelope.at(999.0) < 0.05);
        assert!(
            windowed(&[0.0, f64::NAN, 0.0, 0.0], 1)[2].is_nan() && windowed(&[0.0, f64::NAN, 0.0, 0.0], 1)[3] == 0.0
        );
    }
}
