//! Pictures of what was observed beside our runs.

use super::ours::{Ours, is_compared};
use grainbench_harness::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use grainbench_reference::observer::Observed;

/// The first moving columns: what was observed, and our runs.
pub(super) fn figures(ours: &Ours, file: &str, observed: &Observed) -> Vec<Figure> {
    const MOST: usize = 4;
    const MARKERS: usize = 40;
    let time = &observed.series.time;
    let mut figures = Vec::new();
    for (at, column) in observed.series.columns.iter().enumerate().filter(|(_, column)| is_compared(&column.name)) {
        let values = &observed.series.values[at];
        let moves = values.iter().any(|value| Some(value) != values.first());
        if figures.len() == MOST || !moves {
            continue;
        }
        let every = values.len().div_ceil(MARKERS).max(1);
        let points = |values: &[f64], every: usize| {
            let finite = time.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite());
            finite.step_by(every).collect()
        };
        let mut curves = vec![Curve { label: file.to_owned(), stroke: Stroke::Markers, points: points(values, every) }];
        for (name, series) in &ours.runs {
            if let Some(values) = ours.at(series, &column.name) {
                let thin = values.len().div_ceil(500).max(1);
                curves.push(Curve { label: (*name).to_owned(), stroke: Stroke::Line, points: points(&values, thin) });
            }
        }
        let axis = |label: String| Axis { label, logarithmic: false };
        figures.push(Figure {
            name: column.name.replace('.', "-"),
            title: column.name.clone(),
            caption: "The output (markers) and our solvers on the same scene at its time step.".to_owned(),
            drawing: Drawing::Graph(Graph {
                x: axis("time t (s)".to_owned()),
                y: axis(format!("{} ({})", column.name, column.unit)),
                curves,
            }),
        });
    }
    figures
}
