//! Figures with curves of the output and of our runs.

use super::ours::is_compared;
use grainbench_harness::compare::peers::{Peer, together};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_reference::observer::DumpRecord;
use grainbench_solver::record::Series;

/// Plots the first four compared columns that change over time: the output over our nearest run, and their difference on
/// its own axis, beside the change with half the time step and the difference of our other conventions.
pub(super) fn figures(ours: &[Peer], file: &str, observed: &DumpRecord) -> Vec<Figure> {
    const MOST: usize = 4;
    const MARKERS: usize = 40;
    const POINTS: usize = 500;
    let Some(nearest) = ours.first() else { return Vec::new() };
    let few = |points: Vec<(f64, f64)>, most: usize| -> Vec<(f64, f64)> {
        let every = points.len().div_ceil(most).max(1);
        points.into_iter().filter(|(_, value)| value.is_finite()).step_by(every).collect()
    };
    let pairs = |(times, a, b): (Vec<f64>, Vec<f64>, Vec<f64>)| times.into_iter().zip(a.into_iter().zip(b));
    let columns = observed.series.columns.iter().zip(&observed.series.values);
    let moves = |values: &[f64]| values.iter().any(|value| Some(value) != values.first());
    let plotted = columns.filter(|(column, values)| is_compared(&column.name) && moves(values)).take(MOST);
    let mut figures = Vec::new();
    for (column, values) in plotted {
        let Some(of_file) = together(&observed.series, values, &nearest.series, &column.name) else { continue };
        let apart = |both| pairs(both).map(|(time, (a, b)): (f64, (f64, f64))| (time, (a - b).abs())).collect();
        let own = nearest.series.column(&column.name).unwrap_or_default();
        let against = |other: &Series| together(&nearest.series, own, other, &column.name).map(apart);
        let line = of_file.0.iter().copied().zip(of_file.2.iter().copied()).collect();
        let markers = observed.series.time.iter().copied().zip(values.iter().copied()).collect();
        let time = || Axis::linear("time t (s)");
        let name = column.name.replace('.', "-");
        figures.push(Figure::graph(
            &name,
            &column.name,
            "The output (markers) over our nearest run (line).",
            [time(), Axis::linear(&format!("{} ({})", column.name, column.unit))],
            vec![
                Curve::new(nearest.name.clone(), Stroke::Line, few(line, POINTS)),
                Curve::new(file, Stroke::Markers, few(markers, MARKERS)),
            ],
        ));
        let half = nearest.half_step.as_ref().and_then(against).map(|points| ("half the time step", points));
        let others = ours.iter().skip(1).filter_map(|peer| against(&peer.series));
        let largest = |a: Vec<(f64, f64)>, b: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
            a.into_iter().zip(b).map(|(a, b)| (a.0, a.1.max(b.1))).collect()
        };
        let lines = half.into_iter().chain(others.reduce(largest).map(|points| ("our other conventions", points)));
        let mut curves: Vec<Curve> =
            lines.map(|(name, points)| Curve::new(name, Stroke::Line, few(points, POINTS))).collect();
        curves.push(Curve::new(file, Stroke::Markers, few(apart(of_file), MARKERS)));
        curves.retain(|curve| curve.points.iter().any(|(_, value)| *value > 0.0));
        if !curves.is_empty() {
            figures.push(Figure::graph(
                &format!("{name}-difference"),
                &format!("{}, difference", column.name),
                "Difference of the output from our nearest run (markers). The lines are the differences of the same run with \
                 half the time step, and the largest one of our other contact conventions. Zeros are left out.",
                [time(), Axis::log(&format!("|difference| ({})", column.unit))],
                curves,
            ));
        }
    }
    figures
}
