//! A series against several runs of the same scene: the one that is nearest as a whole, column by column, within what
//! these runs differ by and what half their time step changes.

use super::pointwise::largest;
use crate::expect::{Measured, larger, weight};
use grainbench_scene::record::Series;

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
    /// Samples that both have.
    pub samples: usize,
    /// The worst of them.
    pub measured: Measured,
    /// By how much the runs differ, as a part of the scale.
    pub between: f64,
    /// What half the time step changes, as a part of the scale.
    pub halved: f64,
    /// Largest uncertainty of what was observed, as a part of the scale.
    pub open: f64,
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
        let between = peers.iter().filter_map(|peer| together(&nearest.series, own, &peer.series, &column.name));
        let halved = with_half.map_or(0.0, |(peer, half)| {
            apart(peer.series.column(&column.name).unwrap_or_default(), half.column(&column.name).unwrap_or_default())
        });
        (scale > 0.0).then(|| Compared {
            name: &column.name,
            unit: &column.unit,
            samples: times.len(),
            measured: Measured::worst_of(&times, &found, &expected, scale),
            between: between.map(|(_, a, b)| apart(&a, &b)).fold(0.0, larger) / scale,
            halved: halved / scale,
            open: largest(&uncertainty[at]) / scale,
        })
    });
    Some((&nearest.name, compared.collect()))
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
            Some((nearest.to_owned(), column.measured.error(), column.between, column.halved))
        };
        let peers =
            [peer("lost", [0.0, f64::NAN, 2.0], None), peer("sound", [0.0, 1.5, 2.0], Some([0.0, f64::NAN, 2.0]))];
        let found = against_all(&peers);
        assert!(found.is_some_and(|(nearest, error, between, halved)| {
            nearest == "sound" && (error + 0.25).abs() < 1e-15 && between.is_nan() && halved.is_nan()
        }));
        assert!(against_all(&peers[..1]).is_some_and(|(_, error, ..)| error.is_nan()));
    }
}
