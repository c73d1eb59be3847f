//! Figures with curves of the output and of our runs.

use super::ours::is_compared;
use grainbench_harness::compare::peers::{Peer, together};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_reference::observer::DumpRecord;

/// Plots the first four compared columns that change over time, from the output and from our runs.
pub(super) fn figures(ours: &[Peer], file: &str, observed: &DumpRecord) -> Vec<Figure> {
    const MOST: usize = 4;
    const MARKERS: usize = 40;
    const POINTS: usize = 500;
    let mut figures = Vec::new();
    for (at, column) in observed.series.columns.iter().enumerate().filter(|(_, column)| is_compared(&column.name)) {
        let values = &observed.series.values[at];
        let moves = values.iter().any(|value| Some(value) != values.first());
        if figures.len() == MOST || !moves {
            continue;
        }
        let points = |time: &[f64], values: &[f64], most: usize| {
            let finite = time.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite());
            finite.step_by(values.len().div_ceil(most).max(1)).collect()
        };
        let mut curves = vec![Curve::new(file, Stroke::Markers, points(&observed.series.time, values, MARKERS))];
        for peer in ours {
            if let Some((time, _, theirs)) = together(&observed.series, values, &peer.series, &column.name) {
                curves.push(Curve::new(peer.name.clone(), Stroke::Line, points(&time, &theirs, POINTS)));
            }
        }
        figures.push(Figure::graph(
            &column.name.replace('.', "-"),
            &column.name,
            "The output (markers) and our solvers on the same scene at its time step.",
            [Axis::linear("time t (s)"), Axis::linear(&format!("{} ({})", column.name, column.unit))],
            curves,
        ));
    }
    figures
}
