//! Time series of probes: one graph per quantity, such as velocity, position or force.

use crate::distinct;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_solver::record::{Record, Series, Snapshot};

/// Record of a run, with a name that distinguishes it in figures.
pub struct NamedRecord<'a> {
    /// Name, which is the title of its panels.
    pub name: String,
    /// Record of the run.
    pub record: &'a Record,
}

impl NamedRecord<'_> {
    /// Returns the snapshot nearest to a time (s).
    pub(crate) fn at(&self, time: f64) -> Option<&Snapshot> {
        let away = |snapshot: &&Snapshot| (snapshot.time - time).abs();
        self.record.snapshots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }
}

/// Largest number of curves of a graph. More curves would be hard to distinguish.
const CURVES: usize = 8;

/// Splits the name of a column into probe and quantity: `disc.vx` is the quantity `vx` of the probe `disc`.
fn parts(name: &str) -> (&str, &str) {
    name.rsplit_once('.').unwrap_or(("", name))
}

/// Returns one graph for each quantity of the probes of all records, within a time window (s). Values that are missing
/// or not finite are not plotted.
pub(crate) fn figures(records: &[NamedRecord<'_>], window: (f64, f64)) -> Vec<Figure> {
    let columns = records.iter().flat_map(|named| &named.record.series.columns);
    let quantities = distinct(columns.map(|column| (parts(&column.name).1, column.unit.as_str())));
    quantities.into_iter().filter_map(|quantity| figure(records, quantity, window)).collect()
}

fn figure(records: &[NamedRecord<'_>], (quantity, unit): (&str, &str), window: (f64, f64)) -> Option<Figure> {
    let mut curves = Vec::new();
    for named in records {
        let series = &named.record.series;
        for (at, column) in series.columns.iter().enumerate() {
            let (probe, part) = parts(&column.name);
            if (part, column.unit.as_str()) == (quantity, unit) {
                let label =
                    [probe, &named.name].into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ");
                let points = points(series, at, window);
                if points.iter().any(|(_, value)| value.is_finite()) {
                    curves.push(Curve::new(label, Stroke::Line, points));
                }
            }
        }
    }
    let more = curves.len().saturating_sub(CURVES);
    let left_out = if more > 0 { format!(" The table of probes has {more} more.") } else { String::new() };
    curves.truncate(CURVES);
    let words = quantity.replace('_', " ");
    let label = if unit == "1" { words.clone() } else { format!("{words} ({unit})") };
    (!curves.is_empty()).then(|| {
        Figure::graph(
            &format!("probe-{quantity}"),
            &format!("Probes: {words}"),
            &format!("{words} from the probes of the scene.{left_out}"),
            [Axis::linear("time t (s)"), Axis::linear(&label)],
            curves,
        )
    })
}

fn points(series: &Series, column: usize, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
    let values = series.values.get(column).map_or(&[][..], Vec::as_slice);
    let points = series.time.iter().copied().zip(values.iter().copied());
    points.filter(|(time, _)| (from..=to).contains(time)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample;

    #[test]
    fn every_quantity_has_its_graph_and_nothing_stands_for_zero() {
        let record = sample::record();
        let named = [NamedRecord { name: String::new(), record: &record }];
        let figures = figures(&named, (f64::NEG_INFINITY, f64::INFINITY));
        assert!(!figures.is_empty() && figures.iter().all(|figure| crate::plot::draw(figure).is_ok()));
        assert!(super::figures(&named, (1e9, 2e9)).is_empty(), "a window without samples shows nothing");
    }
}
